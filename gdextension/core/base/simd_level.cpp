#include "core/base/simd_level.h"

#include <atomic>

namespace spidar {

namespace {

SimdLevel best_level() noexcept {
    return supports(SimdLevel::avx512) ? SimdLevel::avx512
           : supports(SimdLevel::avx2) ? SimdLevel::avx2
                                       : SimdLevel::plain;
}

std::atomic<SimdLevel> &current_level() noexcept {
    static std::atomic<SimdLevel> level{best_level()};
    return level;
}

// Found when the program starts: no step of the servo loop pays for the first look.
[[maybe_unused]] const SimdLevel kLevelAtStart = simd_level();

} // namespace

bool supports(SimdLevel level) noexcept {
    if (level == SimdLevel::plain) {
        return true;
    }
#if defined(__x86_64__) && defined(__GNUC__)
    const bool avx2 = __builtin_cpu_supports("avx2") > 0 && __builtin_cpu_supports("fma") > 0;
    if (level == SimdLevel::avx512) {
        return avx2 && __builtin_cpu_supports("avx512f") > 0 &&
               __builtin_cpu_supports("avx512dq") > 0 && __builtin_cpu_supports("avx512vl") > 0;
    }
    return level == SimdLevel::avx2 && avx2;
#else
    return false;
#endif
}

SimdLevel simd_level() noexcept {
    return current_level().load(std::memory_order_relaxed);
}

bool set_simd_level(SimdLevel level) noexcept {
    if (!supports(level)) {
        return false;
    }
    current_level().store(level, std::memory_order_relaxed);
    return true;
}

const char *describe(SimdLevel level) noexcept {
    switch (level) {
    case SimdLevel::avx2:
        return "AVX2 and FMA";
    case SimdLevel::avx512:
        return "AVX-512";
    case SimdLevel::plain:
        break;
    }
    return "plain 16-byte vectors";
}

} // namespace spidar
