// Sends a question to one board and reads the answer. Requires that nobody else uses the port.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "device/serial/protocol/board_codec.h"
#include "device/serial/serial_port.h"

namespace spidar {

// Longest wait for an answer (unit: ms). A board needs less than 1 ms; a busy computer adds more.
inline constexpr int kAnswer_ms = 10;
// Time limit of a write (unit: ms).
inline constexpr int kWrite_ms = 50;

// Returns "B5M with id 1".
[[nodiscard]] std::string name_of(const BoardLayout &board);

// Returns the bytes that arrive within time_ms. Returns earlier once there are `enough` bytes, or
// when the port is gone.
[[nodiscard]] std::vector<std::uint8_t> listen(SerialPort &port, std::size_t enough, int time_ms);
// Discards received bytes, at most 16 KiB.
void forget_input(SerialPort &port);

// Reads the first four bytes of a parameter as a number. Asks twice, since a board answers with the
// parameter of the previous question. Returns false when three such attempts bring no answer.
[[nodiscard]] bool read_parameter(SerialPort &port, const BoardLayout &board,
                                  BoardParameter parameter, std::uint32_t &value);

} // namespace spidar
