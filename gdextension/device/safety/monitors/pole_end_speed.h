// Speeds of all seven DOF at the pole ends, so that monitors can compare them.
#pragma once

#include "device/contract/dof_lanes.h"

namespace spidar {

// Lever that converts a turn rate to the speed of a pole's end: the paper's pole half length.
inline constexpr double kRotationArm_m = 0.04;
// Lever from grasp rate to the speed of a pole's end: each pole turns by half the angle.
inline constexpr double kGraspArm_m = 0.02;

// Returns the speeds (unit: m/s).
[[nodiscard]] inline DofLanes pole_end_speeds(const Twist &twist) noexcept {
    return lanes(twist.linear_m_s, kRotationArm_m * twist.angular_rad_s,
                 kGraspArm_m * twist.grasp_rate_rad_s);
}

} // namespace spidar
