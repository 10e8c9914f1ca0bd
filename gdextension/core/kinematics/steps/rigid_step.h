// Gauss-Newton step on SE(3) for grips without a hinge, tied at eight arbitrary points. Unknowns:
// the displacement of P0, then the turn about P0 times pole_half_length_m, so that all six are in
// meters.
#pragma once

#include "core/base/types.h"
#include "core/kinematics/steps/gauss_newton.h"

namespace spidar {

inline constexpr int kRigidDofCount = 6;
using RigidStep = std::array<double, kRigidDofCount>;

// Moves P0, turns both poles by the vector step[3..5] / d (rad) and makes them orthogonal.
void move_rigid(GripPose &pose, const RigidStep &step, double pole_half_length_m) noexcept;

// The step for `errors` at `pose`, not yet applied, and its smallest scaled pivot.
struct RigidSolution {
    RigidStep step{};
    double min_pivot = 0.0;
    bool solvable = false;
};

[[nodiscard]] RigidSolution solve_rigid(const LengthProblem &problem, const LengthErrors &errors,
                                        const GripPose &pose,
                                        const ExpectedPose &expected) noexcept;

} // namespace spidar
