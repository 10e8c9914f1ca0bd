// Tension distribution: eight tensions that only pull, within limits, for a requested wrench q:
//   min ||W (A tau - q)||^2 + ridge ||tau||^2 + reference_weight ||tau - tau_ref||^2
//       + change_weight ||tau - tau_last||^2          subject to tau_min <= tau <= tau_max.
// The default W multiplies moments and g by 1/d (paper: 25 1/m), so that all rows are newtons at
// the pole ends.
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

// Returns the exact optimum of `problem`, as solve_exactly() does, by the fast solver where it can
// certify its answer. warm (may be null): a guess of the active set. level: one that the processor
// supports.
[[nodiscard]] TensionSolution solve_tension_problem(const TensionProblem &problem,
                                                    const ActiveSet *warm,
                                                    SimdLevel level = best_simd_level()) noexcept;

// DOF masks: bit k stands for DOF k of fx fy fz mx my mz g.
inline constexpr std::uint8_t kAllDofs = 0x7F;
inline constexpr std::uint8_t kTranslationOnly = 0x07;
inline constexpr std::uint8_t kNoGrasp = 0x3F;

struct TensionSettings {
    double min_tension_n = 0.3;
    double max_tension_n = 10.0;
    // tau_ref, the pretension (unit: N).
    double reference_tension_n = 0.5;
    double weight_force = 1.0;
    double weight_moment_per_m = 25.0; // 1/d
    double weight_grasp_per_m = 25.0;  // 1/d, on the paper's g
    double ridge = 1e-9;               // makes the optimum unique
    double reference_weight = 1e-3;    // weight of the distance from tau_ref
    double change_weight = 0.2;        // weight of the change since the last tick
    // If bit k is set, the tensions follow DOF k of the wrench (order: fx fy fz mx my mz g). A DOF
    // whose bit is 0 has weight 0: the solver gives it any value that reduces the error in the
    // others.
    std::uint8_t dof_mask = kAllDofs;
    std::uint8_t broken_mask = 0; // bit i: string i is broken and gets tension 0
    SimdLevel simd = best_simd_level();
};

struct TensionResult {
    StringArray tensions_n{};
    // Strings at their lower bound (bit i: string i).
    std::uint8_t at_min_mask = 0;
    // Strings at their upper bound.
    std::uint8_t at_max_mask = 0;
    // True when the input was that of the last tick and the tensions had stopped changing: the
    // tensions of the last tick are returned, bit for bit.
    bool skipped = false;
    int iterations = 0;
    // wrench_limited: the error exceeds what the regularizing terms explain (tension_report()).
    Status status = Status::ok;
};

// Solver of the servo loop with its settings and the memory of the last tick; one solve per tick.
class TensionSolver {
public:
    TensionSolver() noexcept { prepare(); }

    // On a negative status the old settings stay.
    Status configure(const TensionSettings &settings) noexcept;
    [[nodiscard]] const TensionSettings &settings() const noexcept { return settings_; }

    // Takes one tick. wrench: the paper's q. A wrench that is not finite is replaced by zero, with
    // status not_finite. A matrix that is not finite gives the minimum tensions and not_finite.
    TensionResult update(const WrenchMatrix &matrix, const PaperWrench &wrench) noexcept;
    // Sets the tensions that were sent, if a later stage such as the slew limit changed them. The
    // change term of the next tick refers to them. Tensions that are not finite are ignored.
    void set_last_tensions(const StringArray &tensions_n) noexcept;
    // Makes the next update() solve even when nothing has changed. The result is the same.
    void forget_settled() noexcept { settled_ = false; }
    // Forgets the last tick: the next update() starts cold and has no change term.
    void reset() noexcept;
    // Checks restored memory: see core/base/sound_state.h.
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
    // Matrix and wrench are those of the last tick when it settled.
    TensionProblem problem_{};
    StringArray steady_pull_{}; // share of tau_ref in the target of the next tick
    StringArray change_pull_{}; // share of last_tensions_n_ in that target
    // Proximal target when the last tensions are unknown.
    StringArray steady_target_n_{};
    StringArray last_tensions_n_{};
    ActiveSet last_active_{};
    TensionResult last_result_{};
    TensionSolution fast_{};           // scratch memory, not cleared for each solve
    std::uint8_t working_mask_ = 0xFF; // strings that are not broken
    // True if last_active_ can start the next solve.
    bool warm_ = false;
    // True if last_tensions_n_ is known, so that the change term applies.
    bool has_last_ = false;
    // True if the last update left last_tensions_n_ and last_active_ unchanged.
    bool settled_ = false;
};

// Returns an empty string when usable, else one sentence with field, value, unit and remedy.
[[nodiscard]] std::string validate(const TensionSettings &settings);
// Returns the diagonal of W, with 0 for DOF outside the mask.
[[nodiscard]] PaperWeights tension_weights(const TensionSettings &settings) noexcept;

} // namespace spidar
