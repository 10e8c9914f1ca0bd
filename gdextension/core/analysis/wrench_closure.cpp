#include "core/analysis/wrench_closure.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/base/finite.h"
#include "core/tension/exact/tension_problem.h"

namespace spidar {

namespace {

// Share of the largest element below which a pivot is rounding and its direction lost.
constexpr double kLostPivot = 1e-12;
// Tolerance of a tension limit at a corner of the feasible region: the rounding of 10 N.
constexpr double kSlack_n = 1e-11;

// All tensions with W A tau = s W q: tau = s particular + t null.
struct Solutions {
    bool full_rank = false;
    StringArray particular{};
    StringArray null{}; // largest element +1
};

Solutions solve_all(const WrenchMatrix &matrix, const PaperWrench &wrench,
                    const TensionSettings &settings) noexcept {
    const PaperWeights weights = tension_weights(settings);
    std::array<std::array<double, kStringCount + 1>, kDofCount> m{}; // last column: q
    std::array<std::size_t, kStringCount> order{};
    double largest = 0.0;
    for (std::size_t i = 0; i < kStringCount; ++i) {
        order[i] = i;
        const bool broken = has_string(settings.broken_mask, i);
        for (std::size_t k = 0; k < kDofCount; ++k) {
            m[k][i] = broken ? 0.0 : weights[k] * matrix.columns[i][k];
            m[k][kStringCount] = weights[k] * wrench[k];
            largest = std::max(largest, std::abs(m[k][i]));
        }
    }
    // Gauss-Jordan with complete pivoting; columns swap, `order` remembers.
    for (std::size_t step = 0; step < kDofCount; ++step) {
        std::size_t row = step;
        std::size_t column = step;
        for (std::size_t k = step; k < kDofCount; ++k) {
            for (std::size_t c = step; c < kStringCount; ++c) {
                if (std::abs(m[k][c]) > std::abs(m[row][column])) {
                    row = k;
                    column = c;
                }
            }
        }
        const double pivot = m[row][column];
        if (!(std::abs(pivot) > kLostPivot * largest) || !std::isfinite(pivot)) {
            return {};
        }
        std::swap(m[step], m[row]);
        std::swap(order[step], order[column]);
        for (auto &line : m) {
            std::swap(line[step], line[column]);
        }
        for (double &value : m[step]) {
            value /= pivot;
        }
        for (std::size_t k = 0; k < kDofCount; ++k) {
            const double factor = m[k][step];
            if (k == step) {
                continue;
            }
            for (std::size_t c = step; c <= kStringCount; ++c) {
                m[k][c] -= factor * m[step][c];
            }
        }
    }
    Solutions result;
    result.full_rank = true;
    const std::size_t last = order[kStringCount - 1];
    result.null[last] = 1.0;
    for (std::size_t k = 0; k < kDofCount; ++k) {
        result.null[order[k]] = -m[k][kStringCount - 1];
        result.particular[order[k]] = m[k][kStringCount];
    }
    double peak = 0.0;
    for (const double value : result.null) {
        peak = std::abs(value) > std::abs(peak) ? value : peak;
    }
    for (double &value : result.null) {
        value /= peak;
    }
    return result;
}

// True when lower <= s particular + t null <= upper for each string, within the tolerance.
bool feasible(const Solutions &all, const TensionSettings &settings, double s, double t) noexcept {
    for (std::size_t i = 0; i < kStringCount; ++i) {
        const double tension = s * all.particular[i] + t * all.null[i];
        const double slack = kSlack_n * (1.0 + std::abs(s * all.particular[i]));
        if (!(tension >= settings.min_tension_n - slack &&
              tension <= settings.max_tension_n + slack)) {
            return false;
        }
    }
    return true;
}

// With a DOF mask there are many null vectors, and many tensions for one wrench, so that the solver
// itself decides what is feasible. A weighted error below this is feasible (unit: N at the pole
// ends).
constexpr double kGiven_n = 1e-9;
// Weight of a regularizing term that has no effect except uniqueness.
constexpr double kVanishingWeight = 1e-12;
// Halvings that narrow an interval of 1 to rounding.
constexpr int kHalvings = 45;
// Smallest margin that counts.
constexpr double kNoMargin = 1e-7;

TensionProblem masked_problem(const WrenchMatrix &matrix, const TensionSettings &settings,
                              double least_n, double most_n) noexcept {
    TensionProblem problem;
    problem.matrix = matrix;
    problem.weights = tension_weights(settings);
    problem.proximal_weight = kVanishingWeight;
    for (std::size_t i = 0; i < kStringCount; ++i) {
        const bool works = !has_string(settings.broken_mask, i);
        problem.lower_n[i] = works ? least_n : 0.0;
        problem.upper_n[i] = works ? most_n : 0.0;
        problem.proximal_target_n[i] = problem.upper_n[i];
    }
    return problem;
}

WrenchClosure masked_closure(const WrenchMatrix &matrix, const TensionSettings &settings) noexcept {
    WrenchClosure closure;
    double can = 0.0;
    double cannot = 1.0;
    for (int halving = 0; halving < kHalvings; ++halving) {
        const double margin = 0.5 * (can + cannot);
        const TensionSolution solution =
            solve_tension_problem(masked_problem(matrix, settings, margin, 1.0), nullptr);
        const bool closed = solution.status == Status::ok && solution.largest_error_n <= kGiven_n;
        if (closed) {
            closure.null_tensions = solution.tensions_n;
        }
        (closed ? can : cannot) = margin;
    }
    closure.margin = can > kNoMargin ? can : 0.0;
    if (closure.margin <= 0.0) {
        closure.null_tensions = {};
    }
    return closure;
}

FeasibleScale masked_scale(const WrenchMatrix &matrix, const PaperWrench &wrench,
                           const TensionSettings &settings) noexcept {
    TensionProblem problem =
        masked_problem(matrix, settings, settings.min_tension_n, settings.max_tension_n);
    double request = 0.0; // |W q| squared
    double reach_n = 0.0; // no weighted wrench is larger
    for (std::size_t k = 0; k < kDofCount; ++k) {
        const double weighted = problem.weights[k] * wrench[k];
        request += weighted * weighted;
        for (std::size_t i = 0; i < kStringCount; ++i) {
            reach_n += std::abs(problem.weights[k] * matrix.columns[i][k]) * settings.max_tension_n;
        }
    }
    struct Look {
        bool given = false;
        bool too_small = false; // a larger scale comes nearer
    };
    const auto look_at = [&](double scale) {
        for (std::size_t k = 0; k < kDofCount; ++k) {
            problem.wrench[k] = scale * wrench[k];
        }
        const TensionSolution solution = solve_tension_problem(problem, nullptr);
        const PaperWrench achieved = spidar::apply(matrix, solution.tensions_n);
        double along = 0.0;
        for (std::size_t k = 0; k < kDofCount; ++k) {
            const double square = problem.weights[k] * problem.weights[k];
            along += square * (achieved[k] - problem.wrench[k]) * wrench[k];
        }
        return Look{solution.status == Status::ok && solution.largest_error_n <= kGiven_n,
                    along > 0.0};
    };
    const Look none = look_at(0.0);
    FeasibleScale result;
    if (!(request > 0.0)) {
        result.any = none.given;
        result.largest = none.given ? std::numeric_limits<double>::infinity() : 0.0;
        return result;
    }
    // The distance to the feasible set is convex in the scale: bisection finds its minimum.
    const double most = reach_n / std::sqrt(request);
    double low = 0.0;
    double high = most;
    double inside = 0.0;
    bool found = none.given;
    for (int halving = 0; halving < kHalvings && !found; ++halving) {
        inside = 0.5 * (low + high);
        const Look look = look_at(inside);
        found = look.given;
        (look.too_small ? low : high) = inside;
    }
    if (!found) {
        return result;
    }
    const auto border = [&](double given, double not_given) {
        for (int halving = 0; halving < kHalvings; ++halving) {
            const double middle = 0.5 * (given + not_given);
            (look_at(middle).given ? given : not_given) = middle;
        }
        return given;
    };
    result.any = true;
    result.least = none.given ? 0.0 : border(inside, 0.0);
    result.largest = border(inside, 2.0 * most);
    return result;
}

} // namespace

WrenchClosure wrench_closure(const WrenchMatrix &matrix, const TensionSettings &settings) noexcept {
    if (settings.dof_mask != kAllDofs) {
        return masked_closure(matrix, settings);
    }
    WrenchClosure closure;
    const Solutions all = solve_all(matrix, PaperWrench{}, settings);
    if (!all.full_rank) {
        return closure;
    }
    closure.null_tensions = all.null;
    // The largest element is 1, so the smallest is the ratio.
    const double smallest = *std::min_element(all.null.begin(), all.null.end());
    closure.margin = settings.broken_mask == 0 ? std::max(smallest, 0.0) : 0.0;
    return closure;
}

FeasibleScale feasible_scale(const WrenchMatrix &matrix, const PaperWrench &wrench,
                             const TensionSettings &settings) noexcept {
    FeasibleScale scale;
    if (!all_finite(wrench)) {
        return scale;
    }
    if (settings.dof_mask != kAllDofs || settings.broken_mask != 0) {
        return masked_scale(matrix, wrench, settings);
    }
    const Solutions all = solve_all(matrix, wrench, settings);
    if (!all.full_rank) {
        return scale;
    }
    const double limits[2] = {settings.min_tension_n, settings.max_tension_n};
    const auto include = [&scale](double s) {
        scale.least = scale.any ? std::min(scale.least, s) : s;
        scale.largest = scale.any ? std::max(scale.largest, s) : s;
        scale.any = true;
    };
    // For a zero request any t that keeps the null tensions within the limits is feasible.
    if (std::all_of(wrench.begin(), wrench.end(), [](double q) { return q == 0.0; })) {
        for (std::size_t i = 0; i < kStringCount && !scale.any; ++i) {
            for (const double limit : limits) {
                if (all.null[i] != 0.0 && feasible(all, settings, 0.0, limit / all.null[i])) {
                    scale = {true, 0.0, std::numeric_limits<double>::infinity()};
                }
            }
        }
        return scale;
    }
    // The region is a polygon in (s, t). Its extremes in s lie at corners, where two strings are at
    // a limit, or on s = 0, below which the request would change its sign.
    for (std::size_t i = 0; i < kStringCount; ++i) {
        for (const double limit : limits) {
            if (all.null[i] != 0.0 && feasible(all, settings, 0.0, limit / all.null[i])) {
                include(0.0);
            }
            for (std::size_t j = 0; j < i; ++j) {
                const double determinant =
                    all.particular[i] * all.null[j] - all.particular[j] * all.null[i];
                for (const double other : limits) {
                    const double s = (limit * all.null[j] - other * all.null[i]) / determinant;
                    const double t =
                        (all.particular[i] * other - all.particular[j] * limit) / determinant;
                    if (std::isfinite(s) && std::isfinite(t) && s >= 0.0 &&
                        feasible(all, settings, s, t)) {
                        include(s);
                    }
                }
            }
        }
    }
    return scale;
}

} // namespace spidar
