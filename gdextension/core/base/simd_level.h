// Which build of the vector kernels runs. All give the exact optimum; their last bits differ, so a recording stores
// the level it ran at and replay sets it.
#pragma once

#include <cstdint>

namespace spidar {

enum class SimdLevel : std::uint8_t {
    plain = 0, // 16-byte vectors: SSE2 on x86-64, NEON on arm64
    avx2 = 1,  // 32-byte vectors and fused multiply-add
};

// Can this processor, and this build, run that level?
[[nodiscard]] bool supports(SimdLevel level) noexcept;

// The level in use: the best one there is, until set_simd_level() says otherwise.
[[nodiscard]] SimdLevel simd_level() noexcept;

// For the whole process, from the next solve on. False, and nothing changes, when it is not supported.
bool set_simd_level(SimdLevel level) noexcept;

[[nodiscard]] const char *describe(SimdLevel level) noexcept;

} // namespace spidar
