// Gauss-Newton on SE(3): the step of gauss_newton.h for grips without a hinge, tied at eight arbitrary points. Unknowns:
// displacement of P0, then the turn about it times pole_half_length_m, so that all six are metres.
#pragma once

#include "core/base/types.h"
#include "core/kinematics/steps/gauss_newton.h"

namespace spidar {

inline constexpr int kRigidDofCount = 6;
using RigidStep = std::array<double, kRigidDofCount>;

// P0 displaced, both poles turned by the rotation vector step[3..5] / d (unit: m), and made orthonormal again.
void move_rigid(GripPose &pose, const RigidStep &step, double pole_half_length_m) noexcept;

// The step that `errors` ask for at `pose`, not taken yet; and the smallest pivot of its normal equations.
struct RigidSolution {
    RigidStep step{};
    double min_pivot = 0.0;
    bool solvable = false;
};

[[nodiscard]] RigidSolution solve_rigid(const LengthProblem &problem, const LengthErrors &errors,
                                        const GripPose &pose,
                                        const ExpectedPose &expected) noexcept;

} // namespace spidar
