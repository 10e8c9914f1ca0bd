// From a rough pose to the exact least-squares pose: damped Newton with the curvature of the lengths.
// Gauss-Newton converges only linearly when lengths carry errors of millimetres; this stays quadratic,
// and the damping makes it descend from starts far away.
#pragma once

#include "core/kinematics/steps/gauss_newton.h"

namespace spidar {

// Newton to convergence: the step at which double precision ends.
inline constexpr double kConvergedStep_m = 1e-15;
// Below this a step that no longer shrinks is rounding, not progress.
inline constexpr double kStagnantStep_m = 1e-9;
// No trial step may exceed this: the linear model holds over about one pole length.
inline constexpr double kMaxTrialStep_m = 0.04;

struct PolishResult {
    GripPose pose;
    double residual_rms_m = 0.0;
    double min_pivot = 0.0; // of the normal equations at the end, as in GaussNewtonStep
    int steps = 0;
    bool converged = false; // false: its bound of steps reached, or lengths that are not finite
};

[[nodiscard]] PolishResult polish_pose(const LengthProblem &problem,
                                       const GripPose &start) noexcept;

} // namespace spidar
