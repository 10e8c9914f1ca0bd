#include "device/grip_points.h"

#include <glm/geometric.hpp>

namespace spidar {

namespace {

Vec3 lever_of(const GripPose &pose, ContactTarget target) noexcept {
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

// Turn of a pole about the grip's z per unit of grasp_angle. psi = pi/2 - grasp_angle is shared by both poles
// about their bisector: r1 lies at +psi/2 from it, r2 at -psi/2.
double turn_per_grasp(ContactTarget target) noexcept {
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

} // namespace

Vec3 grip_point(const GripPose &pose, ContactTarget target) noexcept {
    return pose.position_m + lever_of(pose, target);
}

Vec3 grip_point_velocity(const GripState &grip, ContactTarget target) noexcept {
    const Vec3 z_axis = grip.frame.rotation[2];
    const Vec3 spin =
        grip.twist.angular_rad_s + turn_per_grasp(target) * grip.twist.grasp_rate_rad_s * z_axis;
    return grip.twist.linear_m_s + glm::cross(spin, lever_of(grip.pose, target));
}

Wrench wrench_of_force(const GripState &grip, ContactTarget target, const Vec3 &force_n) noexcept {
    Wrench wrench;
    wrench.force_n = force_n;
    wrench.moment_nm = glm::cross(lever_of(grip.pose, target), force_n);
    wrench.grasp_torque_nm =
        turn_per_grasp(target) * glm::dot(grip.frame.rotation[2], wrench.moment_nm);
    return wrench;
}

} // namespace spidar
