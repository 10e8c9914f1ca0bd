#include "core/tension/fast/fast_tension.h"

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "core/tension/fast/simd_four_plain.h"

#include "core/tension/fast/fast_tension_kernel.h"
#include "core/tension/fast/translation_tension.h"

namespace spidar {

bool solve_fast_plain(const FastInput &input, const ActiveSet *warm,
                      TensionSolution &solution) noexcept {
    if (is_translation_only(input.problem) &&
        TranslationTension<FourPlain>(input).run(warm, solution)) {
        return true;
    }
    return FastTension<FourPlain>(input).run(warm, solution);
}

bool solve_fast(const FastInput &input, const ActiveSet *warm, [[maybe_unused]] SimdLevel level,
                TensionSolution &solution) noexcept {
#if defined(__x86_64__) && defined(__GNUC__)
    if (level == SimdLevel::avx2) {
        return solve_fast_avx2(input, warm, solution);
    }
#endif
    return solve_fast_plain(input, warm, solution);
}

} // namespace spidar
