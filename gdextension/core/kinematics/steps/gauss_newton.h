// Least-squares fit of a grip pose to eight string lengths, on the manifold R3 x S2 x S2:
//   minimize sum_i (l_i - |Q_i - P0 - s_i r_k(i)|)^2.
// A rigid grip is fitted on SE(3) instead (rigid_step.h); exit pulleys change the length function
// (string_exit.h). Unknowns of a step are the displacement of P0 and two tangent displacements of
// each pole's end, all in meters, so that they can be compared. The normal equations are an arrow
// of two 2x2 pole blocks and a 3x3 position block. They square the condition number, but each step
// computes the residual anew, so that repeated steps converge to rounding.
#pragma once

#include "core/base/types.h"
#include "core/geometry/frame_geometry.h"
#include "core/geometry/grip_geometry.h"

namespace spidar {

// Frame, grip and lengths of one fit. References: valid for the duration of a call.
struct LengthProblem {
    const FrameGeometry &frame;
    const GripGeometry &grip;
    const StringArray &lengths_m;
};

// Errors of the eight lengths at a pose.
struct LengthErrors {
    StringArray residual_m{}; // measured - computed
    StringArray computed_m{};
    StringVectors direction{}; // unit vectors along which the lengths grow; zero when the ends meet
    double sum_of_squares_m2 = 0.0;
    [[nodiscard]] double rms_m() const noexcept;
};

[[nodiscard]] LengthErrors length_errors(const LengthProblem &problem,
                                         const GripPose &pose) noexcept;

struct GaussNewtonStep {
    double step_m = 0.0;    // Euclidean norm of the seven displacements
    double min_pivot = 0.0; // smallest scaled pivot, 0..1: about sigma7 squared
    bool solvable = false;  // false: a pivot vanished and the pose was not moved
};

// An expected pose and its weight against the lengths: weight |pose - expected|^2, over grip center
// and both poles, is added to the objective. Weight 0: the lengths alone decide.
struct ExpectedPose {
    GripPose pose;
    double weight = 0.0;
};

// Moves `pose` by one step from `errors` at that pose. The pivots include the expected pose.
GaussNewtonStep gauss_newton_step(const LengthProblem &problem, const LengthErrors &errors,
                                  GripPose &pose,
                                  const ExpectedPose &expected = ExpectedPose()) noexcept;

} // namespace spidar
