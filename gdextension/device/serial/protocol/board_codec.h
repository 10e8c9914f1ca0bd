// Commands for the motor boards as bytes, followed by the zeros that the boards need, and decoding
// of their rare replies.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "device/serial/protocol/board_layout.h"

namespace spidar {

using BoardBytes = std::span<const std::uint8_t>;
using BoardCurrents = std::array<std::int16_t, kMostBoardMotors>; // in the board's unit

// Bytes to send at once. Never allocates. Excess bytes are dropped and clear whole().
class BoardFrame {
public:
    static constexpr std::size_t kCapacity = 1024; // eight longest CURRENT commands with zeros

    void byte(std::uint8_t value) noexcept {
        whole_ = whole_ && size_ < kCapacity;
        if (whole_) {
            bytes_[size_++] = value;
        }
    }
    void word(std::int16_t value) noexcept {
        const auto bits = static_cast<std::uint16_t>(value);
        byte(static_cast<std::uint8_t>(bits & 0xFFU));
        byte(static_cast<std::uint8_t>(bits >> 8U));
    }
    void zeros(std::size_t count) noexcept {
        for (std::size_t i = 0; i < count && whole_; ++i) {
            byte(0);
        }
    }
    // Marks the frame as incomplete: it must not be sent.
    void spoil() noexcept { whole_ = false; }
    [[nodiscard]] BoardBytes bytes() const noexcept { return BoardBytes(bytes_).first(size_); }
    [[nodiscard]] std::size_t size() const noexcept { return size_; }
    [[nodiscard]] bool whole() const noexcept { return whole_; }
    void clear() noexcept {
        size_ = 0;
        whole_ = true;
    }

private:
    std::array<std::uint8_t, kCapacity> bytes_{};
    std::size_t size_ = 0;
    bool whole_ = true;
};

// Number of zeros that complete any command that a board may be receiving.
inline constexpr std::size_t kResyncZeros = 84;

// Appends INFO. The board is unknown at that time; the zeros are those of the handshake.
void append_info(BoardFrame &frame, std::uint8_t id) noexcept;
// Appends the lengths of this board's commands, for all boards of the bus.
void append_command_lengths(BoardFrame &frame, const BoardLayout &board) noexcept;
void append_current(BoardFrame &frame, const BoardLayout &board,
                    const BoardCurrents &currents) noexcept;
// Appends GET_PARAM. The board answers with the parameter of the previous question: ask twice.
void append_get_parameter(BoardFrame &frame, const BoardLayout &board,
                          BoardParameter parameter) noexcept;
// Appends SET_PARAM. All parameters except the torque limits are written to the board's flash. Data
// that is too long makes the frame incomplete.
void append_set_parameter(BoardFrame &frame, const BoardLayout &board, BoardParameter parameter,
                          BoardBytes data) noexcept;
void append_reset(BoardFrame &frame, const BoardLayout &board, bool motors, bool forces) noexcept;

// Decodes a whole INFO reply. Returns false when it is not from board `id` or not plausible.
[[nodiscard]] bool decode_info(BoardBytes bytes, std::uint8_t id, BoardInfo &info) noexcept;
// Decodes a parameter. data: a view into `bytes` behind the parameter's number; empty on failure.
[[nodiscard]] bool decode_parameter(BoardBytes bytes, const BoardLayout &board,
                                    BoardParameter parameter, BoardBytes &data) noexcept;

} // namespace spidar
