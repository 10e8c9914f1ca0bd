// Commands for the motor boards as bytes, with the zeros behind them that the boards need, and their rarer replies read.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "device/serial/protocol/board_layout.h"

namespace spidar {

using BoardBytes = std::span<const std::uint8_t>;
using BoardCurrents = std::array<std::int16_t, kMostBoardMotors>; // in the board's own unit

// Bytes to send in one go. Never allocates; what does not fit is dropped, and whole() says so.
class BoardFrame {
public:
    static constexpr std::size_t kCapacity = 1024; // eight of the longest CURRENT with their zeros

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
    // Something could not be said: the frame is not to be sent.
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

// Zeros that end any command which a board may still be in the middle of.
inline constexpr std::size_t kResyncZeros = 84;

// Each is appended to the frame. INFO is asked before anything of the board is known: its zeros are the handshake's own.
void append_info(BoardFrame &frame, std::uint8_t id) noexcept;
// For all boards of the bus: how long the commands for this one are.
void append_command_lengths(BoardFrame &frame, const BoardLayout &board) noexcept;
void append_current(BoardFrame &frame, const BoardLayout &board,
                    const BoardCurrents &currents) noexcept;
// The board answers with the parameter that was asked for before: ask twice.
void append_get_parameter(BoardFrame &frame, const BoardLayout &board,
                          BoardParameter parameter) noexcept;
// All parameters but the torque limits are written to the board's flash. Data that is too long is dropped: not whole().
void append_set_parameter(BoardFrame &frame, const BoardLayout &board, BoardParameter parameter,
                          BoardBytes data) noexcept;
void append_reset(BoardFrame &frame, const BoardLayout &board, bool motors, bool forces) noexcept;

// `bytes` is a whole reply, header first. False: it is none of this board's.
[[nodiscard]] bool decode_info(BoardBytes bytes, std::uint8_t id, BoardInfo &info) noexcept;
// data: empty on failure, else what follows the parameter's number, into `bytes`.
[[nodiscard]] bool decode_parameter(BoardBytes bytes, const BoardLayout &board,
                                    BoardParameter parameter, BoardBytes &data) noexcept;

} // namespace spidar
