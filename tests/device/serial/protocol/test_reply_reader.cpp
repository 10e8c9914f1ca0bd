// Replies of the motor boards between lost, repeated and foreign bytes: nothing is believed that was not sent.
#include <doctest/doctest.h>

#include <deque>
#include <string>
#include <vector>

#include "device/serial/protocol/reply_reader.h"
#include "support/case_random.h"

using namespace spidar;
using Bytes = std::vector<std::uint8_t>;

namespace {

constexpr BoardLayout kB3m{2, {5, 3, 4, 4, 0, 0}, 0};
constexpr BoardLayout kB5m{1, {7, 3, 8, 0, 4, 0}, 0};
constexpr std::uint64_t kRound_us = 1000;

void append_word(Bytes &bytes, std::int32_t value) {
    bytes.push_back(static_cast<std::uint8_t>(value & 0xFF));
    bytes.push_back(static_cast<std::uint8_t>(value >> 8 & 0xFF));
}

using Counts = std::array<std::int32_t, kMostBoardMotors>;

Bytes reply_of(const BoardLayout &board, const Counts &counts, const Counts &speeds = {}) {
    Bytes bytes{board_header(BoardCommand::current, board.id)};
    for (std::size_t i = 0; i < board.motors(); ++i) {
        append_word(bytes, counts[i]);
    }
    for (std::size_t i = 0; i < board.motors(); ++i) {
        append_word(bytes, speeds[i]);
    }
    for (std::size_t i = 0; i < board.info.forces; ++i) {
        append_word(bytes, 0x0123 + static_cast<std::int32_t>(i));
    }
    return bytes;
}

// A host that asks once a millisecond and hears one board.
struct OneBoard {
    explicit OneBoard(const BoardLayout &board_in) : board(board_in) {
        const BoardLayout all[] = {board};
        reader.configure(all, {});
    }
    int hear(const Bytes &bytes) {
        now_us += kRound_us;
        ++asked;
        return reader.take(bytes, asked, now_us);
    }
    int hear(const Counts &counts) { return hear(reply_of(board, counts)); }
    void settle(const Counts &counts) {
        for (int i = 0; i < ReplyReader::kAgreeing; ++i) {
            hear(counts);
        }
        REQUIRE(reader.counters().rounds >= 1);
    }
    BoardLayout board;
    ReplyReader reader;
    std::uint64_t now_us = 5000;
    std::uint64_t asked = 0;
};

} // namespace

TEST_CASE("reply reader: the third reply that agrees is the first to be believed") {
    OneBoard host(kB5m);
    const Counts counts{1, -2, 300, -400, 5, 6, 7, 32767};
    CHECK(host.hear(counts) == 0);
    CHECK(host.hear(counts) == 0);
    CHECK(host.hear(counts) == 1);
    for (std::size_t i = 0; i < counts.size(); ++i) {
        CHECK(host.reader.count(0, i) == counts[i]);
    }
    CHECK(host.reader.force_count(0) == 4);
    for (std::size_t i = 0; i < 4; ++i) {
        CHECK(host.reader.force(0, i) == 0x0123 + static_cast<int>(i));
    }
    CHECK(host.reader.counters().garbage_bytes == 0);
    CHECK(host.reader.lost(host.asked) == 0);
}

TEST_CASE("reply reader: 16 bits are unwrapped both ways") {
    OneBoard host(kB3m);
    Counts counts{32700, -32700, 0, 0};
    host.settle(counts);
    for (int i = 0; i < 2000; ++i) { // 2 m/s for two seconds: several turns of 16 bits
        counts[0] += 80;
        counts[1] -= 80;
        const Counts speeds{27, -27, 0, 0};
        REQUIRE(host.hear(reply_of(kB3m, counts, speeds)) == 1);
        REQUIRE(host.reader.count(0, 0) == counts[0]);
        REQUIRE(host.reader.count(0, 1) == counts[1]);
    }
}

