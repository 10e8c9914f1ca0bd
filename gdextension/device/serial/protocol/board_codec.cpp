#include "device/serial/protocol/board_codec.h"

namespace spidar {

namespace {

constexpr std::size_t kInfoReply = 7;
constexpr std::size_t kHandshakeZerosBefore = 40;
constexpr std::size_t kHandshakeZerosBehind = 26;
constexpr std::int16_t kResetMotors = 1;
constexpr std::int16_t kResetForces = 2;

void append_header(BoardFrame &frame, const BoardLayout &board, BoardCommand command) noexcept {
    frame.byte(board_header(command, board.id));
}

void append_padding(BoardFrame &frame, const BoardLayout &board, BoardCommand command) noexcept {
    frame.zeros(padding(board, command));
}

} // namespace

void append_info(BoardFrame &frame, std::uint8_t id) noexcept {
    frame.zeros(kHandshakeZerosBefore);
    frame.byte(board_header(BoardCommand::info, id));
    frame.zeros(kHandshakeZerosBehind);
}

void append_command_lengths(BoardFrame &frame, const BoardLayout &board) noexcept {
    append_header(frame, board, BoardCommand::set_command_lengths);
    for (std::size_t i = 0; i < kBoardCommandCount; ++i) {
        const auto length = command_length(board, static_cast<BoardCommand>(i));
        frame.byte(static_cast<std::uint8_t>(length));
    }
    append_padding(frame, board, BoardCommand::set_command_lengths);
}

void append_current(BoardFrame &frame, const BoardLayout &board,
                    const BoardCurrents &currents) noexcept {
    append_header(frame, board, BoardCommand::current);
    for (std::size_t i = 0; i < board.motors(); ++i) {
        frame.word(currents[i]);
    }
    append_padding(frame, board, BoardCommand::current);
}

void append_get_parameter(BoardFrame &frame, const BoardLayout &board,
                          BoardParameter parameter) noexcept {
    append_header(frame, board, BoardCommand::get_parameter);
    frame.byte(static_cast<std::uint8_t>(parameter));
    append_padding(frame, board, BoardCommand::get_parameter);
}

void append_set_parameter(BoardFrame &frame, const BoardLayout &board, BoardParameter parameter,
                          BoardBytes data) noexcept {
    const std::size_t room = command_length(board, BoardCommand::set_parameter) - 2;
    if (data.size() > room) {
        frame.spoil();
        return;
    }
    append_header(frame, board, BoardCommand::set_parameter);
    frame.byte(static_cast<std::uint8_t>(parameter));
    for (const std::uint8_t value : data) {
        frame.byte(value);
    }
    frame.zeros(room - data.size());
    append_padding(frame, board, BoardCommand::set_parameter);
}

void append_reset(BoardFrame &frame, const BoardLayout &board, bool motors, bool forces) noexcept {
    append_header(frame, board, BoardCommand::reset);
    frame.word(
        static_cast<std::int16_t>((motors ? kResetMotors : 0) | (forces ? kResetForces : 0)));
    append_padding(frame, board, BoardCommand::reset);
}

bool decode_info(BoardBytes bytes, std::uint8_t id, BoardInfo &info) noexcept {
    if (bytes.size() != kInfoReply || bytes[0] != board_header(BoardCommand::info, id)) {
        return false;
    }
    const BoardInfo read{bytes[1], bytes[2], bytes[3], bytes[4], bytes[5], bytes[6]};
    if (!is_plausible(read)) {
        return false;
    }
    info = read;
    return true;
}

bool decode_parameter(BoardBytes bytes, const BoardLayout &board, BoardParameter parameter,
                      BoardBytes &data) noexcept {
    data = {};
    if (bytes.size() != reply_length(board, BoardCommand::get_parameter) ||
        bytes[0] != board_header(BoardCommand::get_parameter, board.id) ||
        bytes[1] != static_cast<std::uint8_t>(parameter)) {
        return false;
    }
    data = bytes.subspan(2);
    return true;
}

} // namespace spidar
