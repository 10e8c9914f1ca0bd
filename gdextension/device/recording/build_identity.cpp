#include "device/recording/build_identity.h"

#include <string_view>

#include "spidar_sources.h"
#include "spidar_version.h"

namespace spidar {

std::uint64_t build_identity() noexcept {
    std::uint64_t hash = kSourcesHash;
    for (const char letter : std::string_view(__VERSION__)) {
        constexpr std::uint64_t kPrime = 0x100000001B3U; // FNV-1a
        hash = (hash ^ static_cast<std::uint8_t>(letter)) * kPrime;
    }
    return hash;
}

const char *build_version() noexcept {
    return kVersion;
}

} // namespace spidar
