// Computes the god-object in seven DOF: of all poses that violate no one-sided constraint, the one
// nearest to the device, and the push of each constraint (Zilles and Salisbury 1995; Ortega, Redon
// and Coquillart 2007). Distance is measured by the energy of the springs from the device to the
// god-object. The pushes are the gradient of that energy: a closed path of the device along
// constraints at rest gains no energy.
#pragma once

#include <array>
#include <cstdint>

#include "core/base/types.h"

namespace spidar {

inline constexpr int kMaxConstraints = 8; // largest number of contact planes
inline constexpr int kMaxPoints = 24;     // largest number of contact points of shapes
inline constexpr int kMaxLimits = 6;      // largest number of limits of joints
// contact points, the stop of the jaws, limits of joints
inline constexpr int kMaxRows = kMaxPoints + 1 + kMaxLimits;
static_assert(kMaxRows <= 32); // bits of RowPushes::active_mask

// One constraint: row . move + compliance * push >= depth. `move` is in units of sqrt(energy): half
// its squared length is the energy of the springs. Element 7 of `row` is zero.
struct ConstraintRow {
    std::array<double, 8> row{};
    double depth = 0.0;
    // How far the constraint gives way, in units of depth per unit of its push.
    double compliance = 0.0;
};

// A push is limited to this multiple of a sum: what the constraint would push alone (own_push()),
// plus the largest such push of all. The limit acts in wedges of less than about 50 degrees, and
// where no pose satisfies all constraints, as in a slot that is too narrow.
inline constexpr double kMostPush = 1.5;
// Returns the push of this constraint without the others and without its compliance.
[[nodiscard]] double own_push(const ConstraintRow &row) noexcept;

template <int kRows>
struct RowPushes {
    std::array<double, kRows> push{}; // >= 0; the move is the sum of push * row
    std::uint32_t active_mask = 0;
    int solves = 0; // number of linear systems solved
};
using GodObjectSolution = RowPushes<kMaxConstraints>;

// Finds the shortest move that satisfies all rows, by an active-set method; equal rows get equal
// pushes. first_guess: bits of the rows that are tried first, such as the last active_mask; they
// affect the result by rounding only. softness: each row's own element on the diagonal of the
// system is enlarged by this share. The stiffness of a single constraint falls by the same share,
// and linearly dependent rows share their push. Returns zero pushes if the input is not finite.
// Instantiated for kMaxConstraints and kMaxRows.
template <int kRows>
[[nodiscard]] RowPushes<kRows> solve_rows(const std::array<ConstraintRow, kRows> &rows, int count,
                                          std::uint32_t first_guess, double softness) noexcept;

// `softness` for contact planes. Without it, the pushes of eight rows in seven DOF, or of equal
// rows, would not be unique.
inline constexpr double kPlaneSoftness = 1e-11;
[[nodiscard]] inline GodObjectSolution
solve_god_object(const std::array<ConstraintRow, kMaxConstraints> &rows, int count,
                 std::uint32_t first_guess) noexcept {
    return solve_rows<kMaxConstraints>(rows, count, first_guess, kPlaneSoftness);
}

} // namespace spidar
