// The bytes of the motor boards' protocol against the table of docs/reference/serial_boards.md.
#include <doctest/doctest.h>

#include <vector>

#include "device/serial/protocol/board_codec.h"
#include "device/serial/protocol/wire_rate.h"

using namespace spidar;

namespace {

constexpr BoardLayout kB3m{2, {5, 3, 4, 4, 0, 0}, 0};
constexpr BoardLayout kB5m{1, {7, 3, 8, 0, 4, 0}, 0};

std::vector<int> numbers(const BoardFrame &frame) {
    return {frame.bytes().begin(), frame.bytes().end()};
}

std::vector<int> with_zeros(std::vector<int> bytes, std::size_t zeros) {
    bytes.insert(bytes.end(), zeros, 0);
    return bytes;
}

} // namespace

TEST_CASE("serial boards: lengths of commands and replies are those of the table") {
    struct Row {
        BoardCommand command;
        std::size_t b3m, b3m_reply, b5m, b5m_reply;
    };
    const Row rows[] = {
        {BoardCommand::info, 1, 7, 1, 7},       {BoardCommand::set_command_lengths, 13, 0, 13, 0},
        {BoardCommand::sensor, 1, 17, 1, 25},   {BoardCommand::direct, 17, 17, 33, 33},
        {BoardCommand::current, 9, 17, 17, 41}, {BoardCommand::set_parameter, 18, 0, 34, 0},
        {BoardCommand::reset, 3, 0, 3, 0},      {BoardCommand::get_parameter, 2, 18, 2, 34},
    };
    for (const Row &row : rows) {
        CAPTURE(static_cast<int>(row.command));
        CHECK(command_length(kB3m, row.command) == row.b3m);
        CHECK(reply_length(kB3m, row.command) == row.b3m_reply);
        CHECK(command_length(kB5m, row.command) == row.b5m);
        CHECK(reply_length(kB5m, row.command) == row.b5m_reply);
    }
    // Commands that are never sent, but whose lengths every board of a bus must know.
    CHECK(command_length(kB3m, BoardCommand::all) == 21);
    CHECK(command_length(kB5m, BoardCommand::all) == 85);
    CHECK(command_length(kB3m, BoardCommand::interpolate) == 12);
    CHECK(command_length(kB5m, BoardCommand::interpolate) == 20);
    CHECK(command_length(kB3m, BoardCommand::force_control) == 12);
    CHECK(command_length(kB5m, BoardCommand::force_control) == 84);
}

TEST_CASE("serial boards: a build that adds its currents to the reply has a longer one") {
    BoardLayout board = kB3m;
    board.extra_words = 4;
    CHECK(reply_length(board, BoardCommand::current) == 25);
    CHECK(padding(board, BoardCommand::current) == 36);
}

TEST_CASE("serial boards: zeros behind a command") {
    CHECK(padding(kB3m, BoardCommand::current) == 28);
    CHECK(padding(kB5m, BoardCommand::current) == 44);
    CHECK(padding(kB3m, BoardCommand::set_parameter) == 5);
    CHECK(padding(kB5m, BoardCommand::get_parameter) == 52);
    CHECK(padding(kB5m, BoardCommand::reset) == 17);
}

TEST_CASE("serial boards: commands as bytes") {
    BoardFrame frame;
    append_info(frame, 3);
    std::vector<int> wanted(40, 0);
    wanted.push_back(0x0B);
    CHECK(numbers(frame) == with_zeros(wanted, 26));

    frame.clear();
    append_current(frame, kB3m, {1, -1, 300, -300});
    CHECK(numbers(frame) == with_zeros({0x32, 0x01, 0x00, 0xFF, 0xFF, 0x2C, 0x01, 0xD4, 0xFE}, 28));

    frame.clear();
    append_command_lengths(frame, kB5m);
    CHECK(numbers(frame) == with_zeros({0x11, 1, 1, 13, 85, 1, 33, 17, 20, 84, 34, 3, 2}, 7));

    frame.clear();
    append_get_parameter(frame, kB5m, BoardParameter::quadrature_mask);
    CHECK(numbers(frame) == with_zeros({0x59, 7}, 52));

    frame.clear();
    const std::array<std::uint8_t, 4> mask{0xFF, 0, 0, 0};
    append_set_parameter(frame, kB3m, BoardParameter::quadrature_mask, mask);
    CHECK(numbers(frame) == with_zeros({0x4A, 7, 0xFF, 0, 0, 0}, 12 + 5));

    frame.clear();
    append_reset(frame, kB3m, true, false);
    CHECK(numbers(frame) == with_zeros({0x52, 1, 0}, 17));
}

TEST_CASE("serial boards: what does not fit is not sent by half") {
    BoardFrame frame;
    const std::array<std::uint8_t, 17> too_long{};
    append_set_parameter(frame, kB3m, BoardParameter::pwm_period, too_long);
    CHECK(!frame.whole());
    frame.clear();
    CHECK(frame.whole());
    frame.zeros(BoardFrame::kCapacity);
    CHECK(frame.whole());
    frame.byte(1);
    CHECK(!frame.whole());
}

TEST_CASE("serial boards: INFO is believed only of a board that can be") {
    BoardInfo info;
    const std::array<std::uint8_t, 7> good{0x0A, 5, 3, 4, 4, 0, 0};
    CHECK(decode_info(good, 2, info));
    CHECK(info == kB3m.info);
    CHECK(!decode_info(good, 3, info));
    CHECK(!decode_info(BoardBytes(good).first(6), 2, info));
    for (const auto &[at, value] : {std::pair{1, 0}, {1, 8}, {3, 0}, {3, 9}, {4, 96}, {5, 9}}) {
        std::array<std::uint8_t, 7> bad = good;
        bad[static_cast<std::size_t>(at)] = static_cast<std::uint8_t>(value);
        CAPTURE(at);
        CHECK(!decode_info(bad, 2, info));
    }
}

TEST_CASE("serial boards: a parameter is read by its number") {
    std::array<std::uint8_t, 18> reply{0x5A, 7, 0x0F, 0, 0, 0};
    BoardBytes data;
    CHECK(decode_parameter(reply, kB3m, BoardParameter::quadrature_mask, data));
    CHECK(data.size() == 16);
    CHECK(data[0] == 0x0F);
    CHECK(!decode_parameter(reply, kB3m, BoardParameter::pwm_period, data));
    CHECK(data.empty());
}

TEST_CASE("serial boards: the highest rate that the wire allows") {
    const BoardLayout one[] = {kB5m};
    CHECK(round_bytes(one) == 61);
    CHECK(round_time_s(one, kBoardBaud) == doctest::Approx(305e-6));
    CHECK(highest_rate_hz(one, kBoardBaud) == doctest::Approx(2950.8).epsilon(1e-4));
    const BoardLayout two[] = {kB3m, kB3m};
    CHECK(round_time_s(two, kBoardBaud) == doctest::Approx(370e-6));
    const std::vector<BoardLayout> eight(8, kB3m);
    CHECK(highest_rate_hz(eight, kBoardBaud) == doctest::Approx(608.1).epsilon(1e-4));
    CHECK(highest_rate_hz({}, kBoardBaud) == 0.0);
    BoardFrame frame;
    for (int i = 0; i < 8; ++i) {
        append_current(frame, kB5m, {});
    }
    CHECK(frame.whole());
}
