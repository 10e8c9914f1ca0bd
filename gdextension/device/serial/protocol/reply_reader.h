// Counts from the replies of a bus of boards to CURRENT. Replies carry neither checksum nor number.
// A reply is accepted only if all of these hold:
// - it was requested, begins with its board's header and has its full length;
// - nothing or another header follows;
// - its speeds and steps are possible for a string;
// - it directly follows another valid reply, with no other request in between, which rules out two
// halves of different replies.
// Everything else is counted and dropped byte by byte, so that the next valid reply is found
// whatever came before. The first valid reply after garbage only marks where replies begin. A wrong
// byte that changes a count by less than a string can move is not detected here; the redundancy of
// the eight strings detects it.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "device/serial/protocol/board_codec.h"
#include "device/serial/protocol/count_step.h"

namespace spidar {

// Counters; each only grows.
struct ReplyCounters {
    std::uint64_t bytes = 0;
    std::uint64_t replies = 0;       // accepted
    std::uint64_t rounds = 0;        // rounds in which every board answered
    std::uint64_t garbage_bytes = 0; // bytes that belong to no accepted reply
    std::uint64_t passed_over = 0;   // valid, but the first after garbage
    std::uint64_t in_pieces = 0;     // valid, but a part arrived after the next request
    std::uint64_t cut_short = 0;     // incomplete
    std::uint64_t run_together = 0;  // complete, but no reply follows: bytes are missing
    std::uint64_t implausible = 0;   // complete, but with impossible speeds or steps
    std::uint64_t unasked = 0;       // complete, but not requested
    std::uint64_t overruns = 0;      // bytes dropped because too many arrived at once
};

class ReplyReader {
public:
    // Consistent replies before the first is accepted: there are no earlier counts to compare.
    static constexpr int kAgreeing = 3;
    // Number of replies that agree with each other but not with earlier counts, after which the
    // board counts from a new origin.
    static constexpr int kElsewhere = 5;
    // Time within which the rest of a reply must arrive.
    static constexpr std::uint64_t kRest_us = 3'000;
    // Number of rounds that may be unanswered without counting as lost.
    static constexpr std::uint64_t kInFlight = 3;
    // Answers that a board may still owe when the system's queue was not read for a while.
    static constexpr std::uint64_t kMostOwed = 64;

    // Restarts for these boards (at most kMostBoards), in the order in which they are asked.
    void configure(std::span<const BoardLayout> boards, const CountLimits &limits) noexcept;

    // Takes received bytes. asked: number of rounds requested so far, which never falls. Returns
    // the number of rounds that became complete.
    int take(BoardBytes bytes, std::uint64_t asked, std::uint64_t now_us) noexcept;

    [[nodiscard]] std::size_t board_count() const noexcept { return count_; }
    // Returns a count of the newest complete round, unwrapped from the first 16-bit count on.
    [[nodiscard]] std::int32_t count(std::size_t board, std::size_t motor) const noexcept {
        return boards_[board].shown[motor];
    }
    // Returns the raw value of a force sensor.
    [[nodiscard]] std::int16_t force(std::size_t board, std::size_t sensor) const noexcept {
        return boards_[board].last.forces[sensor];
    }
    [[nodiscard]] std::size_t force_count(std::size_t board) const noexcept {
        return std::min<std::size_t>(boards_[board].layout.info.forces, kMostBoardForces);
    }
    // True when the zero is lost: a board was silent for so long that its counts may have wrapped
    // unseen, or it counts from a new origin.
    [[nodiscard]] bool reference_lost(std::uint64_t now_us) const noexcept;
    [[nodiscard]] const ReplyCounters &counters() const noexcept { return counters_; }
    // Returns the number of requested rounds without full answer, except the last kInFlight.
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
        // Consistent replies so far; kAgreeing: accepted.
        int agreeing = 0;
        // Replies that agree with each other, not with earlier counts, as after a board's restart.
        BoardMotion elsewhere;
        std::uint64_t elsewhere_us = 0;
        int agreeing_elsewhere = 0;
        std::uint64_t answered = 0;
        std::array<std::int32_t, kMostBoardMotors> counts{};
        std::array<std::int32_t, kMostBoardMotors> shown{};
    };

    [[nodiscard]] int board_of(std::uint8_t byte) const noexcept;
    [[nodiscard]] bool runs_on(std::size_t start, const Board &board) const noexcept;
    // Takes one reply or one byte from the front. Returns false when the rest is incomplete.
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
    // Time since which the reply at the front is incomplete; 0: none is.
    std::uint64_t waiting_since_us_ = 0;
    // Rounds requested when that wait began.
    std::uint64_t waiting_asked_ = 0;
    std::size_t next_in_round_ = 0;
    std::size_t stray_zeros_ = 0; // consecutive zeros after a valid reply
    bool in_step_ = true;         // no garbage since the last valid reply
    ReplyCounters counters_;
};

} // namespace spidar
