// The fast path for AVX-512. Everything shared is included before the target changes: no inline function that another
// source may call is compiled for AVX-512 here.
#include "core/tension/fast/fast_tension.h"

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "core/tension/fast/fast_tension_limits.h"

#if defined(__x86_64__) && defined(__GNUC__)

#if !defined(__clang__)
// GCC 12 calls the "undefined" operands of its own intrinsics uninitialised (its bug 105593, mended in 13).
#pragma GCC diagnostic ignored "-Wuninitialized"
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#endif
#include <immintrin.h>

#if defined(__clang__)
#pragma clang attribute push(__attribute__((target("avx2,fma,avx512f,avx512dq,avx512vl"))),        \
                             apply_to = function)
#else
#pragma GCC target("avx2,fma,avx512f,avx512dq,avx512vl") // to the end of this file
#endif

#include "core/tension/fast/simd_eight_avx512.h"
#include "core/tension/fast/simd_four_avx2.h"

#include "core/tension/fast/fast_tension_wide.h"
#include "core/tension/fast/translation_tension.h"

namespace spidar {

bool solve_fast_avx512(const FastInput &input, const ActiveSet *warm,
                       TensionSolution &solution) noexcept {
    if (is_translation_only(input.problem) &&
        TranslationTension<FourAvx2>(input).run(warm, solution)) {
        return true;
    }
    if (input.problem.weights[6] == 0.0) {
        return WideTension<EightAvx512, kFastDofs - 1>(input).run(warm, solution);
    }
    return WideTension<EightAvx512, kFastDofs>(input).run(warm, solution);
}

} // namespace spidar

#if defined(__clang__)
#pragma clang attribute pop
#endif

#endif
