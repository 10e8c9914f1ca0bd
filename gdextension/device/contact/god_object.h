// The god-object under one-sided constraints in seven DOF: the nearest pose that breaks none of them, in the metric of
// the stiffnesses, and the push of each constraint that holds it there (Zilles and Salisbury 1995; Ortega, Redon and
// Coquillart 2007). Forces are the gradient of one energy: no path through them gains any.
#pragma once

#include <array>
#include <cstdint>

#include "core/base/types.h"

namespace spidar {

inline constexpr int kMaxConstraints = 8;                    // of planes
inline constexpr int kMaxPoints = 24;                        // of shapes
inline constexpr int kMaxLimits = 6;                         // of joints
inline constexpr int kMaxRows = kMaxPoints + 1 + kMaxLimits; // with the stop of the jaws
static_assert(kMaxRows <= 32);                               // RowPushes::active_mask

// Row i of the problem: constraint i asks row . move + compliance * push >= depth, with `move` in units of sqrt(energy), so
// that the energy of a move is its squared length / 2. Lane 7 is zero.
struct ConstraintRow {
    std::array<double, 8> row{};
    double depth = 0.0;
    double compliance =
        0.0; // of what gives way behind the constraint; unit: that of depth per push
};

// Of what a constraint and the deepest one would push alone, the most that it pushes beside others: reached in a wedge of
// 50 degrees, and where no place satisfies all, as in a slot that is too narrow.
inline constexpr double kMostPush = 1.5;
// What this constraint would push alone.
[[nodiscard]] double own_push(const ConstraintRow &row) noexcept;

template <int kRows>
struct RowPushes {
    std::array<double, kRows> push{}; // >= 0; the move is the sum of push * row
    std::uint32_t active_mask = 0;
    int solves = 0; // linear systems solved
};
using GodObjectSolution = RowPushes<kMaxConstraints>;

// Exact: minimises |move|^2 / 2 under all rows, by the active set. Equal rows share equally. first_guess: the
// active set to begin with, for instance the last one; the answer does not depend on it beyond rounding.
// softness: added to the diagonal, relative to it; takes this part off the stiffness of a lone constraint and makes rows that
// depend on each other share. Not finite input gives no push. For kMaxConstraints and for kMaxRows.
template <int kRows>
[[nodiscard]] RowPushes<kRows> solve_rows(const std::array<ConstraintRow, kRows> &rows, int count,
                                          std::uint32_t first_guess, double softness) noexcept;

// Eight rows in seven DOF, or equal ones, leave the pushes open: this little makes them share.
inline constexpr double kPlaneSoftness = 1e-11;
[[nodiscard]] inline GodObjectSolution
solve_god_object(const std::array<ConstraintRow, kMaxConstraints> &rows, int count,
                 std::uint32_t first_guess) noexcept {
    return solve_rows<kMaxConstraints>(rows, count, first_guess, kPlaneSoftness);
}

} // namespace spidar
