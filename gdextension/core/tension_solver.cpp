#include "core/tension_solver.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/box_least_squares.h"

namespace spidar {

namespace {

constexpr auto kStrings = static_cast<std::size_t>(kStringCount);
constexpr auto kDofs = static_cast<std::size_t>(kDofCount);

// Bounds, broken strings or a lost direction that change the weighted wrench by more than this are reported
// (unit: N at the pole ends; a tenth of what a fingertip can tell).
constexpr double kWrenchLimited_n = 1e-3;

// Weight that stands for "no regularising terms" when their cost is measured: small enough to cost nothing,
// large enough to leave the least-squares answer unique.
constexpr double kVanishingWeight = 1e-12;

// Share of the regularised error that one more step from there may leave when every DOF can be reached. (The
// steps shrink it by w / (w + s^2), s the singular value of W A; 2.5e-5 at rest.)
constexpr double kUnreachableShare = 0.05;

// Above this a setting is a slip of units, and squares of it lose the digits of the rest.
constexpr double kLargestSetting = 1e6;

// A bound that no string ever meets.
constexpr double kNoBound_n = 1e9;

bool finite(const DofArray &values) noexcept {
    return std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
}

bool finite(const WrenchMatrix &matrix) noexcept {
    return std::all_of(matrix.columns.begin(), matrix.columns.end(),
                       [](const DofArray &column) { return finite(column); });
}

DofArray wrench_error(const TensionProblem &problem, const StringArray &tensions_n) noexcept {
    DofArray error = spidar::apply(problem.matrix, tensions_n);
    for (std::size_t k = 0; k < kDofs; ++k) {
        error[k] -= problem.wrench[k];
    }
    return error;
}

double largest_weighted(const TensionProblem &problem, const DofArray &error) noexcept {
    double largest = 0.0;
    for (std::size_t k = 0; k < kDofs; ++k) {
        largest = std::max(largest, std::abs(problem.weights[k] * error[k]));
    }
    return largest;
}

DofArray difference(const DofArray &a, const DofArray &b) noexcept {
    DofArray result{};
    for (std::size_t k = 0; k < kDofs; ++k) {
        result[k] = a[k] - b[k];
    }
    return result;
}

// The optimum of the problem without its bounds; strings outside `free` stay at 0.
StringArray unbounded_optimum(const TensionProblem &problem, StringMask free) noexcept {
    TensionProblem open = problem;
    for (std::size_t i = 0; i < kStrings; ++i) {
        const double reach = has_string(free, i) ? kNoBound_n : 0.0;
        open.lower_n[i] = -reach;
        open.upper_n[i] = reach;
    }
    return solve_tension_problem(open, nullptr).tensions_n;
}

struct SteadyCost {
    DofArray bias{};        // what the regularising terms cost
    DofArray unreachable{}; // what no tension, of either sign, can give
};

// `problem` holds the steady terms only (ridge and reference).
SteadyCost steady_cost(const TensionProblem &problem, StringMask free) noexcept {
    const StringArray tensions = unbounded_optimum(problem, free);
    SteadyCost cost;
    cost.bias = wrench_error(problem, tensions);
    const double size = largest_weighted(problem, cost.bias);
    // One more step, the target moved to where the tensions are.
    TensionProblem moved = problem;
    moved.proximal_target_n = tensions;
    const double left =
        largest_weighted(problem, wrench_error(problem, unbounded_optimum(moved, free)));
    if (left > kUnreachableShare * size) {
        TensionProblem bare = problem;
        bare.proximal_weight = kVanishingWeight;
        cost.unreachable = wrench_error(bare, unbounded_optimum(bare, free));
        cost.bias = difference(cost.bias, cost.unreachable);
    }
    return cost;
}

// The first setting that is out of range; field null when none is.
struct Fault {
    const char *field = nullptr;
    double value = 0.0;
    const char *unit = "";
    const char *remedy = "";
};

Fault find_fault(const TensionSettings &s) noexcept {
    struct NamedValue {
        const char *field;
        double value;
        const char *unit;
    };
    const NamedValue values[] = {{"min_tension_n", s.min_tension_n, "N"},
                                 {"max_tension_n", s.max_tension_n, "N"},
                                 {"reference_tension_n", s.reference_tension_n, "N"},
                                 {"weight_force", s.weight_force, ""},
                                 {"weight_moment_per_m", s.weight_moment_per_m, "1/m"},
                                 {"weight_grasp_per_m", s.weight_grasp_per_m, "1/m"},
                                 {"ridge", s.ridge, ""},
                                 {"reference_weight", s.reference_weight, ""},
                                 {"change_weight", s.change_weight, ""}};
    for (const NamedValue &v : values) {
        if (!std::isfinite(v.value)) {
            return {v.field, v.value, v.unit, "give a finite number"};
        }
        if (!(v.value >= 0.0)) {
            return {v.field, v.value, v.unit, "give 0 or more"};
        }
        if (!(v.value <= kLargestSetting)) {
            return {v.field, v.value, v.unit, "give 1e6 or less"};
        }
    }
    if (!(s.max_tension_n > s.min_tension_n)) {
        return {"max_tension_n", s.max_tension_n, "N", "raise it above min_tension_n"};
    }
    if (!(s.reference_tension_n >= s.min_tension_n && s.reference_tension_n <= s.max_tension_n)) {
        return {"reference_tension_n", s.reference_tension_n, "N",
                "put it between min_tension_n and max_tension_n"};
    }
    if ((s.dof_mask & kAllDofs) == 0 || s.dof_mask > kAllDofs) {
        return {"dof_mask", static_cast<double>(s.dof_mask), "",
                "give 1 to 127, bit k for DOF k of the wrench (127 is all)"};
    }
    if (!(s.weight_force > 0.0)) {
        return {"weight_force", s.weight_force, "", "give more than 0 (1 is usual)"};
    }
    if (!(s.ridge + s.reference_weight >= kVanishingWeight)) {
        return {"ridge", s.ridge, "",
                "give 1e-12 or more (1e-9 is usual): it makes the answer unique"};
    }
    return {};
}

} // namespace

Status TensionSolver::configure(const TensionSettings &settings) noexcept {
    if (find_fault(settings).field != nullptr) {
        return Status::invalid_settings;
    }
    settings_ = settings;
    return Status::ok;
}

TensionResult TensionSolver::update(const WrenchMatrix &matrix, const DofArray &wrench) noexcept {
    const TensionSettings &s = settings_;
    const bool wrench_is_finite = finite(wrench);
    const auto free = static_cast<StringMask>(~static_cast<unsigned>(s.broken_mask));

    TensionProblem problem;
    problem.matrix = matrix;
    problem.wrench = wrench_is_finite ? wrench : DofArray{};
    problem.weights = {s.weight_force,        s.weight_force,        s.weight_force,
                       s.weight_moment_per_m, s.weight_moment_per_m, s.weight_moment_per_m,
                       s.weight_grasp_per_m};
    for (std::size_t k = 0; k < kDofs; ++k) {
        if (((static_cast<unsigned>(s.dof_mask) >> k) & 1U) == 0U) {
            problem.weights[k] = 0.0;
        }
    }
    const double steady_weight = s.ridge + s.reference_weight;
    const double steady_target = s.reference_weight * s.reference_tension_n / steady_weight;
    const double change_weight = has_last_ ? s.change_weight : 0.0;
    for (std::size_t i = 0; i < kStrings; ++i) {
        const bool is_free = has_string(free, i);
        problem.proximal_target_n[i] = is_free ? steady_target : 0.0;
        problem.lower_n[i] = is_free ? s.min_tension_n : 0.0;
        problem.upper_n[i] = is_free ? s.max_tension_n : 0.0;
    }
    problem.proximal_weight = steady_weight;

    TensionResult result;
    if (!finite(matrix)) {
        result.tensions_n = problem.lower_n; // the strings stay taut; memory stands
        result.status = Status::not_finite;
        return result;
    }
    const SteadyCost cost = steady_cost(problem, free);
    result.bias = cost.bias;

    problem.proximal_weight = steady_weight + change_weight;
    for (std::size_t i = 0; i < kStrings; ++i) {
        if (has_string(free, i)) {
            problem.proximal_target_n[i] =
                (steady_weight * steady_target + change_weight * last_tensions_n_[i]) /
                problem.proximal_weight;
        }
    }
    const TensionSolution solution =
        solve_tension_problem(problem, warm_ ? &last_active_ : nullptr);
    result.tensions_n = solution.tensions_n;
    result.iterations = solution.iterations;
    result.status = solution.status;
    result.achieved = spidar::apply(matrix, result.tensions_n);
    result.error = wrench_error(problem, result.tensions_n);
    for (std::size_t i = 0; i < kStrings; ++i) {
        if (!has_string(free, i)) {
            continue;
        }
        if (solution.active[i] == StringBound::at_lower) {
            result.at_min_mask = with_string(result.at_min_mask, i);
        } else if (solution.active[i] == StringBound::at_upper) {
            result.at_max_mask = with_string(result.at_max_mask, i);
        }
    }
    if (!usable(solution.status)) {
        return result;
    }
    last_tensions_n_ = result.tensions_n;
    last_active_ = solution.active;
    warm_ = true;
    has_last_ = true;

    bool limited = largest_weighted(problem, cost.unreachable) > kWrenchLimited_n;
    if ((result.at_min_mask | result.at_max_mask) != 0) {
        const DofArray unbounded = wrench_error(problem, unbounded_optimum(problem, free));
        limited = limited ||
                  largest_weighted(problem, difference(result.error, unbounded)) > kWrenchLimited_n;
    }
    if (limited) {
        result.status = Status::wrench_limited;
    }
    if (!wrench_is_finite) {
        result.status = Status::not_finite;
    }
    return result;
}

void TensionSolver::set_last_tensions(const StringArray &tensions_n) noexcept {
    if (std::all_of(tensions_n.begin(), tensions_n.end(),
                    [](double t) { return std::isfinite(t); })) {
        last_tensions_n_ = tensions_n;
        has_last_ = true;
    }
}

void TensionSolver::reset() noexcept {
    last_tensions_n_ = {};
    last_active_ = {};
    warm_ = false;
    has_last_ = false;
}

std::string validate(const TensionSettings &settings) {
    const Fault fault = find_fault(settings);
    if (fault.field == nullptr) {
        return {};
    }
    char text[256];
    std::snprintf(text, sizeof text, "%s is %g%s%s: %s.", fault.field, fault.value,
                  *fault.unit == '\0' ? "" : " ", fault.unit, fault.remedy);
    return text;
}

} // namespace spidar
