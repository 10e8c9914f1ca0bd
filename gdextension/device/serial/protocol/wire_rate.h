// Computes how often the host can ask all boards of a bus, from the time that one round of CURRENT
// commands takes on the wire.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "device/serial/protocol/board_layout.h"

namespace spidar {

inline constexpr double kBitsPerByte = 10.0; // start bit, eight data bits, stop bit
// Share of the wire's time that commands may fill. The rest is for the gaps between the packets
// that a USB bridge sends.
inline constexpr double kWireShare = 0.9;

// Returns the number of bytes in the CURRENT commands to all boards, with their zeros.
[[nodiscard]] inline std::size_t round_bytes(std::span<const BoardLayout> boards) noexcept {
    std::size_t bytes = 0;
    for (const BoardLayout &board : boards) {
        bytes +=
            command_length(board, BoardCommand::current) + padding(board, BoardCommand::current);
    }
    return bytes;
}

[[nodiscard]] inline double round_time_s(std::span<const BoardLayout> boards,
                                         std::uint32_t baud) noexcept {
    return static_cast<double>(round_bytes(boards)) * kBitsPerByte / baud;
}

// Returns the highest rate of rounds (unit: Hz); 0 without boards.
[[nodiscard]] inline double highest_rate_hz(std::span<const BoardLayout> boards,
                                            std::uint32_t baud) noexcept {
    const double time_s = round_time_s(boards, baud);
    return time_s > 0.0 ? kWireShare / time_s : 0.0;
}

} // namespace spidar
