// Points of the grip that contacts act on: where they are, how they move, and what a force there does to the
// seven degrees of freedom.
#pragma once

#include "device/servo_snapshot.h"

namespace spidar {

// Device frame (unit: m). a stop has no point: P0.
[[nodiscard]] Vec3 grip_point(const GripPose &pose, ContactTarget target) noexcept;

// Velocity of that point for this twist (unit: m/s). The poles turn about z by -+ grasp_rate / 2.
[[nodiscard]] Vec3 grip_point_velocity(const GripState &grip, ContactTarget target) noexcept;

// The wrench about P0 that does the same work as `force_n` at the point, in all seven DOF (virtual work: the
// transpose of grip_point_velocity).
[[nodiscard]] Wrench wrench_of_force(const GripState &grip, ContactTarget target,
                                     const Vec3 &force_n) noexcept;

} // namespace spidar
