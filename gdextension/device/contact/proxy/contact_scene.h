// The shapes of the scene that lie near the tool, as a game publishes them once a tick. Device frame, SI: already divided
// by the workspace's scale.
#pragma once

#include <array>
#include <cstdint>

#include <glm/geometric.hpp>

#include "device/contact/proxy/surface_traits.h"
#include "device/contact/proxy/tool.h"
#include "device/contact/shapes/cooked_shape.h"
#include "device/contact/shapes/placement.h"

namespace spidar {

struct ScenePart {
    const CookedShape *shape = nullptr; // the game keeps it alive
    Placement at;
    Vec3 velocity_m_s{0.0}; // of at.origin_m
    Vec3 angular_rad_s{0.0};
    // How its surface runs along itself while the shape stands still, beside the motion above: the belt of a conveyor, a turning
    // table. Felt by friction alone. Velocity at at.origin_m.
    Vec3 belt_m_s{0.0};
    Vec3 belt_rad_s{0.0};
    // Of this part's own surface, in series with the tool's; 0: it does not give way.
    double stiffness_n_m = 0.0;
    double damping_n_s_m = 0.0;
    double friction = 0.0; // Coulomb coefficient, of a contact that slips
    SurfaceTraits traits;
    std::int32_t id = 0;              // of this shape of this body; persistent
    std::uint8_t groups = kAllGroups; // what of the tool touches it
};

// The part of it that lies in a surface with this normal.
[[nodiscard]] inline Vec3 along_surface(const Vec3 &v, const Vec3 &normal) noexcept {
    return v - glm::dot(normal, v) * normal;
}

// Of the shape where point_m is.
[[nodiscard]] inline Vec3 surface_velocity(const ScenePart &part, const Vec3 &point_m) noexcept {
    return part.velocity_m_s + glm::cross(part.angular_rad_s, point_m - part.at.origin_m);
}

// What rubs on the tool where point_m is. Only its part along the surface means anything.
[[nodiscard]] inline Vec3 rubbing_velocity(const ScenePart &part, const Vec3 &point_m) noexcept {
    return surface_velocity(part, point_m) + part.belt_m_s +
           glm::cross(part.belt_rad_s, point_m - part.at.origin_m);
}

inline constexpr int kMaxSceneParts = 32;
struct ContactScene {
    std::array<ScenePart, kMaxSceneParts> parts{};
    int count = 0;
};

} // namespace spidar
