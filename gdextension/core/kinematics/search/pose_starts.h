// Starts for frames without a closed form: the position that the eight lengths suggest when the grip is taken as
// a point, with the grip upright or tilted.
#pragma once

#include "core/kinematics/steps/gauss_newton.h"

namespace spidar {

// Rest, then 45 degrees either way about each axis of the grip.
inline constexpr int kStartCount = 7;

[[nodiscard]] GripPose start_pose(const LengthProblem &problem, int start) noexcept;

} // namespace spidar
