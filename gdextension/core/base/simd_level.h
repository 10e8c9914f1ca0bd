// Which build of the vector kernels a solver runs. All builds find the same optimum, but the last
// bits of their results differ. The level is therefore a setting of each solver, and a recording
// stores it.
#pragma once

#include <cstdint>

namespace spidar {

enum class SimdLevel : std::uint8_t {
    plain = 0, // 16-byte vectors: SSE2 on x86-64, NEON on arm64
    avx2 = 1,  // 32-byte vectors and fused multiply-add
};

// True when this processor and this build can run the level.
[[nodiscard]] bool supports(SimdLevel level) noexcept;

// Returns the fastest supported level. Queries the processor: not for a servo loop.
[[nodiscard]] SimdLevel best_simd_level() noexcept;

[[nodiscard]] const char *describe(SimdLevel level) noexcept;

} // namespace spidar
