// Points of the grip that contacts act on: their places and velocities, and the effect of a force
// there on the seven DOF. Inline: a servo cycle calls these functions a dozen times.
#pragma once

#include <glm/geometric.hpp>

#include "device/contract/grip_state.h"
#include "device/contract/haptic_command.h"

namespace spidar {

// Returns the vector from P0 to the point (unit: m); zero for the center and the stops.
[[nodiscard]] inline Vec3 grip_lever(const GripPose &pose, ContactTarget target) noexcept {
    switch (target) {
    case ContactTarget::pole1_plus:
        return pose.r1_m;
    case ContactTarget::pole1_minus:
        return -pose.r1_m;
    case ContactTarget::pole2_plus:
        return pose.r2_m;
    case ContactTarget::pole2_minus:
        return -pose.r2_m;
    case ContactTarget::centre:
    case ContactTarget::grasp_stop:
    case ContactTarget::turn_stop:
        break;
    }
    return Vec3(0.0);
}

// Returns by how much the point's pole turns about the grip's z axis per unit of grasp_angle. Both
// poles share psi = pi/2 - grasp_angle about their bisector: r1 lies at +psi/2, r2 at -psi/2.
[[nodiscard]] inline double turn_per_grasp(ContactTarget target) noexcept {
    switch (target) {
    case ContactTarget::pole1_plus:
    case ContactTarget::pole1_minus:
        return -0.5;
    case ContactTarget::pole2_plus:
    case ContactTarget::pole2_minus:
        return 0.5;
    case ContactTarget::centre:
    case ContactTarget::grasp_stop:
    case ContactTarget::turn_stop:
        break;
    }
    return 0.0;
}

// Returns the point in the device frame (unit: m).
[[nodiscard]] inline Vec3 grip_point(const GripPose &pose, ContactTarget target) noexcept {
    return pose.position_m + grip_lever(pose, target);
}

// Returns the velocity of the point for the grip's twist (unit: m/s). The poles turn about z by -+
// grasp_rate / 2.
[[nodiscard]] inline Vec3 grip_point_velocity(const GripState &grip,
                                              ContactTarget target) noexcept {
    const Vec3 z_axis = grip.frame.rotation[2];
    const Vec3 spin =
        grip.twist.angular_rad_s + turn_per_grasp(target) * grip.twist.grasp_rate_rad_s * z_axis;
    return grip.twist.linear_m_s + glm::cross(spin, grip_lever(grip.pose, target));
}

// Returns the wrench about P0 that does the same work in all seven DOF as force_n at the point
// (virtual work: the transpose of grip_point_velocity).
[[nodiscard]] inline Wrench wrench_of_force(const GripState &grip, ContactTarget target,
                                            const Vec3 &force_n) noexcept {
    Wrench wrench;
    wrench.force_n = force_n;
    wrench.moment_nm = glm::cross(grip_lever(grip.pose, target), force_n);
    wrench.grasp_torque_nm =
        turn_per_grasp(target) * glm::dot(grip.frame.rotation[2], wrench.moment_nm);
    return wrench;
}

} // namespace spidar
