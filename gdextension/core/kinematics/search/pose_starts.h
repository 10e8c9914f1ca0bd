// Starting poses for frames without a closed form. Their position is the least-squares one of the
// eight lengths, computed as if all strings met in one point.
#pragma once

#include "core/kinematics/steps/gauss_newton.h"

namespace spidar {

// Start 0 is upright; starts 1-6 are turned by 45 degrees either way about each axis.
inline constexpr int kStartCount = 7;

[[nodiscard]] GripPose start_pose(const LengthProblem &problem, int start) noexcept;

} // namespace spidar
