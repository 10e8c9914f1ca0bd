// The kernel of the fast solver compiled for AVX2 and FMA. Shared headers are included before the
// target changes, so that no inline function of other sources is compiled for AVX2 here.
#include "core/tension/fast/fast_tension.h"

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "core/tension/fast/fast_tension_limits.h"

#if defined(__x86_64__) && defined(__GNUC__)

#include <immintrin.h>

#if defined(__clang__)
#pragma clang attribute push(__attribute__((target("avx2,fma"))), apply_to = function)
#else
#pragma GCC target("avx2,fma") // to the end of this file: templates are compiled there
#endif

#include "core/tension/fast/simd_four_avx2.h"

#include "core/tension/fast/fast_tension_kernel.h"
#include "core/tension/fast/translation_tension.h"

namespace spidar {

bool solve_fast_avx2(const FastInput &input, const ActiveSet *warm,
                     TensionSolution &solution) noexcept {
    if (is_translation_only(input.problem) &&
        TranslationTension<FourAvx2>(input).run(warm, solution)) {
        return true;
    }
    return FastTension<FourAvx2>(input).run(warm, solution);
}

} // namespace spidar

#if defined(__clang__)
#pragma clang attribute pop
#endif

#endif
