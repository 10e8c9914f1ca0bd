// Refines a rough pose to the exact least-squares pose by damped Newton steps with the curvature of
// the lengths. For lengths with errors of millimeters Gauss-Newton converges only linearly, this
// method quadratically. With the damping it converges from distant starts too.
#pragma once

#include "core/kinematics/steps/gauss_newton.h"

namespace spidar {

// Step below which the search has converged: the limit of double precision.
inline constexpr double kConvergedStep_m = 1e-15;
// The search has also converged when a step below this no longer shrinks: it is rounding.
inline constexpr double kStagnantStep_m = 1e-9;
// Largest trial step: the linear model holds over about one pole length.
inline constexpr double kMaxTrialStep_m = 0.04;

struct PolishResult {
    GripPose pose;
    double residual_rms_m = 0.0;
    double min_pivot = 0.0; // of the final normal equations, as in GaussNewtonStep
    int steps = 0;
    bool converged = false; // false: step limit reached, or lengths not finite
};

[[nodiscard]] PolishResult polish_pose(const LengthProblem &problem,
                                       const GripPose &start) noexcept;

} // namespace spidar
