// Wrench -> eight tensions that only pull, within limits:
//   min ||W (A tau - q)||^2 + ridge ||tau||^2 + reference_weight ||tau - tau_ref||^2
//       + change_weight ||tau - tau_last||^2          subject to tau_min <= tau <= tau_max.
// (research: moments and g weighted by 1/d, so that all rows are newtons at the pole ends.) The exact
// optimum by a primal active-set method, warm from the last tick's active set.
#pragma once

#include <cstdint>
#include <string>

#include "core/base/simd_level.h"
#include "core/base/sound_state.h"
#include "core/base/status.h"
#include "core/base/types.h"
#include "core/geometry/wrench_matrix.h"
#include "core/tension/exact/tension_problem.h"

namespace spidar {

// Exact optimum of `problem`, as solve_exactly() gives it: by the fast path where that can certify its answer.
// level: one that the processor supports.
[[nodiscard]] TensionSolution solve_tension_problem(const TensionProblem &problem,
                                                    const ActiveSet *warm,
                                                    SimdLevel level = best_simd_level()) noexcept;

inline constexpr std::uint8_t kAllDofs = 0x7F;
inline constexpr std::uint8_t kTranslationOnly = 0x07;
inline constexpr std::uint8_t kNoGrasp = 0x3F;

struct TensionSettings {
    double min_tension_n = 0.3;
    double max_tension_n = 10.0;
    double reference_tension_n = 0.5; // tau_ref, the pretension
    double weight_force = 1.0;
    double weight_moment_per_m = 25.0; // 1/d
    double weight_grasp_per_m = 25.0;  // 1/d, on the paper's g
    double ridge = 1e-9;               // uniqueness only
    double reference_weight = 1e-3;    // pull towards tau_ref
    double change_weight = 0.2;        // against jumps from tick to tick
    // Bit k: DOF k of the wrench counts (fx fy fz mx my mz g). What is left out weighs nothing: the strings give there
    // whatever suits the rest.
    std::uint8_t dof_mask = kAllDofs;
    std::uint8_t broken_mask = 0; // bit i: string i is broken, its tension is 0
    SimdLevel simd = best_simd_level();
};

struct TensionResult {
    StringArray tensions_n{};
    std::uint8_t at_min_mask = 0;
    std::uint8_t at_max_mask = 0;
    bool skipped =
        false; // nothing had changed and everything had settled: the last answer, bit for bit
    int iterations = 0;
    // wrench_limited: the wrench misses the request by more than the regularising terms explain. What each of
    // them costs: tension_report().
    Status status = Status::ok;
};

// The solver of the servo loop: settings and memory of the last tick. One solve a tick, no reports.
class TensionSolver {
public:
    TensionSolver() noexcept { prepare(); }

    // On a negative status the old settings stand.
    Status configure(const TensionSettings &settings) noexcept;
    [[nodiscard]] const TensionSettings &settings() const noexcept { return settings_; }

    // wrench: the paper's q. One that is not finite is taken as zero and flagged not_finite, so that no result holds NaN.
    TensionResult update(const WrenchMatrix &matrix, const PaperWrench &wrench) noexcept;
    // Tells the solver the tensions that were really sent, where a later stage (slew limit) changed them. The term that
    // weighs changes from tick to tick counts from these. Ignored when not finite.
    void set_last_tensions(const StringArray &tensions_n) noexcept;
    // The next update() solves even when nothing has changed. It changes no answer.
    void forget_settled() noexcept { settled_ = false; }
    // Forget the last tick: the next update() starts cold and has no change term.
    void reset() noexcept;
    // core/base/sound_state.h
    [[nodiscard]] bool is_sound() const noexcept {
        return are_flags(last_result_.skipped, warm_, has_last_, settled_) &&
               supports(settings_.simd) && spidar::is_sound(last_active_) &&
               spidar::is_sound(fast_.active);
    }

private:
    void prepare() noexcept;
    void aim() noexcept;
    void keep(const WrenchMatrix &matrix, const PaperWrench &wrench) noexcept;
    TensionResult update_carefully(const WrenchMatrix &matrix, const PaperWrench &wrench) noexcept;
    TensionResult remember(const TensionSolution &solution, const WrenchMatrix &matrix,
                           const PaperWrench &wrench) noexcept;

    TensionSettings settings_{};
    TensionProblem problem_{};      // matrix and wrench: of the last tick, when it settled
    StringArray steady_pull_{};     // proximal target without change term
    StringArray change_pull_{};     // share of last_tensions_n_ in it
    StringArray steady_target_n_{}; // with it, when the last tensions are not known
    StringArray last_tensions_n_{};
    ActiveSet last_active_{};
    TensionResult last_result_{};
    TensionSolution fast_{};           // scratch: not cleared for each solve
    std::uint8_t working_mask_ = 0xFF; // strings that are not broken
    bool warm_ = false;                // last_active_ is worth starting from
    bool has_last_ = false;            // last_tensions_n_ is known: the change term counts
    bool settled_ = false; // the last update left last_tensions_n_ and last_active_ as they were
};

[[nodiscard]] std::string validate(const TensionSettings &settings);
// Diagonal of W; 0 where the mask leaves a DOF out.
[[nodiscard]] PaperWeights tension_weights(const TensionSettings &settings) noexcept;

} // namespace spidar
