// An independent answer to a tension problem: given tensions, how far is the exact optimum?
// Quad precision, dense Gaussian elimination; slow and plain on purpose.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "core/tension/tension_solver.h"

namespace spidar::test {

#if defined(__SIZEOF_FLOAT128__)
__extension__ typedef __float128 Quad;
#else
using Quad = long double;
#endif

struct Certificate {
    bool certified = false;         // an active set whose KKT conditions hold was found
    double tension_error_n = 0.0;   // max |tau - exact|
    double objective_error = 0.0;   // relative to the exact objective, beyond rounding_cost()
    double bound_violation_n = 0.0; // 0 when every tension is within its bounds, exactly
    StringArray exact_n{};
};

namespace exact {

inline constexpr std::size_t kStrings = 8;
inline constexpr std::size_t kDofs = 7;

using QuadStrings = std::array<Quad, kStrings>;
using QuadMatrix = std::array<QuadStrings, kStrings>;

inline Quad magnitude(Quad value) {
    return value < 0 ? -value : value;
}

struct Quadratic { // half gradient = h x - g
    QuadMatrix h{};
    QuadStrings g{};
};

inline Quadratic quadratic_of(const TensionProblem &p) {
    Quadratic result;
    for (std::size_t i = 0; i < kStrings; ++i) {
        for (std::size_t k = 0; k < kDofs; ++k) {
            const Quad row = Quad(p.weights[k]) * p.weights[k] * p.matrix.columns[i][k];
            result.g[i] += row * p.wrench[k];
            for (std::size_t j = 0; j < kStrings; ++j) {
                result.h[i][j] += row * p.matrix.columns[j][k];
            }
        }
        result.h[i][i] += p.proximal_weight;
        result.g[i] += Quad(p.proximal_weight) * p.proximal_target_n[i];
    }
    return result;
}

// -1 at lower, 0 free, +1 at upper
using Sides = std::array<int, kStrings>;

inline QuadStrings solve_free(const Quadratic &q, const TensionProblem &p, const Sides &side) {
    QuadMatrix m = q.h;
    QuadStrings x = q.g;
    for (std::size_t i = 0; i < kStrings; ++i) {
        if (side[i] != 0) {
            m[i].fill(0);
            m[i][i] = 1;
            x[i] = side[i] < 0 ? p.lower_n[i] : p.upper_n[i];
        }
    }
    for (std::size_t j = 0; j < kStrings; ++j) {
        std::size_t pivot = j;
        for (std::size_t i = j + 1; i < kStrings; ++i) {
            pivot = magnitude(m[i][j]) > magnitude(m[pivot][j]) ? i : pivot;
        }
        std::swap(m[j], m[pivot]);
        std::swap(x[j], x[pivot]);
        for (std::size_t i = j + 1; i < kStrings; ++i) {
            const Quad factor = m[i][j] / m[j][j];
            for (std::size_t c = j; c < kStrings; ++c) {
                m[i][c] -= factor * m[j][c];
            }
            x[i] -= factor * x[j];
        }
    }
    for (std::size_t j = kStrings; j-- > 0;) {
        for (std::size_t c = j + 1; c < kStrings; ++c) {
            x[j] -= m[j][c] * x[c];
        }
        x[j] /= m[j][j];
    }
    return x;
}

inline Quad slope_at(const Quadratic &q, const QuadStrings &x, std::size_t i) {
    Quad slope = -q.g[i];
    for (std::size_t j = 0; j < kStrings; ++j) {
        slope += q.h[i][j] * x[j];
    }
    return slope;
}

inline Quad objective_of(const TensionProblem &p, const QuadStrings &x) {
    Quad sum = 0;
    for (std::size_t k = 0; k < kDofs; ++k) {
        Quad error = -Quad(p.wrench[k]);
        for (std::size_t i = 0; i < kStrings; ++i) {
            error += Quad(p.matrix.columns[i][k]) * x[i];
        }
        error *= p.weights[k];
        sum += error * error;
    }
    for (std::size_t i = 0; i < kStrings; ++i) {
        const Quad away = x[i] - p.proximal_target_n[i];
        sum += Quad(p.proximal_weight) * away * away;
    }
    return sum;
}

// What storing tensions as doubles may cost: (W |A| |tau| eps)^2 summed. Counts where the optimum is near 0.
inline Quad rounding_cost(const TensionProblem &p, const StringArray &tensions_n) {
    Quad sum = 1e-30; // 1e-15 N squared: an optimum of exactly zero is met when nobody can tell
    for (std::size_t k = 0; k < kDofs; ++k) {
        Quad force = 0;
        for (std::size_t i = 0; i < kStrings; ++i) {
            force += magnitude(Quad(p.matrix.columns[i][k]) * tensions_n[i]);
        }
        force *= Quad(p.weights[k]) * 0x1p-52;
        sum += force * force;
    }
    return sum;
}

inline QuadStrings widened(const StringArray &tensions_n) {
    QuadStrings x{};
    for (std::size_t i = 0; i < kStrings; ++i) {
        x[i] = tensions_n[i];
    }
    return x;
}

} // namespace exact

// Block principal pivoting with Murty's rule, cold (from no knowledge of `tensions_n`).
inline Certificate certify(const TensionProblem &p, const StringArray &tensions_n) {
    using namespace exact;
    // Quad rounding, as a tension and as a slope; twelve digits below the tolerances of the tests.
    const Quad tension_slack = 1e-22;
    const Quad slope_slack = 1e-24 * p.proximal_weight;
    constexpr int kMaxRounds = 3000;
    constexpr int kBlockRounds = 20;

    const Quadratic q = quadratic_of(p);
    Sides side{};
    QuadStrings x{};
    Certificate result;
    for (int round = 0; round < kMaxRounds && !result.certified; ++round) {
        for (std::size_t i = 0; i < kStrings; ++i) {
            side[i] = p.lower_n[i] == p.upper_n[i] ? -1 : side[i];
        }
        x = solve_free(q, p, side);
        bool changed = false;
        // All offenders at once at first; then only the last one (Murty), which always ends.
        for (std::size_t i = kStrings; i-- > 0;) {
            if (p.lower_n[i] == p.upper_n[i] || (changed && round >= kBlockRounds)) {
                continue;
            }
            int to = side[i];
            if (side[i] == 0) {
                to = x[i] < p.lower_n[i] - tension_slack   ? -1
                     : x[i] > p.upper_n[i] + tension_slack ? 1
                                                           : 0;
            } else {
                const Quad slope = slope_at(q, x, i);
                to = (side[i] < 0 ? -slope : slope) > slope_slack ? 0 : side[i];
            }
            changed = changed || to != side[i];
            side[i] = to;
        }
        result.certified = !changed;
    }
    for (std::size_t i = 0; i < kStrings; ++i) {
        result.exact_n[i] = static_cast<double>(x[i]);
        const Quad error = magnitude(x[i] - tensions_n[i]);
        // NaN compares false: count it as infinitely wrong.
        result.tension_error_n = error <= result.tension_error_n ? result.tension_error_n
                                 : error >= 0                    ? static_cast<double>(error)
                                                                 : HUGE_VAL;
        const double outside = std::max(p.lower_n[i] - tensions_n[i], tensions_n[i] - p.upper_n[i]);
        result.bound_violation_n =
            outside <= result.bound_violation_n ? result.bound_violation_n : outside;
    }
    const Quad best = objective_of(p, x);
    const Quad given = objective_of(p, widened(tensions_n));
    const Quad excess = given - best - rounding_cost(p, tensions_n);
    result.objective_error = excess > 0 ? static_cast<double>(excess / (best + Quad(1e-40))) : 0.0;
    return result;
}

// KKT residual of given tensions, in units of tension: each string's projected gradient over its H_ii.
inline double kkt_residual_n(const TensionProblem &p, const StringArray &tensions_n) {
    using namespace exact;
    const Quadratic q = quadratic_of(p);
    const QuadStrings x = widened(tensions_n);
    double worst = 0.0;
    for (std::size_t i = 0; i < kStrings; ++i) {
        const auto slope = static_cast<double>(slope_at(q, x, i) / q.h[i][i]);
        const double bounded = std::clamp(tensions_n[i] - slope, p.lower_n[i], p.upper_n[i]);
        worst = std::max(worst, std::abs(bounded - tensions_n[i]));
    }
    return worst;
}

} // namespace spidar::test
