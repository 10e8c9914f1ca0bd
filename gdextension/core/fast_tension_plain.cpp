#include "core/fast_tension.h"

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "core/simd_four_plain.h"
#include "core/simd_level.h"

#include "core/fast_tension_kernel.h"
#include "core/translation_tension.h"

namespace spidar {

bool solve_fast_plain(const TensionProblem &problem, const ActiveSet *warm,
                      TensionSolution &solution) noexcept {
    if (is_translation_only(problem) &&
        TranslationTension<FourPlain>(problem).run(warm, solution)) {
        return true;
    }
    return FastTension<FourPlain>(problem).run(warm, solution);
}

bool solve_fast(const TensionProblem &problem, const ActiveSet *warm,
                TensionSolution &solution) noexcept {
#if defined(__x86_64__) && defined(__GNUC__)
    if (simd_level() == SimdLevel::avx512) {
        return solve_fast_avx512(problem, warm, solution);
    }
    if (simd_level() == SimdLevel::avx2) {
        return solve_fast_avx2(problem, warm, solution);
    }
#endif
    return solve_fast_plain(problem, warm, solution);
}

} // namespace spidar
