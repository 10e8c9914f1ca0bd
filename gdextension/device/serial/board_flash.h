// Numbers in the flash of motor boards: read, and changed one at a time. Only this file sends
// SET_PARAM. Each call opens the port exclusively and closes it again, so that no motor can be
// armed meanwhile.
#pragma once

#include <atomic>
#include <cstdint>
#include <string>
#include <vector>

#include "device/serial/protocol/board_layout.h"

#include "core/base/status.h"

namespace spidar {

struct BoardFlash {
    BoardLayout board; // with the id under which it answers
    std::uint8_t stored_id = 0;
    std::uint32_t quadrature_mask = 0; // bit i: motor i has a quadrature encoder
};

// A change of one number of one board. `board` is as read_board_flash() returned it for this port.
struct FlashChange {
    std::string port;
    BoardFlash board;
    BoardParameter parameter = BoardParameter::quadrature_mask; // or board_id
    std::uint32_t value = 0;
};

// Returns "B5M with id 1 at /dev/ttyUSB0".
[[nodiscard]] std::string exact_name(const FlashChange &change);
// Returns the number that the change is about, as it was read.
[[nodiscard]] std::uint32_t value_before(const FlashChange &change) noexcept;
// Empty when the change may be written, else one sentence. all: boards of the bus, as read.
[[nodiscard]] std::string validate(const FlashChange &change, const std::vector<BoardFlash> &all);
// Returns "quadrature mask 0x00 becomes 0xff".
[[nodiscard]] std::string describe(const FlashChange &change);

// Reads all boards; takes half a second. Returns the statuses of open_session(), and device_in_use
// for a port that this process owns. give_up: another thread may set it to end the call early.
[[nodiscard]] Status read_board_flash(const std::string &port, std::uint32_t baud,
                                      const std::atomic<bool> &give_up,
                                      std::vector<BoardFlash> &boards, std::string &problem);
// Reads all boards again, writes once when they are unchanged, reads back and compares.
// invalid_settings: nothing was written. protocol_mismatch: written, but the board holds another
// value or does not answer. after: the board's values afterwards.
[[nodiscard]] Status write_board_flash(const FlashChange &change, std::uint32_t baud,
                                       const std::atomic<bool> &give_up, BoardFlash &after,
                                       std::string &problem);

} // namespace spidar
