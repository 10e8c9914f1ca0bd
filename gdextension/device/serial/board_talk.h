// One question to one board and its answer, while nobody else uses the port.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "device/serial/protocol/board_codec.h"
#include "device/serial/serial_port.h"

namespace spidar {

// Timeout of an answer (unit: ms). A board answers within 1 ms; a busy computer adds more.
inline constexpr int kAnswer_ms = 10;
// Time limit of a write (unit: ms).
inline constexpr int kWrite_ms = 50;

// Returns "B5M with id 1".
[[nodiscard]] std::string name_of(const BoardLayout &board);

// Returns all bytes that arrive within time_ms, or until there are `enough`.
[[nodiscard]] std::vector<std::uint8_t> listen(SerialPort &port, std::size_t enough, int time_ms);
// Discards all waiting input.
void forget_input(SerialPort &port);

// Reads the first four bytes of a parameter as a number. Asks twice, since a board answers with the
// parameter of the previous question. Returns false without an answer.
[[nodiscard]] bool read_parameter(SerialPort &port, const BoardLayout &board,
                                  BoardParameter parameter, std::uint32_t &value);

} // namespace spidar
