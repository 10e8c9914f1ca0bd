// From a rough pose to the exact least-squares pose: damped Newton with the curvature of the lengths.
// Gauss-Newton converges only linearly when lengths carry errors of millimetres; this stays quadratic,
// and the damping makes it descend from starts far away.
#pragma once

#include "core/kinematics/steps/gauss_newton.h"

namespace spidar {

struct PolishResult {
    GripPose pose;
    double residual_rms_m = 0.0;
    double min_pivot = 0.0; // of the normal equations at the end, as in GaussNewtonStep
    int steps = 0;
    bool converged = false; // false: kMaxPolishSteps reached, or lengths that are not finite
};

[[nodiscard]] PolishResult polish_pose(const LengthProblem &problem,
                                       const GripPose &start) noexcept;

} // namespace spidar
