// The fast way to the optimum of a TensionProblem, which answers only what it can certify itself.
#pragma once

#include "core/base/simd_level.h"
#include "core/tension/exact/tension_problem.h"

namespace spidar {

// Matrix and wrench are read where they lie, not from `problem`: a copy made a moment ago, in narrower pieces than the
// vectors that read it, would stall every load.
struct FastInput {
    const TensionProblem &problem; // all but those two
    const WrenchMatrix &matrix;
    const PaperWrench &wrench;

    // All of `problem`, its own matrix and wrench included.
    static FastInput of(const TensionProblem &problem) noexcept {
        return {problem, problem.matrix, problem.wrench};
    }
};

// True: `solution` is the optimum to rounding, its KKT conditions checked with a gradient taken from A itself, every
// sign beyond its rounding. False: `solution` means nothing; the exact search decides (bad input, degenerate or
// nearly singular problems). level: one that the processor supports.
[[nodiscard]] bool solve_fast(const FastInput &input, const ActiveSet *warm, SimdLevel level,
                              TensionSolution &solution) noexcept;

// The builds of it that solve_fast() chooses from.
[[nodiscard]] bool solve_fast_plain(const FastInput &input, const ActiveSet *warm,
                                    TensionSolution &solution) noexcept;
[[nodiscard]] bool solve_fast_avx2(const FastInput &input, const ActiveSet *warm,
                                   TensionSolution &solution) noexcept;

} // namespace spidar
