// The god-object of up to eight one-sided constraints in seven DOF: the nearest pose that breaks none of them, in
// the metric of the stiffnesses, and the push of each constraint that holds it there (Zilles and Salisbury 1995;
// Ortega, Redon and Coquillart 2007). Forces are the gradient of one energy: no path through them gains any.
#pragma once

#include <array>
#include <cstdint>

#include "core/base/types.h"

namespace spidar {

inline constexpr int kMaxConstraints = 8;

// Row i of the problem: constraint i asks row . move >= depth, with `move` in units of sqrt(energy), so that the
// energy of a move is its squared length / 2. Lane 7 is zero.
struct ConstraintRow {
    std::array<double, 8> row{};
    double depth = 0.0;
};

struct GodObjectSolution {
    std::array<double, kMaxConstraints> push{}; // >= 0; the move is the sum of push * row
    std::uint8_t active_mask = 0;
    int solves = 0; // linear systems solved
};

// Exact: minimises |move|^2 / 2 under all rows, by the active set. Equal rows share equally. first_guess: the
// active set to begin with, for instance the last one; the answer does not depend on it beyond rounding.
// Not finite input gives no push.
[[nodiscard]] GodObjectSolution
solve_god_object(const std::array<ConstraintRow, kMaxConstraints> &rows, int count,
                 std::uint8_t first_guess) noexcept;

} // namespace spidar
