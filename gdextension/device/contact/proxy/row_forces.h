// Springs, dampers and motors along rows of one problem: computes the move that they cause.
#pragma once

#include <array>
#include <limits>

#include "device/contact/proxy/move.h"

namespace spidar {

// Each row requires of the move m (in units of sqrt(energy)) row . m = way - compliance * force,
// with |force| <= most. The move is the sum of force * row and costs its squared length / 2, the
// energy of the springs that hold the tool to the device.
class RowForces {
public:
    static constexpr int kMost = 24;

    // Adds a row; rows beyond kMost are ignored.
    void add(const Move &row, double way, double compliance,
             double most = std::numeric_limits<double>::infinity()) noexcept;
    // Returns the exact move: a linear system for the rows below their limits, solved again when a
    // row reaches its limit. Rows that are not finite have no force.
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
