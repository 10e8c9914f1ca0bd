// Which build of core and device this is. Two programs of one identity compute the same bits and hold the servo
// step's memory in the same way, so that one can replay what the other recorded.
#pragma once

#include <cstdint>

namespace spidar {

// From the sources of core and device, and the compiler.
[[nodiscard]] std::uint64_t build_identity() noexcept;

// The version of spidar_g.
[[nodiscard]] const char *build_version() noexcept;

} // namespace spidar
