#include "device/serial/protocol/reply_reader.h"

#include <algorithm>

namespace spidar {

namespace {

// Largest number of stray zeros: a driver that releases the line may leave a few behind a reply;
// more belong to another reply.
constexpr std::size_t kMostStrayZeros = 3;
constexpr double kSecondsPerMicrosecond = 1e-6;
// Largest plausible step: half a turn of 16 bits loses the sign of a step; a quarter leaves room.
constexpr double kSureStep_counts = 16384.0;

std::uint16_t word_at(BoardBytes bytes, std::size_t at) noexcept {
    return static_cast<std::uint16_t>(bytes[at] | bytes[at + 1] << 8U);
}

std::int32_t wrapping_sum(std::int32_t a, std::int32_t b) noexcept {
    return static_cast<std::int32_t>(static_cast<std::uint32_t>(a) + static_cast<std::uint32_t>(b));
}

double seconds(std::uint64_t time_us) noexcept {
    return static_cast<double>(time_us) * kSecondsPerMicrosecond;
}

BoardMotion motion_of(BoardBytes reply, const BoardLayout &layout) noexcept {
    const std::size_t motors = layout.motors();
    BoardMotion motion;
    for (std::size_t i = 0; i < motors; ++i) {
        motion.positions[i] = word_at(reply, 1 + 2 * i);
        motion.speeds[i] = static_cast<std::int16_t>(word_at(reply, 1 + 2 * (motors + i)));
    }
    const std::size_t forces = std::min<std::size_t>(layout.info.forces, motion.forces.size());
    for (std::size_t i = 0; i < forces; ++i) {
        motion.forces[i] = static_cast<std::int16_t>(word_at(reply, 1 + 2 * (2 * motors + i)));
    }
    return motion;
}

} // namespace

void ReplyReader::configure(std::span<const BoardLayout> boards,
                            const CountLimits &limits) noexcept {
    *this = ReplyReader();
    limits_ = limits;
    count_ = std::min(boards.size(), boards_.size());
    for (std::size_t i = 0; i < count_; ++i) {
        boards_[i].layout = boards[i];
        boards_[i].header = board_header(BoardCommand::current, boards[i].id);
        boards_[i].length = reply_length(boards[i], BoardCommand::current);
    }
}

int ReplyReader::board_of(std::uint8_t byte) const noexcept {
    for (std::size_t i = 0; i < count_; ++i) {
        if (boards_[i].header == byte) {
            return static_cast<int>(i);
        }
    }
    return -1;
}

// Bytes of this reply are missing when the next one begins inside it.
bool ReplyReader::runs_on(std::size_t start, const Board &board) const noexcept {
    const std::size_t behind = start + board.length;
    // The last byte is the upper half of a force or a speed, which never equals a header.
    if (board_of(buffer_[behind - 1]) >= 0) {
        return true;
    }
    const std::size_t left = end_ - behind;
    if (left == 0 || board_of(buffer_[behind]) >= 0) {
        return false;
    }
    const auto *const stray = buffer_.data() + behind;
    return left > kMostStrayZeros ||
           std::any_of(stray, stray + left, [](std::uint8_t byte) { return byte != 0; });
}

void ReplyReader::note_elsewhere(Board &board, const BoardMotion &motion,
                                 std::uint64_t now_us) noexcept {
    const bool agrees =
        board.agreeing_elsewhere > 0 &&
        step_is_possible(board.elsewhere, motion, seconds(now_us - board.elsewhere_us),
                         board.layout, limits_);
    board.agreeing_elsewhere = agrees ? board.agreeing_elsewhere + 1 : 1;
    board.elsewhere = motion;
    board.elsewhere_us = now_us;
}

bool ReplyReader::could_be(Board &board, const BoardMotion &motion, std::uint64_t asked,
                           std::uint64_t now_us) noexcept {
    const bool possible = speeds_are_possible(motion, board.layout, limits_);
    const bool fits =
        possible && (board.agreeing == 0 ||
                     step_is_possible(board.last, motion, seconds(now_us - board.last_us),
                                      board.layout, limits_));
    if (!fits) {
        ++counters_.implausible;
        if (board.agreeing < kAgreeing) {
            board.agreeing = 0; // one of the two was wrong
        } else if (possible) {
            note_elsewhere(board, motion, now_us);
        }
        return false;
    }
    if (board.answered >= asked) {
        ++counters_.unasked;
        return false;
    }
    return true;
}

void ReplyReader::believe(Board &board, const BoardMotion &motion, std::uint64_t asked,
                          std::uint64_t now_us) noexcept {
    for (std::size_t i = 0; i < board.layout.motors(); ++i) {
        board.counts[i] = board.agreeing == 0
                              ? static_cast<std::int16_t>(motion.positions[i])
                              : wrapping_sum(board.counts[i], signed_step(board.last.positions[i],
                                                                          motion.positions[i]));
    }
    board.last = motion;
    board.last_us = now_us;
    board.agreeing_elsewhere = 0;
    board.agreeing = std::min(board.agreeing + 1, kAgreeing);
    board.answered = std::max(board.answered + 1, asked > kMostOwed ? asked - kMostOwed : 0);
}

bool ReplyReader::completes_round(std::size_t board) noexcept {
    if (board != next_in_round_ && board != 0) {
        next_in_round_ = 0; // a reply in between is missing
        return false;
    }
    next_in_round_ = board + 1;
    if (next_in_round_ < count_) {
        return false;
    }
    next_in_round_ = 0;
    const auto end = boards_.begin() + static_cast<std::ptrdiff_t>(count_);
    if (std::any_of(boards_.begin(), end,
                    [](const Board &one) { return one.agreeing < kAgreeing; })) {
        return false;
    }
    for (auto one = boards_.begin(); one != end; ++one) {
        one->shown = one->counts;
    }
    ++counters_.rounds;
    return true;
}

bool ReplyReader::parse_front(std::uint64_t asked, std::uint64_t now_us, int &rounds) noexcept {
    if (front_ == end_) {
        return false;
    }
    const int which = board_of(buffer_[front_]);
    if (which < 0) {
        if (buffer_[front_] == 0 && in_step_ && stray_zeros_ < kMostStrayZeros) {
            ++stray_zeros_;
            drop(1);
        } else {
            drop_garbage();
        }
        return true;
    }
    Board &board = boards_[static_cast<std::size_t>(which)];
    if (end_ - front_ < board.length) {
        if (waiting_since_us_ == 0) {
            waiting_since_us_ = std::max<std::uint64_t>(now_us, 1);
            waiting_asked_ = asked;
        }
        if (now_us - std::min(now_us, waiting_since_us_) < kRest_us) {
            return false;
        }
        waiting_since_us_ = 0;
        ++counters_.cut_short;
        drop_garbage();
        return true;
    }
    const bool in_pieces = waiting_since_us_ != 0 && waiting_asked_ != asked;
    waiting_since_us_ = 0;
    const BoardBytes reply = BoardBytes(buffer_).subspan(front_, board.length);
    const bool joined = runs_on(front_, board);
    counters_.run_together += joined ? 1U : 0U;
    const BoardMotion motion = motion_of(reply, board.layout);
    if (joined || !could_be(board, motion, asked, now_us)) {
        drop_garbage();
        return true;
    }
    if (in_step_ && !in_pieces) {
        believe(board, motion, asked, now_us);
        ++counters_.replies;
        rounds += completes_round(static_cast<std::size_t>(which)) ? 1 : 0;
    } else {
        ++(in_pieces ? counters_.in_pieces : counters_.passed_over);
        next_in_round_ = 0;
    }
    in_step_ = true;
    stray_zeros_ = 0;
    drop(board.length);
    return true;
}

int ReplyReader::take(BoardBytes bytes, std::uint64_t asked, std::uint64_t now_us) noexcept {
    counters_.bytes += bytes.size();
    int rounds = 0;
    std::copy(buffer_.begin() + static_cast<std::ptrdiff_t>(front_),
              buffer_.begin() + static_cast<std::ptrdiff_t>(end_), buffer_.begin());
    end_ -= front_;
    front_ = 0;
    const std::size_t fits = std::min(bytes.size(), buffer_.size() - end_);
    counters_.overruns += bytes.size() - fits;
    std::copy_n(bytes.begin(), fits, buffer_.begin() + static_cast<std::ptrdiff_t>(end_));
    end_ += fits;
    while (parse_front(asked, now_us, rounds)) { // each turn takes a byte at least
    }
    return rounds;
}

bool ReplyReader::reference_lost(std::uint64_t now_us) const noexcept {
    const double sure_s = kSureStep_counts / limits_.fastest_counts_s - kArrivalJitter_s;
    return std::any_of(boards_.begin(), boards_.begin() + static_cast<std::ptrdiff_t>(count_),
                       [now_us, sure_s](const Board &board) {
                           const bool silent = board.agreeing == kAgreeing &&
                                               now_us > board.last_us &&
                                               seconds(now_us - board.last_us) > sure_s;
                           return silent || board.agreeing_elsewhere >= kElsewhere;
                       });
}

} // namespace spidar
