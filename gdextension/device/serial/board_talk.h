// One question to one board and its answer, while nobody else uses the port.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "device/serial/protocol/board_codec.h"
#include "device/serial/serial_port.h"

namespace spidar {

inline constexpr int kAnswer_ms =
    10; // a board answers within a millisecond; a busy computer hands it on later
inline constexpr int kWrite_ms = 50;

// "B5M with id 1".
[[nodiscard]] std::string name_of(const BoardLayout &board);

// Everything that comes within the time, or until there are `enough` bytes.
[[nodiscard]] std::vector<std::uint8_t> listen(SerialPort &port, std::size_t enough, int time_ms);
void forget_input(SerialPort &port);

// The first four bytes of a parameter as a number. Asks twice, as a board answers with the parameter that was asked for
// before. False: no answer.
[[nodiscard]] bool read_parameter(SerialPort &port, const BoardLayout &board,
                                  BoardParameter parameter, std::uint32_t &value);

} // namespace spidar
