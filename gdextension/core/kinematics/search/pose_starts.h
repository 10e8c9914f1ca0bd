// Starting poses for frames without a closed form. The grip is taken as a point, whose
// least-squares position comes from the eight lengths.
#pragma once

#include "core/kinematics/steps/gauss_newton.h"

namespace spidar {

// Start 0 is upright; starts 1-6 are turned by 45 degrees either way about each axis.
inline constexpr int kStartCount = 7;

[[nodiscard]] GripPose start_pose(const LengthProblem &problem, int start) noexcept;

} // namespace spidar
