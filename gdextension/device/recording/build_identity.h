// Identity of this build of core and device. Two programs with one identity are taken to compute
// equal bits and to lay out the servo step's memory alike, so that one can replay the recordings of
// the other. The kind of processor and the compiler's options are not part of the identity.
#pragma once

#include <cstdint>

namespace spidar {

// Returns a hash of the sources of core and device and of the compiler's version.
[[nodiscard]] std::uint64_t build_identity() noexcept;

// Returns the version of spidar_g.
[[nodiscard]] const char *build_version() noexcept;

} // namespace spidar
