// Computes the move that springs, dampers and motors cause together, each along a row of seven DOF.
#pragma once

#include <array>
#include <limits>

#include "device/contact/proxy/move.h"

namespace spidar {

// Each row requires of the move m (in units of sqrt(energy)) row . m = way - compliance * force,
// unless that takes |force| > most; its force is then limited. The move is the sum of force * row.
// Half its squared length is the energy of the springs that hold the tool to the device.
class RowForces {
public:
    static constexpr int kMost = 24;

    // Adds a row. Ignores rows beyond kMost, rows of zeros and rows that are not finite.
    void add(const Move &row, double way, double compliance,
             double most = std::numeric_limits<double>::infinity()) noexcept;
    // Returns the move. Solves a linear system for the rows below their limits, and again after a
    // row has reached its limit, where the row's force then stays. Zero if the result is not
    // finite.
    [[nodiscard]] Move solve() const noexcept;

private:
    struct Row {
        Move row{};
        double way = 0.0;
        double compliance = 0.0;
        double most = 0.0;
    };
    using Forces = std::array<double, kMost>;
    // Solves for the rows marked in `acts`, which are below their limits; the other forces stay.
    void solve_acting(const std::array<bool, kMost> &acts, Forces &forces) const noexcept;

    std::array<Row, kMost> rows_{};
    int count_ = 0;
};

} // namespace spidar
