#include "core/simd_level.h"

#include <atomic>

#include "core/cpu_features.h"

namespace spidar {

namespace {

SimdLevel best_level() noexcept {
    return supports(SimdLevel::avx2) ? SimdLevel::avx2 : SimdLevel::plain;
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
    return level == SimdLevel::avx2 && cpu_has_avx2_and_fma();
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
    return level == SimdLevel::avx2 ? "AVX2 and FMA" : "plain 16-byte vectors";
}

} // namespace spidar
