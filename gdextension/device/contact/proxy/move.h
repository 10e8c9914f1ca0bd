// A move of the tool in units of sqrt(energy), as in god_object.h: seven DOF and an eighth element
// that is zero.
#pragma once

#include <array>

#include "device/contract/dof_lanes.h"

namespace spidar {

using Move = std::array<double, 8>;

[[nodiscard]] inline double dot(const Move &a, const Move &b) noexcept {
    double sum = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        sum += a[i] * b[i];
    }
    return sum;
}

inline void add(Move &to, double factor, const Move &what) noexcept {
    for (std::size_t i = 0; i < to.size(); ++i) {
        to[i] += factor * what[i];
    }
}

// Converts a displacement or velocity to a move. root: square root of the stiffness per DOF.
[[nodiscard]] inline Move times(const DofLanes &row, const Move &root) noexcept {
    Move move{};
    for (std::size_t dof = 0; dof < row.size(); ++dof) {
        move[dof] = row[dof] * root[dof];
    }
    return move;
}

// Converts a force per DOF, or the motion of a point per DOF, to a row for moves.
[[nodiscard]] inline Move over(const DofLanes &row, const Move &root) noexcept {
    Move move{};
    for (std::size_t dof = 0; dof < row.size(); ++dof) {
        move[dof] = row[dof] / root[dof];
    }
    return move;
}

} // namespace spidar
