// Encodes commands for the motor boards, with the zeros that must follow each of them. Decodes the
// replies to INFO and GET_PARAM; ReplyReader decodes those to CURRENT.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "device/serial/protocol/board_layout.h"

namespace spidar {

using BoardBytes = std::span<const std::uint8_t>;
using BoardCurrents = std::array<std::int16_t, kMostBoardMotors>; // in the board's unit

// Bytes to send at once. Never allocates. Drops bytes beyond kCapacity; whole() then returns false.
class BoardFrame {
public:
    // Room for eight of the longest CURRENT commands with their zeros, and for kResyncZeros.
    static constexpr std::size_t kCapacity = 1024;

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
    // Marks the frame as incomplete, so that the caller does not send it.
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

// Number of zeros that complete a command that a board is still receiving. No command that this
// host sends is longer.
inline constexpr std::size_t kResyncZeros = 84;

// Appends INFO with the zeros of the handshake, since padding() needs the board's layout, which is
// not yet known.
void append_info(BoardFrame &frame, std::uint8_t id) noexcept;
// Appends SET_CMDLEN, which tells all boards of the bus how long this board's commands are.
void append_command_lengths(BoardFrame &frame, const BoardLayout &board) noexcept;
// Appends CURRENT, which sets the currents and makes the board reply with its counts and speeds.
void append_current(BoardFrame &frame, const BoardLayout &board,
                    const BoardCurrents &currents) noexcept;
// Appends GET_PARAM. A board answers with the parameter of the previous question, so ask twice.
void append_get_parameter(BoardFrame &frame, const BoardLayout &board,
                          BoardParameter parameter) noexcept;
// Appends SET_PARAM. The board stores each parameter except torque_limits in its flash memory. If
// `data` is too long, the frame becomes incomplete.
void append_set_parameter(BoardFrame &frame, const BoardLayout &board, BoardParameter parameter,
                          BoardBytes data) noexcept;
void append_reset(BoardFrame &frame, const BoardLayout &board, bool motors, bool forces) noexcept;

// Decodes a whole INFO reply. Returns false when the reply is not from board `id` or
// is_plausible() rejects its content.
[[nodiscard]] bool decode_info(BoardBytes bytes, std::uint8_t id, BoardInfo &info) noexcept;
// Decodes a whole GET_PARAM reply. Returns false, with empty `data`, if it is not this board's
// reply for `parameter`. data: the part of `bytes` that holds the parameter's value.
[[nodiscard]] bool decode_parameter(BoardBytes bytes, const BoardLayout &board,
                                    BoardParameter parameter, BoardBytes &data) noexcept;

} // namespace spidar
