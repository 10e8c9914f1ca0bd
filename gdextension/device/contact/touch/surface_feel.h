// How a surface of the scene feels: stiffness, damping, friction and traits. A game may change
// these while the hand touches the surface, for example when a pinch begins. The servo loop then
// changes them gradually, in kFeelFade_s, so that the hand feels no jolt.
#pragma once

#include "device/contact/proxy/contact_scene.h"
#include "device/contact/proxy/tool_proxy.h"

namespace spidar {

// Time from the old feel to the new one (unit: s). A push of 2 N that ends in this time falls by
// 0.04 N per cycle of 1 ms on average.
inline constexpr double kFeelFade_s = 0.05;

struct SurfaceFeel {
    double stiffness_n_m = 0.0; // 0: rigid
    double damping_n_s_m = 0.0;
    double friction = 0.0;
    SurfaceTraits traits;

    friend bool operator==(const SurfaceFeel &, const SurfaceFeel &) = default;
};

[[nodiscard]] SurfaceFeel feel_of(const ScenePart &part) noexcept;
void set_feel(const SurfaceFeel &feel, ScenePart &part) noexcept;

// Returns the feel after one more cycle of dt_s on the way from `now` to `wanted`, which is reached
// in left_s (at most kFeelFade_s). If the pattern of the texture changes, the old one flattens in
// the first half of kFeelFade_s, and the new one rises in the second. If the relief changes, the
// old one ends at once, because nobody keeps it alive, and the new one rises from flat.
[[nodiscard]] SurfaceFeel approach(const SurfaceFeel &now, const SurfaceFeel &wanted, double left_s,
                                   double dt_s) noexcept;
// Returns the feel of the first cycle after a change from `now` to `wanted`: what cannot wait is
// taken over. That is another relief, and the stiffness if stiffness_at_once is true.
[[nodiscard]] SurfaceFeel begin(const SurfaceFeel &now, const SurfaceFeel &wanted,
                                bool stiffness_at_once) noexcept;
// Like approach() above, for the springs between grip and proxy.
[[nodiscard]] ProxySettings approach(const ProxySettings &now, const ProxySettings &wanted,
                                     double left_s, double dt_s) noexcept;

} // namespace spidar
