// The shapes of the scene near the tool, as a game publishes them once per physics tick. Device
// frame, SI units of the device: the workspace scale is removed.
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
    // Velocity at at.origin_m of a surface that runs along itself while the shape stands still,
    // such as a conveyor belt or a turntable. It adds to the motion above and is felt through
    // friction only.
    Vec3 belt_m_s{0.0};
    // Turn rate of such a surface about at.origin_m.
    Vec3 belt_rad_s{0.0};
    // Stiffness that the hand feels when it presses this part, the springs between device and proxy
    // included; these are its upper limit. 0: rigid.
    double stiffness_n_m = 0.0;
    // A new stiffness acts at once, not within kFeelFade_s: the part is soft because the push moves
    // it, and becomes rigid when it is pinched.
    bool stiffness_at_once = false;
    double damping_n_s_m = 0.0;
    // Coulomb coefficient of a sliding contact.
    double friction = 0.0;
    SurfaceTraits traits;
    // Id of this shape of this body, the same in every scene.
    std::int32_t id = 0;
    // Collision groups: a tool part can touch this part only if the two share a bit.
    std::uint8_t groups = kAllGroups;
};

// Returns the part of v that lies in a surface with this normal.
[[nodiscard]] inline Vec3 along_surface(const Vec3 &v, const Vec3 &normal) noexcept {
    return v - glm::dot(normal, v) * normal;
}

// Returns the velocity of the shape at point_m.
[[nodiscard]] inline Vec3 surface_velocity(const ScenePart &part, const Vec3 &point_m) noexcept {
    return part.velocity_m_s + glm::cross(part.angular_rad_s, point_m - part.at.origin_m);
}

// Returns the velocity of the surface at point_m, belt included. Friction uses only its component
// along the surface.
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
