// The god-object under one-sided constraints in seven DOF: the nearest pose that violates none of
// them, in the metric of the stiffnesses, and the push of each constraint (Zilles and Salisbury
// 1995; Ortega, Redon and Coquillart 2007). The forces are the gradient of one energy, so that no
// path gains energy.
#pragma once

#include <array>
#include <cstdint>

#include "core/base/types.h"

namespace spidar {

inline constexpr int kMaxConstraints = 8;                    // of contact planes
inline constexpr int kMaxPoints = 24;                        // contact points of shapes
inline constexpr int kMaxLimits = 6;                         // of joints
inline constexpr int kMaxRows = kMaxPoints + 1 + kMaxLimits; // with the stop of the jaws
static_assert(kMaxRows <= 32);                               // bits of RowPushes::active_mask

// Constraint i requires row . move + compliance * push >= depth. `move` is in units of
// sqrt(energy): the energy of a move is its squared length / 2. Lane 7 is zero.
struct ConstraintRow {
    std::array<double, 8> row{};
    double depth = 0.0;
    // Compliance behind the constraint, in units of depth per push.
    double compliance = 0.0;
};

// Largest push of a constraint relative to what it and the deepest one would push alone. It is
// reached in a wedge of 50 degrees, and where no pose satisfies all constraints, as in a slot that
// is too narrow.
inline constexpr double kMostPush = 1.5;
// Returns the push of this constraint without any other.
[[nodiscard]] double own_push(const ConstraintRow &row) noexcept;

template <int kRows>
struct RowPushes {
    std::array<double, kRows> push{}; // >= 0; the move is the sum of push * row
    std::uint32_t active_mask = 0;
    int solves = 0; // number of linear systems solved
};
using GodObjectSolution = RowPushes<kMaxConstraints>;

// Minimizes |move|^2 / 2 under all rows exactly, by an active set; equal rows share equally.
// first_guess: active set to start with, such as the last one; it does not change the answer beyond
// rounding. softness: added to the diagonal, relative to it. It lowers the stiffness of a single
// constraint by this share, and makes dependent rows share. Input that is not finite gives zero
// pushes. Instantiated for kMaxConstraints and kMaxRows.
template <int kRows>
[[nodiscard]] RowPushes<kRows> solve_rows(const std::array<ConstraintRow, kRows> &rows, int count,
                                          std::uint32_t first_guess, double softness) noexcept;

// Softness for planes. Eight rows in seven DOF, or equal rows, leave the pushes undetermined; this
// makes them share.
inline constexpr double kPlaneSoftness = 1e-11;
[[nodiscard]] inline GodObjectSolution
solve_god_object(const std::array<ConstraintRow, kMaxConstraints> &rows, int count,
                 std::uint32_t first_guess) noexcept {
    return solve_rows<kMaxConstraints>(rows, count, first_guess, kPlaneSoftness);
}

} // namespace spidar
