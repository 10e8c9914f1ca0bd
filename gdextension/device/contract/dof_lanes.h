// The seven DOF as a row of numbers in the order of DofGains: x, y, z, turns about x, y, z, grasp.
// This row is not the paper's q, whose g is twice the grasp torque (core/base/types.h). The file
// also defines the sum of two wrenches and the product with a number.
#pragma once

#include <array>

#include "core/base/types.h"
#include "device/contract/motion.h"

namespace spidar {

using DofLanes = std::array<double, kDofCount>;
inline constexpr std::size_t kGraspLane = kDofCount - 1;

[[nodiscard]] inline DofLanes lanes(const Vec3 &linear, const Vec3 &angular,
                                    double grasp) noexcept {
    return {linear.x, linear.y, linear.z, angular.x, angular.y, angular.z, grasp};
}
[[nodiscard]] inline DofLanes lanes(const Wrench &wrench) noexcept {
    return lanes(wrench.force_n, wrench.moment_nm, wrench.grasp_torque_nm);
}
[[nodiscard]] inline DofLanes lanes(const Twist &twist) noexcept {
    return lanes(twist.linear_m_s, twist.angular_rad_s, twist.grasp_rate_rad_s);
}
[[nodiscard]] inline DofLanes lanes(const Displacement &moved) noexcept {
    return lanes(moved.linear_m, moved.angular_rad, moved.grasp_rad);
}

// Converts a row back to a Wrench, Twist or Displacement.
template <typename Quantity>
[[nodiscard]] Quantity of_lanes(const DofLanes &row) noexcept {
    return {Vec3(row[0], row[1], row[2]), Vec3(row[3], row[4], row[5]), row[6]};
}

[[nodiscard]] inline Wrench operator+(const Wrench &a, const Wrench &b) noexcept {
    return {a.force_n + b.force_n, a.moment_nm + b.moment_nm,
            a.grasp_torque_nm + b.grasp_torque_nm};
}
[[nodiscard]] inline Wrench operator*(double factor, const Wrench &wrench) noexcept {
    return {factor * wrench.force_n, factor * wrench.moment_nm, factor * wrench.grasp_torque_nm};
}

} // namespace spidar
