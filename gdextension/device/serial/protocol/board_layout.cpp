#include "device/serial/protocol/board_layout.h"

namespace spidar {

namespace {

constexpr std::array<const char *, 8> kNames = {"unknown board", "B1M", "B1F", "B2M",
                                                "B2F",           "B3M", "B3F", "B5M"};
constexpr std::size_t kHeader = 1;
constexpr std::size_t kWord = 2;
constexpr std::size_t kPeriodAndCount = 3; // u16 and u8
constexpr std::size_t kInfoPayload = 6;
constexpr std::size_t kLeastPadding = 5;
constexpr std::size_t kPaddingBeyondReply = 20;
constexpr int kMostChannels = 100; // more is not a board

} // namespace

const char *name_of_model(std::uint8_t model) noexcept {
    return kNames[model < kNames.size() ? model : 0];
}

std::size_t command_length(const BoardLayout &board, BoardCommand command) noexcept {
    const std::size_t motors = kWord * board.info.motors;
    const std::size_t jacobian = motors * board.info.forces;
    switch (command) {
    case BoardCommand::none:
    case BoardCommand::info:
    case BoardCommand::sensor:
        return kHeader;
    case BoardCommand::set_command_lengths:
        return kHeader + kBoardCommandCount;
    case BoardCommand::all:
        return kHeader + 1 + motors + std::max(motors, jacobian) + kPeriodAndCount;
    case BoardCommand::direct:
        return kHeader + 2 * motors;
    case BoardCommand::current:
        return kHeader + motors;
    case BoardCommand::interpolate:
        return kHeader + motors + kPeriodAndCount;
    case BoardCommand::force_control:
        return kHeader + motors + jacobian + kPeriodAndCount;
    case BoardCommand::set_parameter:
        return kHeader + 1 + 2 * motors;
    case BoardCommand::reset:
        return kHeader + kWord;
    case BoardCommand::get_parameter:
        return kHeader + 1;
    }
    return 0;
}

std::size_t reply_length(const BoardLayout &board, BoardCommand command) noexcept {
    const std::size_t motors = kWord * board.info.motors;
    const std::size_t forces = kWord * board.info.forces;
    switch (command) {
    case BoardCommand::info:
        return kHeader + kInfoPayload;
    case BoardCommand::sensor:
        return kHeader + motors + kWord * board.info.currents + forces;
    case BoardCommand::direct:
        return kHeader + 2 * motors;
    case BoardCommand::current:
        return kHeader + 2 * motors + forces + kWord * board.extra_words;
    case BoardCommand::get_parameter:
        return kHeader + 1 + 2 * motors;
    case BoardCommand::none:
    case BoardCommand::all:
    case BoardCommand::interpolate:
    case BoardCommand::force_control: // not used here
    case BoardCommand::set_command_lengths:
    case BoardCommand::set_parameter:
    case BoardCommand::reset:
        return 0;
    }
    return 0;
}

std::size_t padding(const BoardLayout &board, BoardCommand command) noexcept {
    const std::size_t reply = reply_length(board, command) + kPaddingBeyondReply;
    const std::size_t sent = command_length(board, command);
    return reply > sent + kLeastPadding ? reply - sent : kLeastPadding;
}

bool is_plausible(const BoardInfo &info) noexcept {
    const int channels = info.motors + info.currents + info.forces;
    return info.model > 0 && info.model < kNames.size() && channels < kMostChannels &&
           info.motors > 0 && info.motors <= kMostBoardMotors && info.forces <= kMostBoardMotors;
}

} // namespace spidar
