#include "device/contact/proxy/row_forces.h"

#include <algorithm>
#include <cmath>

#include "core/base/finite.h"

namespace spidar {

namespace {

// Relative softness of each row, so that equal rows share, as two motors on one axis.
constexpr double kShares = 1e-6;

} // namespace

void RowForces::add(const Move &row, double way, double compliance, double most) noexcept {
    const double softness = dot(row, row);
    if (count_ == kMost || !(softness > 0.0) || !std::isfinite(softness + way + compliance)) {
        return;
    }
    rows_[static_cast<std::size_t>(count_++)] = {row, way, compliance + kShares * softness, most};
}

// Cholesky's method on rows . rows + compliance, which is positive definite.
void RowForces::solve_acting(const std::array<bool, kMost> &acts, Forces &forces) const noexcept {
    std::array<std::size_t, kMost> which{};
    std::size_t size = 0;
    Move given{};
    for (std::size_t i = 0; i < static_cast<std::size_t>(count_); ++i) {
        if (acts[i]) {
            which[size++] = i;
            continue;
        }
        spidar::add(given, forces[i], rows_[i].row);
    }
    std::array<std::array<double, kMost>, kMost> lower{};
    Forces solved{};
    for (std::size_t i = 0; i < size; ++i) {
        const Row &row = rows_[which[i]];
        double way = row.way - dot(row.row, given);
        for (std::size_t j = 0; j <= i; ++j) {
            double sum = dot(row.row, rows_[which[j]].row) + (i == j ? row.compliance : 0.0);
            for (std::size_t k = 0; k < j; ++k) {
                sum -= lower[i][k] * lower[j][k];
            }
            lower[i][j] = i == j ? std::sqrt(std::max(sum, row.compliance)) : sum / lower[j][j];
        }
        for (std::size_t k = 0; k < i; ++k) {
            way -= lower[i][k] * solved[k];
        }
        solved[i] = way / lower[i][i];
    }
    for (std::size_t i = size; i-- > 0;) {
        for (std::size_t k = i + 1; k < size; ++k) {
            solved[i] -= lower[k][i] * solved[k];
        }
        solved[i] /= lower[i][i];
        forces[which[i]] = solved[i];
    }
}

Move RowForces::solve() const noexcept {
    Forces forces{};
    std::array<bool, kMost> acts{};
    acts.fill(true);
    // Each round removes at least one row, or is the last.
    for (int round = 0; round <= count_; ++round) {
        solve_acting(acts, forces);
        bool limited = false;
        for (std::size_t i = 0; i < static_cast<std::size_t>(count_); ++i) {
            if (acts[i] && std::abs(forces[i]) > rows_[i].most) {
                forces[i] = std::copysign(rows_[i].most, forces[i]);
                acts[i] = false;
                limited = true;
            }
        }
        if (!limited) {
            break;
        }
    }
    Move move{};
    for (std::size_t i = 0; i < static_cast<std::size_t>(count_); ++i) {
        spidar::add(move, forces[i], rows_[i].row);
    }
    return all_finite(move) ? move : Move{};
}

} // namespace spidar
