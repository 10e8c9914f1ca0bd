// Reads the counts of a bus of boards from the replies to CURRENT. Replies carry neither checksum
// nor number. A reply is accepted only if all of these hold:
// - it was requested, begins with its board's header and has its full length;
// - nothing, up to three zeros or another header follows;
// - its speeds and steps are possible for a string;
// - no garbage lies between the last valid reply and this one;
// - the host requested no new round while a part of it was missing, which rules out two halves of
// different replies.
// Bytes that begin no valid reply are garbage: they are counted and dropped one by one, so that the
// next valid reply is found. The first valid reply after garbage only marks where replies begin. A
// wrong byte that changes a count by less than a string can move is not detected here. The
// redundancy of the eight strings can detect it.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "device/serial/protocol/board_codec.h"
#include "device/serial/protocol/count_step.h"

namespace spidar {

// Counters since configure(); each only grows.
struct ReplyCounters {
    std::uint64_t bytes = 0;
    std::uint64_t replies = 0;       // accepted
    std::uint64_t rounds = 0;        // rounds whose replies were accepted from every board
    std::uint64_t garbage_bytes = 0; // bytes dropped one by one
    std::uint64_t passed_over = 0;   // replies that are valid, but the first after garbage
    std::uint64_t in_pieces = 0;     // valid, but a part arrived after the next request
    std::uint64_t cut_short = 0;     // replies whose rest did not arrive within kRest_us
    std::uint64_t run_together = 0;  // replies with a wrong end, because bytes are missing
    std::uint64_t implausible = 0;   // complete replies with impossible speeds or steps
    std::uint64_t unasked = 0;       // possible replies that were not requested
    std::uint64_t overruns = 0;      // bytes dropped because too many arrived at once
};

class ReplyReader {
public:
    // A board's counts are used from this many consistent replies on, since the first reply has no
    // earlier counts to compare with.
    static constexpr int kAgreeing = 3;
    // After this many replies that agree with each other but not with earlier counts, the board is
    // taken to count from a new origin.
    static constexpr int kElsewhere = 5;
    // Time within which the rest of a reply must arrive (unit: us).
    static constexpr std::uint64_t kRest_us = 3'000;
    // Number of newest rounds that may be unanswered without counting as lost.
    static constexpr std::uint64_t kInFlight = 3;
    // Number of newest rounds to which a board may still reply, because the system's queue was not
    // read for a while. A reply to an older round is no longer expected.
    static constexpr std::uint64_t kMostOwed = 64;

    // Restarts for these boards (at most kMostBoards), in the order in which they are asked.
    void configure(std::span<const BoardLayout> boards, const CountLimits &limits) noexcept;

    // Takes received bytes. asked: number of rounds requested since configure(). now_us: monotonic
    // clock. Returns the number of rounds that became complete.
    int take(BoardBytes bytes, std::uint64_t asked, std::uint64_t now_us) noexcept;

    [[nodiscard]] std::size_t board_count() const noexcept { return count_; }
    // Returns a motor's count in the newest complete round: the first 16-bit count plus all steps
    // since.
    [[nodiscard]] std::int32_t count(std::size_t board, std::size_t motor) const noexcept {
        return boards_[board].shown[motor];
    }
    // Returns the raw value of a force sensor in the newest accepted reply.
    [[nodiscard]] std::int16_t force(std::size_t board, std::size_t sensor) const noexcept {
        return boards_[board].last.forces[sensor];
    }
    [[nodiscard]] std::size_t force_count(std::size_t board) const noexcept {
        return std::min<std::size_t>(boards_[board].layout.info.forces, kMostBoardForces);
    }
    // True when an earlier zero is no longer valid for the counts: a board was silent for so long
    // that its counts may have wrapped unseen, or a board counts from a new origin.
    [[nodiscard]] bool reference_lost(std::uint64_t now_us) const noexcept;
    [[nodiscard]] const ReplyCounters &counters() const noexcept { return counters_; }
    // Returns the number of requested rounds that are not complete, without the last kInFlight.
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
        // Consistent replies so far, at most kAgreeing. From kAgreeing on, counts are used.
        int agreeing = 0;
        // Newest possible reply whose counts do not agree with `last`, as after a board's restart.
        BoardMotion elsewhere;
        std::uint64_t elsewhere_us = 0;
        int agreeing_elsewhere = 0;
        std::uint64_t answered = 0;
        std::array<std::int32_t, kMostBoardMotors> counts{};
        std::array<std::int32_t, kMostBoardMotors> shown{};
    };

    [[nodiscard]] int board_of(std::uint8_t byte) const noexcept;
    [[nodiscard]] bool runs_on(std::size_t start, const Board &board) const noexcept;
    // Takes one reply or one byte from the front of the buffer. Returns false when the buffer is
    // empty or begins with a reply whose rest may still arrive.
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
    // Time when the reply at the front was first seen to be incomplete; 0: it is not.
    std::uint64_t waiting_since_us_ = 0;
    // Number of rounds that were requested at that time.
    std::uint64_t waiting_asked_ = 0;
    std::size_t next_in_round_ = 0;
    std::size_t stray_zeros_ = 0; // consecutive zeros after a valid reply
    bool in_step_ = true;         // no garbage since the last valid reply
    ReplyCounters counters_;
};

} // namespace spidar
