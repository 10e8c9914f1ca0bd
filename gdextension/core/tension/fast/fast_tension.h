// The fast solver of a TensionProblem. It answers only when it can certify its own answer.
#pragma once

#include "core/base/simd_level.h"
#include "core/tension/exact/tension_problem.h"

namespace spidar {

// Input of the fast solver. Matrix and wrench are read at their original place: vector loads from a
// copy that was just written in narrower pieces would stall.
struct FastInput {
    const TensionProblem &problem; // all members but matrix and wrench
    const WrenchMatrix &matrix;
    const PaperWrench &wrench;

    // Uses all of `problem`, including its matrix and wrench.
    static FastInput of(const TensionProblem &problem) noexcept {
        return {problem, problem.matrix, problem.wrench};
    }
};

// Returns true when `solution` is the optimum up to rounding. The solver has then checked its own
// answer with the matrix A itself (see FastTension and TranslationTension). Returns false for bad
// input and for degenerate or nearly singular problems: `solution` is then undefined and the exact
// solver must decide. level: one that the processor supports.
[[nodiscard]] bool solve_fast(const FastInput &input, const ActiveSet *warm, SimdLevel level,
                              TensionSolution &solution) noexcept;

// The build of solve_fast() for SimdLevel::plain.
[[nodiscard]] bool solve_fast_plain(const FastInput &input, const ActiveSet *warm,
                                    TensionSolution &solution) noexcept;
// The build of solve_fast() for SimdLevel::avx2.
[[nodiscard]] bool solve_fast_avx2(const FastInput &input, const ActiveSet *warm,
                                   TensionSolution &solution) noexcept;

} // namespace spidar
