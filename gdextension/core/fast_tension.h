// The fast way to the optimum of a TensionProblem, which answers only what it can certify itself.
#pragma once

#include "core/tension_solver.h"

namespace spidar {

// True: `solution` is the optimum to rounding, its KKT conditions checked with a gradient taken from A itself, every
// sign beyond its rounding. False: `solution` means nothing; the exact search decides (bad input, degenerate or
// nearly singular problems).
[[nodiscard]] bool solve_fast(const TensionProblem &problem, const ActiveSet *warm,
                              TensionSolution &solution) noexcept;

// The builds of it that solve_fast() chooses from, by simd_level().
[[nodiscard]] bool solve_fast_plain(const TensionProblem &problem, const ActiveSet *warm,
                                    TensionSolution &solution) noexcept;
[[nodiscard]] bool solve_fast_avx2(const TensionProblem &problem, const ActiveSet *warm,
                                   TensionSolution &solution) noexcept;
[[nodiscard]] bool solve_fast_avx512(const TensionProblem &problem, const ActiveSet *warm,
                                     TensionSolution &solution) noexcept;

} // namespace spidar
