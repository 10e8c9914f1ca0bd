#include "device/serial/board_talk.h"

#include <array>

#include "device/threads/real_time_thread.h"

namespace spidar {

namespace {

constexpr std::int64_t kNanosecondsPerMillisecond = 1'000'000;
constexpr int kTries = 3;

// Accepts complete answers only.
std::vector<std::uint8_t> ask_parameter(SerialPort &port, const BoardLayout &board,
                                        BoardParameter parameter) {
    BoardFrame frame;
    append_get_parameter(frame, board, parameter);
    forget_input(port);
    if (!port.write(frame.bytes(), kWrite_ms)) {
        return {};
    }
    const std::size_t length = reply_length(board, BoardCommand::get_parameter);
    std::vector<std::uint8_t> heard = listen(port, length, kAnswer_ms);
    heard.resize(heard.size() >= length ? length : 0);
    return heard;
}

} // namespace

std::string name_of(const BoardLayout &board) {
    return std::string(name_of_model(board.info.model)) + " with id " + std::to_string(board.id);
}

// Returns all bytes that arrive within time_ms; returns earlier after `enough` bytes.
std::vector<std::uint8_t> listen(SerialPort &port, std::size_t enough, int time_ms) {
    std::vector<std::uint8_t> heard;
    const std::int64_t end_ns = monotonic_ns() + time_ms * kNanosecondsPerMillisecond;
    std::array<std::uint8_t, 256> bytes{};
    for (std::int64_t now_ns = monotonic_ns(); now_ns < end_ns && heard.size() < enough;
         now_ns = monotonic_ns()) {
        const int count = port.read(bytes, 1);
        if (count < 0) {
            break;
        }
        heard.insert(heard.end(), bytes.begin(), bytes.begin() + count);
    }
    return heard;
}

void forget_input(SerialPort &port) {
    std::array<std::uint8_t, 256> bytes{};
    for (int i = 0; i < 64 && port.read(bytes, 0) > 0; ++i) {
    }
}

bool read_parameter(SerialPort &port, const BoardLayout &board, BoardParameter parameter,
                    std::uint32_t &value) {
    for (int i = 0; i < kTries; ++i) {
        (void)ask_parameter(port, board, parameter); // discards the previous parameter
        const std::vector<std::uint8_t> heard = ask_parameter(port, board, parameter);
        BoardBytes data;
        if (!decode_parameter(heard, board, parameter, data)) {
            continue;
        }
        value = 0;
        for (std::size_t byte = 0; byte < sizeof(value); ++byte) {
            value |= std::uint32_t{data[byte]} << 8U * byte;
        }
        return true;
    }
    return false;
}

} // namespace spidar
