#include "device/contact/touch/surface_feel.h"

#include <algorithm>

namespace spidar {

namespace {

constexpr double kPatternChange_s = 0.5 * kFeelFade_s; // time before the end of the change

bool same_pattern(const SurfaceTexture &a, const SurfaceTexture &b) noexcept {
    return a.wavelength_m == b.wavelength_m && a.across == b.across && a.relief == b.relief;
}

double between(double from, double to, double share) noexcept {
    return from + share * (to - from);
}

double compliance(double stiffness_n_m) noexcept {
    return stiffness_n_m > 0.0 ? 1.0 / stiffness_n_m : 0.0;
}

SurfaceTexture approach(const SurfaceTexture &now, const SurfaceTexture &wanted, double left_s,
                        double dt_s) noexcept {
    SurfaceTexture texture = now;
    if (!same_pattern(now, wanted)) {
        const bool kept_alive = now.relief == wanted.relief;
        if (kept_alive && now.depth_m > 0.0 && left_s > kPatternChange_s + dt_s) {
            texture.depth_m *= 1.0 - dt_s / (left_s - kPatternChange_s);
            return texture;
        }
        texture = wanted;
        texture.depth_m = 0.0;
    }
    texture.depth_m = between(texture.depth_m, wanted.depth_m, dt_s / left_s);
    return texture;
}

} // namespace

SurfaceFeel feel_of(const ScenePart &part) noexcept {
    return {part.stiffness_n_m, part.damping_n_s_m, part.friction, part.traits};
}

void set_feel(const SurfaceFeel &feel, ScenePart &part) noexcept {
    part.stiffness_n_m = feel.stiffness_n_m;
    part.damping_n_s_m = feel.damping_n_s_m;
    part.friction = feel.friction;
    part.traits = feel.traits;
}

SurfaceFeel approach(const SurfaceFeel &now, const SurfaceFeel &wanted, double left_s,
                     double dt_s) noexcept {
    if (!(left_s > dt_s)) {
        return wanted;
    }
    const double share = dt_s / left_s;
    SurfaceFeel feel = now;
    // Blends the compliance, to which the depth under a given push is proportional.
    const double gives_m_n =
        between(compliance(now.stiffness_n_m), compliance(wanted.stiffness_n_m), share);
    feel.stiffness_n_m = gives_m_n > 0.0 ? 1.0 / gives_m_n : 0.0;
    feel.damping_n_s_m = between(now.damping_n_s_m, wanted.damping_n_s_m, share);
    feel.friction = between(now.friction, wanted.friction, share);
    const SurfaceTraits &target = wanted.traits;
    SurfaceTraits &traits = feel.traits;
    traits.static_friction = between(traits.static_friction, target.static_friction, share);
    traits.catches_again = target.catches_again;
    traits.adhesion_n = between(traits.adhesion_n, target.adhesion_n, share);
    traits.magnet_n = between(traits.magnet_n, target.magnet_n, share);
    traits.magnet_range_m = between(traits.magnet_range_m, target.magnet_range_m, share);
    traits.texture = approach(traits.texture, target.texture, left_s, dt_s);
    return feel;
}

SurfaceFeel begin(const SurfaceFeel &now, const SurfaceFeel &wanted,
                  bool stiffness_at_once) noexcept {
    SurfaceFeel feel = approach(now, wanted, kFeelFade_s, 0.0);
    if (stiffness_at_once) {
        feel.stiffness_n_m = wanted.stiffness_n_m;
    }
    return feel;
}

ProxySettings approach(const ProxySettings &now, const ProxySettings &wanted, double left_s,
                       double dt_s) noexcept {
    if (!(left_s > dt_s)) {
        return wanted;
    }
    const double share = dt_s / left_s;
    ProxySettings settings = wanted;
    for (std::size_t dof = 0; dof < settings.stiffness.size(); ++dof) {
        settings.stiffness[dof] = between(now.stiffness[dof], wanted.stiffness[dof], share);
    }
    settings.damping_s = between(now.damping_s, wanted.damping_s, share);
    return settings;
}

} // namespace spidar
