#include "device/contact/proxy/tool.h"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "core/geometry/rotation_log.h"

namespace spidar {

namespace {

// Share of the gap by which this jaw moves along the grip's x axis.
double part_of_gap(ToolMount mount) noexcept {
    switch (mount) {
    case ToolMount::jaw_minus:
        return -0.5;
    case ToolMount::jaw_plus:
        return 0.5;
    case ToolMount::grip:
        break;
    }
    return 0.0;
}

} // namespace

ToolPose moved(const ToolPose &pose, const Displacement &by) noexcept {
    return {pose.position_m + by.linear_m, rotation_exp(by.angular_rad) * pose.rotation,
            pose.grasp_rad + by.grasp_rad};
}

Displacement between(const ToolPose &from, const ToolPose &to) noexcept {
    return {to.position_m - from.position_m,
            rotation_log(to.rotation * glm::transpose(from.rotation)),
            to.grasp_rad - from.grasp_rad};
}

Placement placement_of(const ToolPart &part, const Jaws &jaws, const ToolPose &pose) noexcept {
    const double along_m = part_of_gap(part.mount) * jaws.gap_m(pose.grasp_rad);
    const Placement mount{pose.position_m + along_m * pose.rotation[0], pose.rotation};
    return mount * part.at;
}

Displacement moves_along(const ToolPart &part, const Jaws &jaws, const ToolPose &pose,
                         const Vec3 &point_m, const Vec3 &direction) noexcept {
    const double slide_m_rad = part_of_gap(part.mount) * jaws.slope_m_rad();
    return {direction, glm::cross(point_m - pose.position_m, direction),
            slide_m_rad * glm::dot(pose.rotation[0], direction)};
}

Vec3 point_velocity(const ToolPart &part, const Jaws &jaws, const ToolPose &pose,
                    const Twist &twist, const Vec3 &point_m) noexcept {
    const double slide_m_rad = part_of_gap(part.mount) * jaws.slope_m_rad();
    return twist.linear_m_s + glm::cross(twist.angular_rad_s, point_m - pose.position_m) +
           (slide_m_rad * twist.grasp_rate_rad_s) * pose.rotation[0];
}

void carry_on(Placement &at, const Vec3 &velocity_m_s, const Vec3 &angular_rad_s,
              double dt_s) noexcept {
    at.origin_m += dt_s * velocity_m_s;
    if (angular_rad_s != Vec3(0.0)) {
        at.rotation = rotation_exp(dt_s * angular_rad_s) * at.rotation;
    }
}

} // namespace spidar
