#include "core/tension/tension_solver.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "core/base/describe_value.h"
#include "core/base/finite.h"
#include "core/tension/fast/fast_tension.h"

namespace spidar {

namespace {

// Largest weighted error that is not reported, beyond what the regularizing terms explain (unit: N
// at the pole ends): a tenth of what a fingertip can feel.
constexpr double kWrenchLimited_n = 1e-3;
// Error that a regularizing term explains, per weight and distance from its target: R'f = -w (x -
// t) where no bound holds, so that |f| <= sqrt(8) w |x - t| / s. The smallest singular value s of R
// = W A is 0.7 or more within 20 cm of the center.
constexpr double kTermReach = 4.0;

// Smallest sum of ridge and reference weight: below it the answer is not unique in double
// precision.
constexpr double kVanishingWeight = 1e-12;

// Largest change of a tension that counts as none. The solver rounds to 1e-14 N. The change term
// moves tensions by a 200th of their distance per tick, so that they stop 2e-10 N from their
// target.
constexpr double kSettled_n = 1e-12;

// Largest setting: a larger one is a unit error, and its square would lose the digits of the
// others.
constexpr double kLargestSetting = 1e6;

template <class T>
bool same_bits(const T &a, const T &b) noexcept {
    // Compares bits, so that -0 and NaN count too.
    // NOLINTNEXTLINE(bugprone-suspicious-memory-comparison)
    return std::memcmp(&a, &b, sizeof(T)) == 0;
}

// Returns the largest |a - b|. Four chains run in parallel; a single one would wait for itself
// eight times.
double largest_distance(const StringArray &a, const StringArray &b) noexcept {
    std::array<double, 4> largest{};
    for (std::size_t i = 0; i < largest.size(); ++i) {
        largest[i] = std::max(std::abs(a[i] - b[i]), std::abs(a[i + 4] - b[i + 4]));
    }
    return std::max(std::max(largest[0], largest[1]), std::max(largest[2], largest[3]));
}

// The first setting that is out of range; `field` is null when there is none.
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
        if (!(v.value >= 0.0 && v.value <= kLargestSetting)) {
            return {v.field, v.value, v.unit, "give 0 to 1e6."};
        }
    }
    if (!(s.max_tension_n > s.min_tension_n)) {
        return {"max_tension_n", s.max_tension_n, "N", "raise it above min_tension_n."};
    }
    if (!(s.reference_tension_n >= s.min_tension_n && s.reference_tension_n <= s.max_tension_n)) {
        return {"reference_tension_n", s.reference_tension_n, "N",
                "set it between min_tension_n and max_tension_n."};
    }
    if ((s.dof_mask & kAllDofs) == 0 || s.dof_mask > kAllDofs) {
        return {"dof_mask", static_cast<double>(s.dof_mask), "",
                "give 1 to 127, bit k for DOF k of the wrench (127 is all)."};
    }
    if (!(s.weight_force > 0.0)) {
        return {"weight_force", s.weight_force, "", "give more than 0 (1 is usual)."};
    }
    if (!(s.ridge + s.reference_weight >= kVanishingWeight)) {
        return {"ridge", s.ridge, "",
                "give 1e-12 or more (1e-9 is usual): it makes the answer unique."};
    }
    if (!supports(s.simd)) {
        return {"simd", static_cast<double>(s.simd), "",
                "give a level that this processor supports (0 is supported by all)."};
    }
    return {};
}

} // namespace

TensionSolution solve_tension_problem(const TensionProblem &problem, const ActiveSet *warm,
                                      SimdLevel level) noexcept {
    TensionSolution solution; // the one that is returned: no copy
    if (!solve_fast(FastInput::of(problem), warm, level, solution)) {
        solution = solve_exactly(problem, warm);
    }
    return solution;
}

Status TensionSolver::configure(const TensionSettings &settings) noexcept {
    if (find_fault(settings).field != nullptr) {
        return Status::invalid_settings;
    }
    settings_ = settings;
    prepare();
    return Status::ok;
}

void TensionSolver::prepare() noexcept {
    const TensionSettings &s = settings_;
    problem_.weights = tension_weights(s);
    working_mask_ = static_cast<std::uint8_t>(~static_cast<unsigned>(s.broken_mask));
    const double steady_weight = s.ridge + s.reference_weight;
    const double whole_weight = steady_weight + s.change_weight;
    for (std::size_t i = 0; i < kStringCount; ++i) {
        const bool works = has_string(working_mask_, i);
        const double pull = works ? s.reference_weight * s.reference_tension_n : 0.0;
        problem_.lower_n[i] = works ? s.min_tension_n : 0.0;
        problem_.upper_n[i] = works ? s.max_tension_n : 0.0;
        steady_target_n_[i] = pull / steady_weight;
        steady_pull_[i] = pull / whole_weight;
        change_pull_[i] = works ? s.change_weight / whole_weight : 0.0;
    }
    settled_ = false;
    aim();
}

