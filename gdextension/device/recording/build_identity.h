// Identity of this build of core and device. Two programs with one identity compute equal bits and
// have the same memory layout of the servo step, so that one can replay the recordings of the
// other.
#pragma once

#include <cstdint>

namespace spidar {

// Returns a hash of the sources of core and device and of the compiler.
[[nodiscard]] std::uint64_t build_identity() noexcept;

// Returns the version of spidar_g.
[[nodiscard]] const char *build_version() noexcept;

} // namespace spidar
