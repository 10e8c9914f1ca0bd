// The simulated board keeps to the rules of the real one, so that a host which breaks them fails here.
#include <doctest/doctest.h>

#include <vector>

#include "board_model/board_firmware.h"
#include "device/serial/protocol/board_codec.h"

using namespace spidar;
using spidar::test::BoardFirmware;
using Bytes = std::vector<std::uint8_t>;

namespace {

constexpr BoardLayout kB3m{2, {5, 3, 4, 4, 0, 0}, 0};
constexpr BoardLayout kB5m{1, {7, 3, 8, 0, 4, 0}, 0};

Bytes hear(BoardFirmware &board, BoardBytes bytes) {
    Bytes answer;
    for (const std::uint8_t byte : bytes) {
        board.hear(byte, answer);
    }
    return answer;
}

template <typename Append>
Bytes ask(BoardFirmware &board, const Append &append) {
    BoardFrame frame;
    append(frame);
    REQUIRE(frame.whole());
    return hear(board, frame.bytes());
}

} // namespace

TEST_SUITE_BEGIN("quick");

TEST_CASE("simulated board: INFO is answered when it is padded, else never") {
    BoardFirmware board(kB5m);
    const std::uint8_t alone[] = {board_header(BoardCommand::info, 1)};
    CHECK(hear(board, alone).empty());
    const Bytes answer = ask(board, [](BoardFrame &frame) { append_info(frame, 1); });
    BoardInfo info;
    REQUIRE(answer.size() >= 7);
    CHECK(decode_info(BoardBytes(answer).last(7), 1, info));
    CHECK(info == kB5m.info);
    CHECK(ask(board, [](BoardFrame &frame) { append_info(frame, 4); }).empty());
}

TEST_CASE(
    "simulated board: the reply is made before the command is carried out, and holds it for ever") {
    BoardFirmware board(kB5m);
    for (std::size_t i = 0; i < 8; ++i) {
        board.turn(i, 100 * static_cast<std::int32_t>(i) - 70'000, 0.0);
    }
    const BoardCurrents wanted{1, -2, 3, -4, 5, -6, 7, 1000};
    const Bytes answer =
        ask(board, [&](BoardFrame &frame) { append_current(frame, kB5m, wanted); });
    REQUIRE(answer.size() == 41);
    CHECK(answer[0] == 0x31);
    CHECK(answer[1] == (-70'000 & 0xFF));
    CHECK(answer[2] == ((-70'000 >> 8) & 0xFF));
    CHECK(board.currents() == wanted);
    hear(board, Bytes(100'000, 0));
    CHECK(board.currents() == wanted);
    CHECK(board.cut_replies() == 0);
}

TEST_CASE("simulated board: GET_PARAM answers with what was asked for before") {
    BoardFirmware board(kB3m);
    board.quadrature_mask = 0x0F;
    const auto get = [&] {
        return ask(board, [](BoardFrame &frame) {
            append_get_parameter(frame, kB3m, BoardParameter::quadrature_mask);
        });
    };
    const Bytes first = get();
    const Bytes second = get();
    BoardBytes data;
    CHECK(!decode_parameter(first, kB3m, BoardParameter::quadrature_mask, data));
    REQUIRE(decode_parameter(second, kB3m, BoardParameter::quadrature_mask, data));
    CHECK(data[0] == 0x0F);
}

TEST_CASE("simulated board: a bus of two kinds needs the lengths of the other's commands") {
    BoardFirmware b3m(kB3m);
    const auto current_of_b5m = [](BoardFrame &frame) {
        append_current(frame, kB5m,
                       {0x3232, 0x3232, 0x3232, 0x3232, 0x3232, 0x3232, 0x3232, 0x3232});
    };
    // The B3M takes the second half of a B5M's command for one of its own: 0x32 is its header.
    (void)ask(b3m, current_of_b5m);
    CHECK(b3m.executed(BoardCommand::current) > 0);
    const std::uint64_t before = b3m.executed(BoardCommand::current);
    hear(b3m, Bytes(kResyncZeros, 0));
    (void)ask(b3m, [](BoardFrame &frame) { append_command_lengths(frame, kB5m); });
    (void)ask(b3m, current_of_b5m);
    CHECK(b3m.executed(BoardCommand::current) == before);
}

TEST_CASE("simulated board: zeros bring it back from the middle of a command") {
    BoardFirmware board(kB5m);
    const std::uint8_t half[] = {0x31, 9, 9, 9, 9, 9};
    hear(board, half);
    hear(board, Bytes(kResyncZeros, 0));
    const BoardCurrents wanted{5, 5, 5, 5, 5, 5, 5, 5};
    (void)ask(board, [&](BoardFrame &frame) { append_current(frame, kB5m, wanted); });
    CHECK(board.currents() == wanted);
}

TEST_CASE("simulated board: only quadrature counts, and interrupts lose some at speed") {
    BoardFirmware board(kB5m);
    board.quadrature_mask = 0x03;
    board.sure_counts_s = 50'000.0;
    board.lost_share = 0.1;
    const auto position_of = [&](std::size_t motor) {
        const Bytes answer = ask(board, [](BoardFrame &frame) { append_current(frame, kB5m, {}); });
        REQUIRE(answer.size() == 41);
        return answer[1 + 2 * motor] | answer[2 + 2 * motor] << 8;
    };
    for (std::size_t i = 0; i < 8; ++i) {
        board.turn(i, 1000, 100'000.0);
    }
    CHECK(position_of(0) == 1000);
    CHECK(position_of(2) == 0);
    board.quadrature_mask = 0xFF;
    for (std::size_t i = 0; i < 8; ++i) {
        board.turn(i, 2000, 100'000.0);
    }
    CHECK(position_of(7) == 2000);
    CHECK(position_of(2) == 1800);
    board.restart();
    CHECK(position_of(0) == 0);
}

TEST_SUITE_END();
