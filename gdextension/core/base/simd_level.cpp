#include "core/base/simd_level.h"

#include <atomic>

namespace spidar {

namespace {

SimdLevel best_level() noexcept {
    return supports(SimdLevel::avx2) ? SimdLevel::avx2 : SimdLevel::plain;
}

// Set before main() and known without a look at whether it is: a solve reads it.
constinit std::atomic<SimdLevel> current_level{SimdLevel::plain};
[[maybe_unused]] const bool kBestAtStart = set_simd_level(best_level());

} // namespace

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

SimdLevel simd_level() noexcept {
    return current_level.load(std::memory_order_relaxed);
}

bool set_simd_level(SimdLevel level) noexcept {
    if (!supports(level)) {
        return false;
    }
    current_level.store(level, std::memory_order_relaxed);
    return true;
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
