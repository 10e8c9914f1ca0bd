// Sequence numbers of reports and commands: 16 bits, from 0 to 0xFFFE, then 0 again.
#pragma once

#include <cstdint>

namespace spidar {

inline constexpr std::uint16_t kNoSequence = 0xFFFF; // stands for "none"

[[nodiscard]] constexpr std::uint16_t next_sequence(std::uint16_t sequence) noexcept {
    return static_cast<std::uint16_t>(sequence >= kNoSequence - 1 ? 0 : sequence + 1);
}

// True when `candidate` is newer than `than`: candidate - than, as a signed 16-bit number, is
// positive.
[[nodiscard]] constexpr bool is_newer(std::uint16_t candidate, std::uint16_t than) noexcept {
    return static_cast<std::int16_t>(static_cast<std::uint16_t>(candidate - than)) > 0;
}

// Returns how many calls of next_sequence() lead from `from` to a newer `to`.
[[nodiscard]] constexpr std::uint32_t sequence_steps(std::uint16_t from,
                                                     std::uint16_t to) noexcept {
    const std::uint32_t difference = static_cast<std::uint16_t>(to - from);
    return to < from ? difference - 1 : difference;
}

} // namespace spidar
