// Surface traits of the proxy's contacts: textures, adhesion and magnets.
#include "device/contact/proxy/tool_proxy.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "device/contact/relief/relief_map.h"
#include "device/contract/dof_lanes.h"

namespace spidar {

namespace {

// Crests per servo cycle above which a texture is flattened; at twice that it is gone. Sampled so
// rarely, it would be felt as another, slower texture.
constexpr double kFinestPassing = 0.125;
// Stiffness that the slopes of a texture may add along the surface, relative to that between grip
// and proxy. A harder push would make a valley so stiff that the link's latency lets the hand shake
// in it: the texture is flattened there.
constexpr double kTextureShare = 0.25;
// Largest share of the push that a contact would have alone by which a texture pulls along the surface.
// In a gap that is too narrow for the tool, opposite contacts push without bound against each other.
constexpr double kMostShare = 2.0;
// A texture with a shorter wavelength is smooth: no motion is slow enough for it, and its square must
// not vanish (unit: m).
constexpr double kShortestWave_m = 1e-6;
// Adhesion rises with the stiffness between grip and proxy and then falls as steeply: it ends at
// this multiple of the distance to its maximum.
constexpr double kAdhesionWays = 2.0;

struct Relief {
    double height_m = 0.0; // of the surface, at most 0
    Vec3 slope{0.0};       // of the height along the part's axes
};

Relief relief_at(const SurfaceTexture &texture, const Vec3 &local_m, const Vec3 &normal) noexcept {
    const double k_m = 2.0 * std::numbers::pi / texture.wavelength_m;
    const double half_m = 0.5 * texture.depth_m;
    Relief relief;
    if (texture.across != Vec3(0.0)) {
        const double phase = k_m * glm::dot(texture.across, local_m);
        relief.height_m = half_m * (std::cos(phase) - 1.0);
        relief.slope = -half_m * k_m * std::sin(phase) * texture.across;
        return relief;
    }
    // An axis counts as far as it lies in the surface. The squares of a normal's components add up
    // to 1, and so do the shares.
    for (int axis = 0; axis < 3; ++axis) {
        const double share = 0.5 * (1.0 - normal[axis] * normal[axis]);
        relief.height_m += share * half_m * (std::cos(k_m * local_m[axis]) - 1.0);
        relief.slope[axis] = -share * half_m * k_m * std::sin(k_m * local_m[axis]);
    }
    return relief;
}

// How a relief lies on the plane perpendicular to an axis: the part's axes along which its columns
// and rows run. The rows of an image run downward, so along -Y where the surface stands upright.
struct Lay {
    int u;
    int v;
    double v_sign;
};
constexpr std::array<Lay, 3> kLays{{{2, 1, -1.0}, {0, 2, 1.0}, {0, 1, -1.0}}};

// coarseness: as relief_point() takes it.
Relief mapped_relief(const SurfaceTexture &texture, double coarseness, const Vec3 &local_m,
                     const Vec3 &normal) noexcept {
    Relief relief;
    for (int axis = 0; axis < 3; ++axis) {
        // The squares of a normal's parts add up to 1.
        const double share = normal[axis] * normal[axis];
        if (!(share > 0.0)) {
            continue;
        }
        const Lay &lay = kLays[static_cast<std::size_t>(axis)];
        const ReliefPoint point = relief_point(texture.relief->relief(), coarseness,
                                               local_m[lay.u] / texture.wavelength_m,
                                               lay.v_sign * local_m[lay.v] / texture.wavelength_m);
        const double scaled_m = share * texture.depth_m;
        relief.height_m += scaled_m * (point.height - 1.0);
        relief.slope[lay.u] += scaled_m * point.slope_u / texture.wavelength_m;
        relief.slope[lay.v] += lay.v_sign * scaled_m * point.slope_v / texture.wavelength_m;
    }
    return relief;
}

} // namespace

double ToolProxy::magnet_range_m(const SurfaceTraits &traits) const noexcept {
    return traits.magnet_n > 0.0
               ? std::max(traits.magnet_range_m, traits.magnet_n / settings_.stiffness[0])
               : 0.0;
}

double ToolProxy::reach_m(const SurfaceTraits &traits) const noexcept {
    return std::max(magnet_range_m(traits),
                    kAdhesionWays * traits.adhesion_n / settings_.stiffness[0]);
}

double ToolProxy::press_into(ProxyContact &contact, const ScenePart &other, double push_n,
                             const Vec3 &speed_m_s, double dt_s) const noexcept {
    const SurfaceTexture &texture = other.traits.texture;
    if (texture.wavelength_m < kShortestWave_m) {
        return 0.0;
    }
    const Mat3 &turn = other.at.rotation;
    const Vec3 local_m = glm::transpose(turn) * (contact.point_m - other.at.origin_m);
    const Vec3 normal = glm::transpose(turn) * contact.normal;
    const Vec3 slides_m_s = along_surface(speed_m_s, contact.normal);
    const double passing = glm::length(slides_m_s) * dt_s / texture.wavelength_m;
    const double most_n_m = kTextureShare * settings_.stiffness[0];
    // By which the surface gets stiffer along itself, for a curvature of 1 / wavelength.
    const double bends_n_m =
        push_n * texture.depth_m / (texture.wavelength_m * texture.wavelength_m);
    Relief relief;
    double passing_share = passing / kFinestPassing;
    double stiffens_n_m = 0.0;
    if (texture.relief != nullptr) {
        const ReliefLevels &levels = texture.relief->relief();
        const double curvature =
            bends_n_m > 0.0 ? most_n_m / bends_n_m : std::numeric_limits<double>::infinity();
        // The closest crests of a relief are two heights apart.
        const double coarseness = relief_coarseness(levels, 0.5 * passing_share, curvature);
        relief = mapped_relief(texture, coarseness, local_m, normal);
        const ReliefLevel &coarsest = levels.back();
        stiffens_n_m = std::max(std::min(most_n_m, bends_n_m * levels.front().most_curvature),
                                bends_n_m * coarsest.most_curvature);
        passing_share *= 0.5 * coarsest.columns;
    } else {
        const double k = 2.0 * std::numbers::pi;
        relief = relief_at(texture, local_m, normal);
        stiffens_n_m = 0.5 * k * k * bends_n_m;
    }
    // A relief was made coarser first. It is flattened as far as even its coarsest level is too
    // fine.
    const double kept = std::clamp(2.0 - passing_share, 0.0, 1.0) *
                        std::min(1.0, most_n_m / std::max(stiffens_n_m, most_n_m));
    // The stiffness that a texture adds along the surface is damped like a contact.
    contact.drawn_n = -(settings_.damping_s * kept * stiffens_n_m) * slides_m_s;
    contact.slope = along_surface(kept * (turn * relief.slope), contact.normal);
    contact.alone_n = push_n;
    return kept * relief.height_m;
}

bool ToolProxy::stuck_before(const ProxyContact &contact) const noexcept {
    return std::any_of(before_.begin(), before_.begin() + before_count_,
                       [&contact](const ProxyContact &other) {
                           return other.sticks && other.tool_id == contact.tool_id &&
                                  other.scene_id == contact.scene_id;
                       });
}

// Returns the force on the tool towards the surface.
double ToolProxy::attraction_n(const ProxyContact &contact, const ScenePart &other) const noexcept {
    const SurfaceTraits &traits = other.traits;
    const double gap_m = std::max(contact.gap_m, 0.0);
    const double range_m = magnet_range_m(traits);
    double pull_n = range_m > 0.0 ? traits.magnet_n * std::max(0.0, 1.0 - gap_m / range_m) : 0.0;
    if (contact.sticks) {
        const double top_m = traits.adhesion_n / settings_.stiffness[0];
        pull_n += traits.adhesion_n *
                  std::clamp(std::min(gap_m / top_m, kAdhesionWays - gap_m / top_m), 0.0, 1.0);
    }
    return pull_n;
}

// A pair of tool and scene parts attracts like its nearest point, however many points it has: they
// share the pull in proportion to what each would pull alone.
void ToolProxy::attract(const ContactScene &scene) noexcept {
    std::array<double, kMaxPoints> alone_n{};
    for (int i = 0; i < count_; ++i) {
        const auto k = static_cast<std::size_t>(i);
        ProxyContact &contact = contacts_[k];
        const ScenePart &other = scene.parts[contact.scene_part];
        contact.sticks = other.traits.adhesion_n > 0.0 &&
                         (pair_pushes(contact) ||
                          (stuck_before(contact) && contact.gap_m < reach_m(other.traits)));
        alone_n[k] = attraction_n(contact, other);
    }
    for (int i = 0; i < count_; ++i) {
        const auto k = static_cast<std::size_t>(i);
        if (!(alone_n[k] > 0.0)) {
            continue;
        }
        double most_n = 0.0;
        double sum_n = 0.0;
        for (int j = 0; j < count_; ++j) {
            const auto other = static_cast<std::size_t>(j);
            if (contacts_[other].tool_part == contacts_[k].tool_part &&
                contacts_[other].scene_part == contacts_[k].scene_part) {
                most_n = std::max(most_n, alone_n[other]);
                sum_n += alone_n[other];
            }
        }
        contacts_[k].drawn_n -= most_n * alone_n[k] / sum_n * contacts_[k].normal;
    }
}

void ToolProxy::act_by_traits(const Tool &tool, const ContactScene &scene) noexcept {
    attract(scene);
    DofLanes sum = lanes(wrench_);
    for (int i = 0; i < count_; ++i) {
        ProxyContact &contact = contacts_[static_cast<std::size_t>(i)];
        // Downhill, as the gradient of the height's energy.
        contact.drawn_n -= std::min(contact.push_n, kMostShare * contact.alone_n) * contact.slope;
        if (contact.drawn_n == Vec3(0.0)) {
            continue;
        }
        add_force(tool.parts[contact.tool_part], tool.jaws, contact.point_m, contact.drawn_n, sum);
        PartForce &gets = given_[contact.scene_part];
        gets.force_n -= contact.drawn_n;
        gets.moment_nm -= glm::cross(contact.point_m - scene.parts[contact.scene_part].at.origin_m,
                                     contact.drawn_n);
    }
    wrench_ = of_lanes<Wrench>(sum);
}

} // namespace spidar
