// Springs, dampers and motors along rows of one problem, solved together: where a move goes that they pull on.
#pragma once

#include <array>
#include <limits>

#include "device/contact/proxy/move.h"

namespace spidar {

// Each row asks the move m, in units of sqrt(energy), for row . m = way - compliance * force, with |force| <= most. The move is
// the sum of force * row, and costs its squared length / 2: that of the springs which hold the tool to the device.
class RowForces {
public:
    static constexpr int kMost = 24;

    // More than kMost are left out.
    void add(const Move &row, double way, double compliance,
             double most = std::numeric_limits<double>::infinity()) noexcept;
    // Exact: a linear system for those below their limits, again for each that reaches it. What is not finite pulls nothing.
    [[nodiscard]] Move solve() const noexcept;

private:
    struct Row {
        Move row{};
        double way = 0.0;
        double compliance = 0.0;
        double most = 0.0;
    };
    using Forces = std::array<double, kMost>;
    // The forces of the rows that `acts` says are below their limits; the others' stay as they are.
    void solve_acting(const std::array<bool, kMost> &acts, Forces &forces) const noexcept;

    std::array<Row, kMost> rows_{};
    int count_ = 0;
};

} // namespace spidar
