// The bytes that a bus of boards answers to CURRENT, as counts that may be believed. Replies carry neither a check sum nor
// a number, so one is believed only when it was asked for, begins with its board's header, has its whole length, is followed
// by nothing or by another header, says speeds and steps of counts that strings can make, stands right behind another good
// reply, and came without another question in between: two halves of two replies would else fit together. Everything else is counted and dropped, a byte at a time, so that the next good reply is found whatever came
// before it; that one only shows where replies begin, and the one behind it is believed. A byte that is wrong in its place
// and changes a count by less than a string can move cannot be seen here; the redundancy of the eight strings sees it.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "device/serial/protocol/board_codec.h"
#include "device/serial/protocol/count_step.h"

namespace spidar {

// Each only grows.
struct ReplyCounters {
    std::uint64_t bytes = 0;
    std::uint64_t replies = 0;       // believed
    std::uint64_t rounds = 0;        // every board answered
    std::uint64_t garbage_bytes = 0; // belonged to no reply that was believed
    std::uint64_t passed_over = 0;   // good, but the first behind garbage
    std::uint64_t in_pieces = 0;     // good, but half of it came after the next question
    std::uint64_t cut_short = 0;     // began, and the rest did not come
    std::uint64_t run_together = 0;  // whole, but followed by what is no reply: bytes are missing
    std::uint64_t implausible = 0;   // whole, but with speeds or steps that no string makes
    std::uint64_t unasked = 0;       // whole, but nobody asked
    std::uint64_t overruns = 0;      // bytes dropped because too many came at once
};

class ReplyReader {
public:
    // Replies that agree before the first one is believed: there is nothing else to compare them with.
    static constexpr int kAgreeing = 3;
    // So many that agree with each other and not with the counts before: the board counts from elsewhere.
    static constexpr int kElsewhere = 5;
    // The rest of a reply comes within this time, or it does not come.
    static constexpr std::uint64_t kRest_us = 3'000;
    // Rounds on their way at once; more are counted as lost until they come.
    static constexpr std::uint64_t kInFlight = 3;
    // Answers that a board may still owe: so many wait where a system's queue was not read for a while.
    static constexpr std::uint64_t kMostOwed = 64;

    // Everything anew, for these boards, at most kMostBoards, in the order in which they are asked.
    void configure(std::span<const BoardLayout> boards, const CountLimits &limits) noexcept;

    // asked: rounds asked so far, which never falls. Returns the rounds that became complete.
    int take(BoardBytes bytes, std::uint64_t asked, std::uint64_t now_us) noexcept;

    [[nodiscard]] std::size_t board_count() const noexcept { return count_; }
    // Of the newest complete round: unwrapped from the 16 bits of the first one on.
    [[nodiscard]] std::int32_t count(std::size_t board, std::size_t motor) const noexcept {
        return boards_[board].shown[motor];
    }
    // Of its force sensors, as it measures them.
    [[nodiscard]] std::int16_t force(std::size_t board, std::size_t sensor) const noexcept {
        return boards_[board].last.forces[sensor];
    }
    [[nodiscard]] std::size_t force_count(std::size_t board) const noexcept {
        return std::min<std::size_t>(boards_[board].layout.info.forces, kMostBoardForces);
    }
    // A board has been silent for so long that its counts may have turned round unseen, or it counts from elsewhere: the
    // zero is lost.
    [[nodiscard]] bool reference_lost(std::uint64_t now_us) const noexcept;
    [[nodiscard]] const ReplyCounters &counters() const noexcept { return counters_; }
    // Rounds asked and never answered in full, beside those that may still be on their way.
    [[nodiscard]] std::uint64_t lost(std::uint64_t asked) const noexcept {
        const std::uint64_t due = asked > kInFlight ? asked - kInFlight : 0;
        return due > counters_.rounds ? due - counters_.rounds : 0;
    }

private:
    static constexpr std::size_t kRoom = 1024;

    struct Board {
        BoardLayout layout;
        std::uint8_t header = 0;
        std::size_t length = 0;
        BoardMotion last;
        std::uint64_t last_us = 0;
        int agreeing = 0; // replies so far that fit together; kAgreeing: believed
        // Replies that fit each other and not the counts before: a board that was switched off and on.
        BoardMotion elsewhere;
        std::uint64_t elsewhere_us = 0;
        int agreeing_elsewhere = 0;
        std::uint64_t answered = 0;
        std::array<std::int32_t, kMostBoardMotors> counts{};
        std::array<std::int32_t, kMostBoardMotors> shown{};
    };

    [[nodiscard]] int board_of(std::uint8_t byte) const noexcept;
    [[nodiscard]] bool runs_on(std::size_t start, const Board &board) const noexcept;
    // Takes one reply or one byte off the front. False: what is left is not whole yet.
    bool parse_front(std::uint64_t asked, std::uint64_t now_us, int &rounds) noexcept;
    [[nodiscard]] bool could_be(Board &board, const BoardMotion &motion, std::uint64_t asked,
                                std::uint64_t now_us) noexcept;
    void note_elsewhere(Board &board, const BoardMotion &motion, std::uint64_t now_us) noexcept;
    void believe(Board &board, const BoardMotion &motion, std::uint64_t asked,
                 std::uint64_t now_us) noexcept;
    bool completes_round(std::size_t board) noexcept;
    void drop(std::size_t count) noexcept { front_ += count; }
    void drop_garbage() noexcept {
        ++counters_.garbage_bytes;
        stray_zeros_ = 0;
        in_step_ = false;
        drop(1);
    }

    std::array<Board, kMostBoards> boards_{};
    std::size_t count_ = 0;
    CountLimits limits_;
    std::array<std::uint8_t, kRoom> buffer_{};
    std::size_t front_ = 0;
    std::size_t end_ = 0;
    std::uint64_t waiting_since_us_ = 0; // for the rest of the reply at the front; 0: none waits
    std::uint64_t waiting_asked_ = 0;    // rounds asked when that wait began
    std::size_t next_in_round_ = 0;
    std::size_t stray_zeros_ = 0; // in a row, behind a good reply
    bool in_step_ = true;         // no garbage since the last good reply
    ReplyCounters counters_;
};

} // namespace spidar
