// The firmware of a serial motor board as docs/reference/serial_boards.md describes it, without hardware: bytes and encoder counts
// in, bytes and motor currents out. It has no watchdog: the last current holds. Written from the description alone.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <vector>

#include "device/serial/protocol/board_layout.h"

namespace spidar::test {

class BoardFirmware {
public:
    explicit BoardFirmware(const BoardLayout &layout);

    // A byte of the host's line, which every board of a bus hears. What the board sends on it is appended to `answer`.
    void hear(std::uint8_t byte, std::vector<std::uint8_t> &answer);
    // Where the encoders stand, and how fast they turn (counts a second).
    void turn(std::size_t motor, std::int32_t count, double counts_s);
    // Switched off and on: counts, currents and what it was told are gone; what is in flash stays.
    void restart();

    [[nodiscard]] const std::array<std::int16_t, kMostBoardMotors> &currents() const {
        return currents_;
    }
    [[nodiscard]] const BoardLayout &layout() const { return layout_; }
    [[nodiscard]] std::uint64_t executed(BoardCommand command) const {
        return executed_[static_cast<std::size_t>(command)];
    }
    [[nodiscard]] std::uint64_t cut_replies() const { return cut_replies_; }

    // In flash. The factory's mask is 0: magnet sensors, which a SPIDAR does not have.
    std::uint32_t quadrature_mask = 0xFF;
    // Answers to another id as soon as it is written; else from the next power-up on. The sources do not say which.
    bool id_counts_at_once = false;
    bool forgets = false; // its flash is worn out
    // What SET_PARAM has written to flash so often.
    [[nodiscard]] std::uint64_t flash_writes() const { return flash_writes_; }
    [[nodiscard]] std::uint8_t flash_id() const { return flash_id_; }
    // Counts of motors without a hardware counter are lost above this speed; below, none are.
    double sure_counts_s = 1e12;
    double lost_share = 0.0; // of the counts above it

private:
    // The receiver interrupts when so many bytes have come.
    static constexpr std::size_t kInterrupt = 6;

    void process(std::uint8_t byte, std::vector<std::uint8_t> &answer);
    void begin(std::uint8_t header);
    void prepare_reply(BoardCommand command);
    void execute();
    void append(std::int16_t word);
    void set_parameter();

    BoardLayout layout_;
    std::array<std::array<std::uint8_t, kBoardCommandCount>, kMostBoards> lengths_{};
    std::deque<std::uint8_t> fifo_;
    std::vector<std::uint8_t> command_; // so far
    std::size_t left_ = 0;              // of it
    std::vector<std::uint8_t> reply_;
    std::size_t replied_ = 0;
    std::array<std::int16_t, kMostBoardMotors> currents_{};
    std::array<std::int32_t, kMostBoardMotors> counts_{};
    std::array<std::int32_t, kMostBoardMotors> origin_{}; // of the encoders, at power-up
    std::array<std::int32_t, kMostBoardMotors> turned_{};
    std::array<std::int16_t, kMostBoardMotors> speeds_{};
    std::array<double, kMostBoardMotors> losses_{};
    std::uint8_t parameter_ = 0; // asked for last
    std::uint8_t flash_id_ = 0;
    std::uint64_t flash_writes_ = 0;
    std::array<std::uint64_t, kBoardCommandCount> executed_{};
    std::uint64_t cut_replies_ = 0;
};

} // namespace spidar::test