// Sets the proximal term of the next tick, as soon as this tick's tensions are known.
void TensionSolver::aim() noexcept {
    problem_.proximal_weight = settings_.ridge + settings_.reference_weight;
    problem_.proximal_target_n = steady_target_n_;
    if (has_last_) {
        problem_.proximal_weight += settings_.change_weight;
        for (std::size_t i = 0; i < kStringCount; ++i) {
            problem_.proximal_target_n[i] = steady_pull_[i] + change_pull_[i] * last_tensions_n_[i];
        }
    }
}

TensionResult TensionSolver::update(const WrenchMatrix &matrix,
                                    const PaperWrench &wrench) noexcept {
    if (settled_ && same_bits(wrench, problem_.wrench) &&
        same_bits(matrix.columns, problem_.matrix.columns)) {
        last_result_.skipped = true;
        return last_result_;
    }
    // The fast solver certifies its answer, and so refuses input that is not finite.
    if (solve_fast({problem_, matrix, wrench}, warm_ ? &last_active_ : nullptr, settings_.simd,
                   fast_)) {
        return remember(fast_, matrix, wrench);
    }
    return update_carefully(matrix, wrench);
}

void TensionSolver::keep(const WrenchMatrix &matrix, const PaperWrench &wrench) noexcept {
    problem_.matrix = matrix;
    problem_.wrench = wrench;
}

// Solves what the fast solver refused.
TensionResult TensionSolver::update_carefully(const WrenchMatrix &matrix,
                                              const PaperWrench &wrench) noexcept {
    TensionResult result;
    settled_ = false;
    if (!all_finite(matrix.columns)) {
        result.tensions_n = problem_.lower_n; // the strings stay taut; the memory is unchanged
        result.status = Status::not_finite;
        return result;
    }
    if (!all_finite(wrench)) {
        result = update(matrix, PaperWrench{});
        result.status = Status::not_finite;
        settled_ = false;
        return result;
    }
    keep(matrix, wrench);
    const TensionSolution solution = solve_exactly(problem_, warm_ ? &last_active_ : nullptr);
    if (!usable(solution.status)) {
        result.tensions_n = solution.tensions_n;
        result.iterations = solution.iterations;
        result.status = solution.status;
        return result;
    }
    return remember(solution, matrix, wrench);
}

TensionResult TensionSolver::remember(const TensionSolution &solution, const WrenchMatrix &matrix,
                                      const PaperWrench &wrench) noexcept {
    TensionResult result;
    result.iterations = solution.iterations;
    result.at_min_mask = strings_at(solution.active, StringBound::at_lower) & working_mask_;
    result.at_max_mask = strings_at(solution.active, StringBound::at_upper) & working_mask_;
    result.tensions_n = solution.tensions_n;
    bool near_last = has_last_;
    for (std::size_t i = 0; near_last && i < kStringCount; ++i) {
        near_last = std::abs(solution.tensions_n[i] - last_tensions_n_[i]) <= kSettled_n &&
                    last_tensions_n_[i] >= problem_.lower_n[i] &&
                    last_tensions_n_[i] <= problem_.upper_n[i];
    }
    if (near_last) {
        for (std::size_t i = 0; i < kStringCount; ++i) {
            if (solution.active[i] == StringBound::free) {
                result.tensions_n[i] = last_tensions_n_[i];
            }
        }
    }
    settled_ = near_last && same_bits(result.tensions_n, last_tensions_n_) &&
               same_bits(solution.active, last_active_);

    if (solution.largest_error_n > kWrenchLimited_n) {
        const double furthest_n = largest_distance(result.tensions_n, problem_.proximal_target_n);
        if (solution.largest_error_n >
            kWrenchLimited_n + kTermReach * problem_.proximal_weight * furthest_n) {
            result.status = Status::wrench_limited;
        }
    }
    last_tensions_n_ = result.tensions_n;
    last_active_ = solution.active;
    if (settled_) { // the result and input that a skipped tick needs
        last_result_ = result;
        keep(matrix, wrench);
    }
    warm_ = true;
    has_last_ = true;
    aim();
    return result;
}

void TensionSolver::set_last_tensions(const StringArray &tensions_n) noexcept {
    if (all_finite(tensions_n)) {
        settled_ = settled_ && same_bits(tensions_n, last_tensions_n_);
        last_tensions_n_ = tensions_n;
        has_last_ = true;
        aim();
    }
}

void TensionSolver::reset() noexcept {
    last_tensions_n_ = {};
    last_active_ = {};
    warm_ = false;
    has_last_ = false;
    settled_ = false;
    aim();
}

PaperWeights tension_weights(const TensionSettings &settings) noexcept {
    PaperWeights weights = {settings.weight_force,        settings.weight_force,
                            settings.weight_force,        settings.weight_moment_per_m,
                            settings.weight_moment_per_m, settings.weight_moment_per_m,
                            settings.weight_grasp_per_m};
    for (std::size_t k = 0; k < kDofCount; ++k) {
        if (((static_cast<unsigned>(settings.dof_mask) >> k) & 1U) == 0U) {
            weights[k] = 0.0;
        }
    }
    return weights;
}

std::string validate(const TensionSettings &settings) {
    const Fault fault = find_fault(settings);
    return fault.field == nullptr
               ? std::string()
               : range_sentence(fault.field, fault.value, fault.unit, fault.remedy);
}

} // namespace spidar
