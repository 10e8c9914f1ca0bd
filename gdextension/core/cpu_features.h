// What this processor and its operating system offer. By the CPUID instruction itself: the compiler's own
// __builtin_cpu_supports needs a run-time library that not every toolchain brings.
#pragma once

#if defined(__x86_64__) && defined(__GNUC__)
#include <cpuid.h>
#endif

namespace spidar {

// AVX2 and FMA, and an operating system that saves their registers.
[[nodiscard]] inline bool cpu_has_avx2_and_fma() noexcept {
#if defined(__x86_64__) && defined(__GNUC__)
    unsigned a = 0;
    unsigned b = 0;
    unsigned c = 0;
    unsigned d = 0;
    if (__get_cpuid(1, &a, &b, &c, &d) == 0) {
        return false;
    }
    constexpr unsigned kFma = 1U << 12U;
    constexpr unsigned kXsaveInUse = 1U << 27U;
    constexpr unsigned kAvx = 1U << 28U;
    constexpr unsigned kNeeded = kFma | kXsaveInUse | kAvx;
    if ((c & kNeeded) != kNeeded) {
        return false;
    }
    unsigned low = 0;
    unsigned high = 0;
    __asm__("xgetbv"
            : "=a"(low), "=d"(high)
            : "c"(0U)); // register 0: what is saved at a thread switch
    constexpr unsigned kSseAndAvxSaved = 0x6U;
    if ((low & kSseAndAvxSaved) != kSseAndAvxSaved) {
        return false;
    }
    constexpr unsigned kAvx2 = 1U << 5U;
    return __get_cpuid_count(7, 0, &a, &b, &c, &d) != 0 && (b & kAvx2) != 0;
#else
    return false;
#endif
}

} // namespace spidar
