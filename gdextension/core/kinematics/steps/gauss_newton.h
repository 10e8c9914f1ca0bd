// Least-squares fit of a grip pose to eight string lengths, on the manifold R3 x S2 x S2:
//   minimise sum_i (l_i - |Q_i - P0 - s_i r_k(i)|)^2,
// and likewise on SE(3) for a rigid grip (rigid_step.h) and around exit pulleys (string_exit.h).
// Unknowns of a step: displacement of P0 and two tangent displacements of each pole's end, all in metres,
// so that singular values compare. This is the plain step of the servo tick: its normal equations are an
// arrow (two 2x2 pole blocks, a 3x3 position). They square the conditioning, but each step starts
// from the true residual, so repeated steps end at the noise floor all the same.
#pragma once

#include "core/base/types.h"
#include "core/geometry/frame_geometry.h"
#include "core/geometry/grip_geometry.h"

namespace spidar {

// The problem's fixed part, borrowed for the length of a call.
struct LengthProblem {
    const FrameGeometry &frame;
    const GripGeometry &grip;
    const StringArray &lengths_m;
};

// Length errors at a pose, and the directions along which the lengths grow.
struct LengthErrors {
    StringArray residual_m{}; // measured - computed
    StringArray computed_m{};
    StringVectors direction{}; // unit, in which the length grows; zero when the ends meet
    double sum_of_squares_m2 = 0.0;
    [[nodiscard]] double rms_m() const noexcept;
};

[[nodiscard]] LengthErrors length_errors(const LengthProblem &problem,
                                         const GripPose &pose) noexcept;

struct GaussNewtonStep {
    double step_m = 0.0;    // Euclidean norm of the seven displacements
    double min_pivot = 0.0; // smallest pivot over its diagonal entry, 0..1 (about sigma7 squared)
    bool solvable = false;  // false: a pivot vanished, the pose was not moved
};

// Where the grip is expected, and the weight of that against the lengths: weight |pose - expected|^2, over the grip centre
// and both poles, is added to what is minimised. Weight 0: the lengths alone.
struct ExpectedPose {
    GripPose pose;
    double weight = 0.0;
};

// Moves `pose` by one Gauss-Newton step computed from its `errors`. The pivots count what is expected, too.
GaussNewtonStep gauss_newton_step(const LengthProblem &problem, const LengthErrors &errors,
                                  GripPose &pose,
                                  const ExpectedPose &expected = ExpectedPose()) noexcept;

} // namespace spidar