TEST_CASE("reply reader: what is no reply is counted and passed over") {
    OneBoard host(kB5m);
    const Counts counts{10, 20, 30, 40, 50, 60, 70, 80};
    host.settle(counts);
    Bytes bytes{1, 2, 3, 0x60, 0xFF};
    const Bytes reply = reply_of(kB5m, counts);
    bytes.insert(bytes.end(), reply.begin(), reply.end());
    CHECK(host.hear(bytes) == 0);
    CHECK(host.reader.counters().garbage_bytes == 5);
    CHECK(host.reader.counters().passed_over == 1);
    CHECK(host.hear(reply) == 1);
    Bytes strayed = reply; // a line driver that lets go
    strayed.insert(strayed.end(), 2, 0);
    CHECK(host.hear(strayed) == 1);
    CHECK(host.hear(strayed) == 1);
    CHECK(host.reader.counters().garbage_bytes == 5);
}

TEST_CASE("reply reader: any byte missing from a reply keeps it from being believed") {
    for (const BoardLayout &board : {kB3m, kB5m}) {
        const Counts counts{0, 0,  3, 0,
                            0, -7, 0, 1}; // near zero: shifted words look like good ones
        const Bytes good = reply_of(board, counts);
        for (std::size_t missing = 0; missing < good.size(); ++missing) {
            OneBoard host(board);
            host.settle(counts);
            const auto before = host.reader.counters().replies;
            Bytes cut = good;
            cut.erase(cut.begin() + static_cast<std::ptrdiff_t>(missing));
            CAPTURE(missing);
            CHECK(host.hear(cut) == 0);
            CHECK(host.hear(good) == 0); // shows where replies begin
            CHECK(host.hear(good) == 1);
            CHECK(host.reader.counters().replies == before + 1);
            CHECK(host.reader.counters().garbage_bytes + 3 >=
                  cut.size()); // zeros in front may be stray
            CHECK(host.reader.count(0, 2) == 3);
        }
    }
}

TEST_CASE("reply reader: a reply in two pieces is one, a piece alone is dropped") {
    OneBoard host(kB5m);
    const Counts counts{10, 20, 30, 40, 50, 60, 70, 80};
    host.settle(counts);
    const Bytes good = reply_of(kB5m, counts);
    const Bytes first(good.begin(), good.begin() + 11);
    const Bytes second(good.begin() + 11, good.end());
    CHECK(host.hear(first) == 0);
    CHECK(host.reader.take(second, host.asked, host.now_us + 300) == 1);
    // With another question in between, the halves may be those of two replies.
    CHECK(host.hear(first) == 0);
    CHECK(host.hear(second) == 0);
    CHECK(host.reader.counters().in_pieces == 1);
    CHECK(host.hear(good) == 1);
    CHECK(host.hear(first) == 0);
    for (int i = 0; i < 4; ++i) {
        CHECK(host.hear(Bytes()) == 0);
    }
    CHECK(host.reader.counters().cut_short == 1);
    CHECK(host.hear(good) == 0);
    CHECK(host.hear(good) == 1);
}

TEST_CASE("reply reader: steps and speeds that no string makes are refused") {
    OneBoard host(kB5m);
    Counts counts{};
    host.settle(counts);
    Counts jumped = counts;
    jumped[4] = 2000; // 50 mm in a millisecond
    CHECK(host.hear(jumped) == 0);
    CHECK(host.hear(reply_of(kB5m, counts, {0, 0, 0, 500})) == 0);
    CHECK(host.reader.counters().implausible >= 2);
    CHECK(host.hear(counts) == 0);
    CHECK(host.hear(counts) == 1);
}

TEST_CASE("reply reader: nobody is believed who was not asked") {
    OneBoard host(kB5m);
    host.settle({});
    CHECK(host.reader.take(reply_of(kB5m, {}), host.asked, host.now_us + 10) == 0);
    CHECK(host.reader.counters().unasked == 1);
}

TEST_CASE("reply reader: a round is complete when every board answered in it") {
    const BoardLayout boards[] = {{0, kB3m.info, 0}, {5, kB3m.info, 0}};
    ReplyReader reader;
    reader.configure(boards, {});
    std::uint64_t now_us = 1000;
    std::uint64_t asked = 0;
    const auto hear = [&](bool first, bool second) {
        Bytes bytes = first ? reply_of(boards[0], {1, 2, 3, 4}) : Bytes();
        const Bytes more = second ? reply_of(boards[1], {5, 6, 7, 8}) : Bytes();
        bytes.insert(bytes.end(), more.begin(), more.end());
        now_us += kRound_us;
        return reader.take(bytes, ++asked, now_us);
    };
    hear(true, true);
    hear(true, true);
    CHECK(hear(true, true) == 1);
    CHECK(reader.count(1, 3) == 8);
    CHECK(hear(true, false) == 0);
    CHECK(hear(false, true) ==
          1); // the first one's answer is a round old, as when the bridge split the two
    CHECK(hear(false, true) == 0);
    CHECK(hear(true, true) == 1);
    asked += 10;
    CHECK(reader.lost(asked) == 7 + 10 - ReplyReader::kInFlight - 3);
}

