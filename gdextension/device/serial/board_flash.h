// What motor boards keep in their flash: read, and changed one number at a time. Only here is SET_PARAM sent. Each call opens
// the port for itself alone, so that no motor is armed meanwhile, and closes it again.
#pragma once

#include <atomic>
#include <cstdint>
#include <string>
#include <vector>

#include "device/serial/protocol/board_layout.h"

#include "core/base/status.h"

namespace spidar {

struct BoardFlash {
    BoardLayout board; // under the id at which it answers
    std::uint8_t stored_id = 0;
    std::uint32_t quadrature_mask = 0; // bit i: motor i is read by its quadrature encoder
};

// One number of one board. `board` is as read_board_flash() told it, on this port.
struct FlashChange {
    std::string port;
    BoardFlash board;
    BoardParameter parameter = BoardParameter::quadrature_mask; // or board_id
    std::uint32_t value = 0;
};

// "B5M with id 1 at /dev/ttyUSB0".
[[nodiscard]] std::string exact_name(const FlashChange &change);
// Of the number that the change is about, as it was read.
[[nodiscard]] std::uint32_t value_before(const FlashChange &change) noexcept;
// Empty when it may be written; else one sentence. `all`: the boards of the bus, as they were read.
[[nodiscard]] std::string validate(const FlashChange &change, const std::vector<BoardFlash> &all);
// "quadrature mask 0x00 becomes 0xff".
[[nodiscard]] std::string describe(const FlashChange &change);

// Takes half a second. Statuses as open_session(), and device_in_use for a port that this process owns. `give_up`: set by
// another thread, ends it early.
[[nodiscard]] Status read_board_flash(const std::string &port, std::uint32_t baud,
                                      const std::atomic<bool> &give_up,
                                      std::vector<BoardFlash> &boards, std::string &problem);
// Reads all boards again, writes once when they are as the change says they were, reads back and compares. invalid_settings:
// nothing was written. protocol_mismatch: written, and the board holds something else, or does not tell. `after`: what it
// holds then.
[[nodiscard]] Status write_board_flash(const FlashChange &change, std::uint32_t baud,
                                       const std::atomic<bool> &give_up, BoardFlash &after,
                                       std::string &problem);

} // namespace spidar
