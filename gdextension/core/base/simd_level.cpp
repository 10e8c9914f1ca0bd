#include "core/base/simd_level.h"

namespace spidar {

bool supports(SimdLevel level) noexcept {
    if (level == SimdLevel::plain) {
        return true;
    }
#if defined(__x86_64__) && defined(__GNUC__)
    return level == SimdLevel::avx2 && __builtin_cpu_supports("avx2") > 0 &&
           __builtin_cpu_supports("fma") > 0;
#else
    return false;
#endif
}

SimdLevel best_simd_level() noexcept {
    return supports(SimdLevel::avx2) ? SimdLevel::avx2 : SimdLevel::plain;
}

const char *describe(SimdLevel level) noexcept {
    switch (level) {
    case SimdLevel::plain:
        return "plain 16-byte vectors";
    case SimdLevel::avx2:
        return "AVX2 and FMA";
    }
    return "unknown vectors"; // a recording may name any number
}

} // namespace spidar