TEST_CASE("reply reader: after a long silence the counts have no reference") {
    OneBoard host(kB5m);
    CHECK(!host.reader.reference_lost(1'000'000));
    host.settle({});
    CHECK(!host.reader.reference_lost(host.now_us + 50'000));
    CHECK(host.reader.reference_lost(host.now_us + 90'000));
}

TEST_CASE("reply reader: a board that counts from elsewhere is not followed there") {
    OneBoard host(kB5m);
    host.settle({700, 700, 700, 700, 700, 700, 700, 700});
    for (int i = 0; i < ReplyReader::kElsewhere; ++i) {
        CHECK(!host.reader.reference_lost(host.now_us));
        CHECK(host.hear(Counts{}) == 0);
    }
    CHECK(host.reader.reference_lost(host.now_us));
}

TEST_CASE("reply reader: more bytes than there is room for are counted") {
    OneBoard host(kB5m);
    host.settle({});
    CHECK(host.hear(Bytes(3000, 0x55)) == 0);
    CHECK(host.reader.counters().overruns > 0);
    CHECK(host.hear(Counts{}) == 0);
    CHECK(host.hear(Counts{}) == 1);
}

namespace {

// A bus whose wire loses, adds and replaces bytes, and a host that reads it in pieces of any size.
struct NoisyBus {
    std::vector<BoardLayout> boards;
    ReplyReader reader;
    spidar::test::CaseRandom random;
    std::vector<Counts> counts;
    std::vector<std::deque<Counts>> sent; // newest in front, of each board
    std::uint64_t asked = 0;
    std::uint64_t now_us = 1000;
    std::uint64_t wire_bytes = 0;
    std::uint64_t damaged_rounds = 0;
    int clean_rounds = 0; // in a row, without one that was believed
    int worst_resync = 0;
    Bytes pending; // on their way to the host

    NoisyBus(std::vector<BoardLayout> boards_in, std::uint64_t seed, bool at_rest_in)
        : boards(std::move(boards_in)), random(1, seed), counts(boards.size()), sent(boards.size()),
          at_rest(at_rest_in) {
        reader.configure(boards, {});
    }
    bool at_rest;

    int below(int bound) { return static_cast<int>(random.between(0.0, bound)); }

    Bytes round() {
        Bytes bytes;
        for (std::size_t b = 0; b < boards.size(); ++b) {
            Counts speeds{};
            for (std::size_t m = 0; m < boards[b].motors(); ++m) {
                const int step = at_rest ? below(3) - 1 : below(160) - 80;
                counts[b][m] += step;
                speeds[m] = static_cast<std::int32_t>(step * 1000.0 / boards[b].control_rate_hz());
                if (at_rest && std::abs(counts[b][m]) > 20) {
                    counts[b][m] = 0;
                }
            }
            sent[b].push_front(counts[b]);
            sent[b].resize(std::min<std::size_t>(sent[b].size(), 5));
            const Bytes reply = reply_of(boards[b], counts[b], speeds);
            bytes.insert(bytes.end(), reply.begin(), reply.end());
        }
        return bytes;
    }

    void damage(Bytes &bytes) {
        const auto at = static_cast<std::ptrdiff_t>(below(static_cast<int>(bytes.size())));
        switch (below(5)) {
        case 0: // one byte lost: all behind it is shifted
            bytes.erase(bytes.begin() + at);
            break;
        case 1: { // several lost
            const auto end = std::min<std::ptrdiff_t>(at + 1 + below(30), std::ssize(bytes));
            bytes.erase(bytes.begin() + at, bytes.begin() + end);
            break;
        }
        case 2: // cut short
            bytes.resize(static_cast<std::size_t>(at));
            break;
        case 3: // garbage between, headers among it
            for (int i = below(40); i >= 0; --i) {
                const bool header = below(4) == 0;
                bytes.insert(bytes.begin() + at,
                             header ? board_header(BoardCommand::current, boards[0].id)
                                    : static_cast<std::uint8_t>(below(256)));
            }
            break;
        default: // garbage in place of what was sent
            for (auto &byte : bytes) {
                byte = static_cast<std::uint8_t>(below(256));
            }
            break;
        }
    }

    void check_believed() {
        for (std::size_t b = 0; b < boards.size(); ++b) {
            bool was_sent = false;
            for (const Counts &one : sent[b]) {
                bool same = true;
                for (std::size_t m = 0; m < boards[b].motors(); ++m) {
                    same = same && reader.count(b, m) == one[m];
                }
                was_sent = was_sent || same;
            }
            REQUIRE(was_sent);
        }
    }

    void step(double damage_share) {
        ++asked;
        Bytes bytes = round();
        const bool damaged = random.between(0.0, 1.0) < damage_share;
        if (damaged) {
            damage(bytes);
            ++damaged_rounds;
        }
        wire_bytes += bytes.size();
        pending.insert(pending.end(), bytes.begin(), bytes.end());
        now_us += kRound_us;
        // A bridge may keep the end of what it has for the next packet.
        const int kept = below(3) == 0 ? below(static_cast<int>(pending.size()) + 1) : 0;
        const auto end = pending.end() - std::min<std::ptrdiff_t>(kept, 40);
        const int rounds = reader.take(Bytes(pending.begin(), end), asked, now_us);
        pending.erase(pending.begin(), end);
        if (rounds > 0) {
            check_believed();
        }
        clean_rounds = damaged || rounds > 0 ? 0 : clean_rounds + 1;
        worst_resync = std::max(worst_resync, clean_rounds);
    }
};

} // namespace

TEST_CASE("reply reader: a million bytes of a noisy wire, and nothing believed that was not sent") {
    const std::vector<std::vector<BoardLayout>> buses = {
        {kB5m},
        {{1, kB3m.info, 0}, {2, kB3m.info, 0}},
        {{0, kB5m.info, 0}, {3, kB3m.info, 0}, {7, kB3m.info, 0}}};
    std::uint64_t bytes = 0;
    std::uint64_t seed = 1;
    for (const auto &boards : buses) {
        for (const bool at_rest : {false, true}) {
            NoisyBus bus(boards, ++seed, at_rest);
            while (bus.wire_bytes < 200'000) {
                bus.step(0.2);
            }
            bytes += bus.wire_bytes;
            const ReplyCounters &seen = bus.reader.counters();
            MESSAGE(boards.size() << " boards"
                                  << std::string(at_rest ? " at rest: " : " in motion: ")
                                  << bus.asked << " rounds, " << bus.damaged_rounds << " damaged, "
                                  << seen.rounds << " believed; worst resync " << bus.worst_resync
                                  << " ms");
            CHECK(bus.worst_resync <= 20);
            CHECK(3 * seen.rounds >= bus.asked);
            CHECK(seen.rounds < bus.asked);
            CHECK(seen.in_pieces > 0);
            CHECK(seen.passed_over > 0);
            CHECK(seen.garbage_bytes > 0);
            CHECK(bus.reader.lost(bus.asked) > 0);
        }
    }
    CHECK(bytes >= 1'000'000);
}

TEST_CASE("reply reader: from garbage alone nothing is ever believed") {
    spidar::test::CaseRandom random(7, 0);
    const BoardLayout boards[] = {kB5m};
    ReplyReader reader;
    reader.configure(boards, {});
    const std::uint8_t header = board_header(BoardCommand::current, kB5m.id);
    std::uint64_t asked = 0;
    for (int i = 0; i < 25'000; ++i) {
        Bytes bytes(41);
        for (auto &byte : bytes) {
            byte = random.between(0.0, 1.0) < 0.1
                       ? header
                       : static_cast<std::uint8_t>(random.between(0, 256));
        }
        bytes[0] = header;
        ++asked;
        REQUIRE(reader.take(bytes, asked, 1000 * asked) == 0);
    }
    CHECK(reader.counters().replies == 0);
    CHECK(reader.counters().bytes == 25'000 * 41);
}
