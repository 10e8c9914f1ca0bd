// The seven DOF of a twist on one scale, for monitors that weigh them against each other.
#pragma once

#include "device/contract/dof_lanes.h"

namespace spidar {

// Rotation and grasp as the speed of a pole's end (paper's grip: 40 mm; the grasp moves it by half the angle).
inline constexpr double kRotationArm_m = 0.04;
inline constexpr double kGraspArm_m = 0.02;

// m/s.
[[nodiscard]] inline DofLanes pole_end_speeds(const Twist &twist) noexcept {
    return lanes(twist.linear_m_s, kRotationArm_m * twist.angular_rad_s,
                 kGraspArm_m * twist.grasp_rate_rad_s);
}

} // namespace spidar
