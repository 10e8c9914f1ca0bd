#include "device/contact/god_object.h"

#include <algorithm>
#include <cmath>

namespace spidar {

namespace {

// Share of the deepest constraint by which a row must fall short to count as violated.
constexpr double kBroken = 1e-12;
// Largest number of exchanges. Each lowers the energy, so that no active set returns; problems of
// this size take far fewer.
constexpr int kMostExchanges = 48;

template <int kRows>
using Values = std::array<double, kRows>;

template <int kRows>
struct Problem { // NOLINT(cppcoreguidelines-pro-type-member-init)
    std::size_t count = 0;
    double softness = 0.0;
    // Filled up to count: to clear them first would cost as much as a solve.
    std::array<Values<kRows>, kRows> gram;
    Values<kRows> depth;
};

// Solves gram * push = depth on the constraints of `mask`; other pushes are zero.
template <int kRows>
Values<kRows> solve_subset(const Problem<kRows> &problem, std::uint32_t mask) noexcept {
    std::array<std::size_t, kRows> index;
    std::size_t n = 0;
    for (std::size_t i = 0; i < problem.count; ++i) {
        if ((mask >> i) & 1U) {
            index[n++] = i;
        }
    }
    // LDL^T without square roots.
    std::array<Values<kRows>, kRows> l; // filled row by row, and so are the other two
    Values<kRows> pivot;
    Values<kRows> y;
    for (std::size_t r = 0; r < n; ++r) {
        const Values<kRows> &row = problem.gram[index[r]];
        double d = row[index[r]];
        double sum = problem.depth[index[r]];
        for (std::size_t c = 0; c < r; ++c) {
            double v = row[index[c]];
            for (std::size_t k = 0; k < c; ++k) {
                v -= l[r][k] * l[c][k] * pivot[k];
            }
            l[r][c] = v / pivot[c];
            d -= l[r][c] * v;
            sum -= l[r][c] * y[c];
        }
        // The matrix is regularized: only rounding can make a pivot vanish.
        pivot[r] = std::max(d, 0.5 * problem.softness * row[index[r]]);
        y[r] = sum;
    }
    Values<kRows> push{};
    for (std::size_t r = n; r-- > 0;) {
        double v = y[r] / pivot[r];
        for (std::size_t k = r + 1; k < n; ++k) {
            v -= l[k][r] * push[index[k]];
        }
        push[index[r]] = v;
    }
    return push;
}

// Returns the constraints of `mask` whose push is negative.
template <std::size_t kRows>
std::uint32_t negatives(const std::array<double, kRows> &push, std::uint32_t mask) noexcept {
    std::uint32_t found = 0;
    for (std::size_t i = 0; i < kRows; ++i) {
        found |= ((mask >> i) & 1U) != 0 && !(push[i] > 0.0) ? 1U << i : 0U;
    }
    return found;
}

} // namespace

double own_push(const ConstraintRow &row) noexcept {
    double square = 0.0;
    for (const double value : row.row) {
        square += value * value;
    }
    return square > 0.0 ? std::max(row.depth, 0.0) / square : 0.0;
}

template <int kRows>
RowPushes<kRows> solve_rows(const std::array<ConstraintRow, kRows> &rows, int count,
                            std::uint32_t first_guess, double softness) noexcept {
    RowPushes<kRows> solution;
    Problem<kRows> problem;
    problem.count = static_cast<std::size_t>(std::clamp(count, 0, kRows));
    problem.softness = softness;
    double deepest = 0.0;
    bool finite = true;
    for (std::size_t i = 0; i < problem.count; ++i) {
        problem.depth[i] = rows[i].depth;
        deepest = std::max(deepest, rows[i].depth);
        finite = finite && std::isfinite(rows[i].depth);
    }
    if (!finite || !(deepest > 0.0)) {
        return solution; // nothing is violated: the usual case in free space
    }
    double sum = 0.0;
    for (std::size_t i = 0; i < problem.count; ++i) {
        for (std::size_t j = 0; j <= i; ++j) {
            double dot = 0.0;
            for (std::size_t k = 0; k < rows[i].row.size(); ++k) {
                dot += rows[i].row[k] * rows[j].row[k];
            }
            problem.gram[i][j] = dot;
            problem.gram[j][i] = dot;
        }
        sum += problem.gram[i][i];
        problem.gram[i][i] = problem.gram[i][i] * (1.0 + softness) + rows[i].compliance;
    }
    if (!std::isfinite(sum)) {
        return solution;
    }

    // A guess with positive pushes is a feasible start; constraints with negative pushes are
    // removed from it.
    std::uint32_t active = first_guess & ((1U << problem.count) - 1U);
    Values<kRows> push{};
    while (active != 0) {
        push = solve_subset(problem, active);
        ++solution.solves;
        const std::uint32_t bad = negatives(push, active);
        if (bad == 0) {
            break;
        }
        active &= ~bad;
    }
    if (active == 0) {
        push = {};
    }

    const double tolerance = kBroken * deepest;
    for (int exchange = 0; exchange < kMostExchanges; ++exchange) {
        // The inactive constraint that is violated most becomes active.
        double worst = tolerance;
        std::uint32_t joining = 0;
        for (std::size_t i = 0; i < problem.count; ++i) {
            if ((active >> i) & 1U) {
                continue;
            }
            double shortfall = problem.depth[i];
            for (std::size_t j = 0; j < problem.count; ++j) {
                shortfall -= problem.gram[i][j] * push[j];
            }
            if (shortfall > worst) {
                worst = shortfall;
                joining = 1U << i;
            }
        }
        if (joining == 0) {
            break;
        }
        active |= joining;
        // Moves towards the new set's solution as far as every push stays positive (Lawson and
        // Hanson 1974).
        for (std::size_t drop = 0; drop < problem.count; ++drop) {
            const Values<kRows> target = solve_subset(problem, active);
            ++solution.solves;
            if (negatives(target, active) == 0) {
                push = target;
                break;
            }
            double part = 1.0;
            for (std::size_t i = 0; i < problem.count; ++i) {
                if (((active >> i) & 1U) && !(target[i] > 0.0)) {
                    part = std::min(part, push[i] > 0.0 ? push[i] / (push[i] - target[i]) : 0.0);
                }
            }
            for (std::size_t i = 0; i < problem.count; ++i) {
                if (!((active >> i) & 1U)) {
                    continue;
                }
                const double moved = push[i] + part * (target[i] - push[i]);
                const bool leaves = !(target[i] > 0.0) && !(moved > kBroken * std::abs(push[i]));
                push[i] = leaves ? 0.0 : std::max(moved, 0.0);
                active &= leaves ? ~(1U << i) : ~0U;
            }
        }
    }
    for (std::size_t i = 0; i < problem.count; ++i) {
        if (!std::isfinite(push[i])) {
            return RowPushes<kRows>();
        }
    }
    solution.push = push;
    solution.active_mask = active;
    return solution;
}

template RowPushes<kMaxConstraints>
solve_rows<kMaxConstraints>(const std::array<ConstraintRow, kMaxConstraints> &rows, int count,
                            std::uint32_t first_guess, double softness) noexcept;
template RowPushes<kMaxRows> solve_rows<kMaxRows>(const std::array<ConstraintRow, kMaxRows> &rows,
                                                  int count, std::uint32_t first_guess,
                                                  double softness) noexcept;

} // namespace spidar
