// Reads the id and the quadrature mask that motor boards keep in flash memory, and changes one of
// these numbers. No other code sends SET_PARAM. read_board_flash() and write_board_flash() open the
// port exclusively and close it again, so that no program can arm the motors meanwhile.
#pragma once

#include <atomic>
#include <cstdint>
#include <string>
#include <vector>

#include "device/serial/protocol/board_layout.h"

#include "core/base/status.h"

namespace spidar {

struct BoardFlash {
    BoardLayout board;                 // with the id under which the board answers
    std::uint8_t stored_id = 0;        // id in the flash memory
    std::uint32_t quadrature_mask = 0; // bit i: motor i has a quadrature encoder
};

// A change of one number of one board. `board` must be a result of read_board_flash() for `port`.
struct FlashChange {
    std::string port;
    BoardFlash board;
    BoardParameter parameter = BoardParameter::quadrature_mask; // or board_id
    std::uint32_t value = 0;
};

// Returns "B5M with id 1 at /dev/ttyUSB0".
[[nodiscard]] std::string exact_name(const FlashChange &change);
// Returns the value that the number to be changed had when the board was read.
[[nodiscard]] std::uint32_t value_before(const FlashChange &change) noexcept;
// Returns an empty string if the change may be written, else one sentence. all: boards of the bus,
// as read.
[[nodiscard]] std::string validate(const FlashChange &change, const std::vector<BoardFlash> &all);
// Returns "quadrature mask 0x00 becomes 0xff".
[[nodiscard]] std::string describe(const FlashChange &change);

// Reads all boards of the bus. Blocks while it asks them. Returns a status of open_session(), or
// device_in_use if this process has claimed the port. give_up: another thread may set it to end the
// call early.
[[nodiscard]] Status read_board_flash(const std::string &port, std::uint32_t baud,
                                      const std::atomic<bool> &give_up,
                                      std::vector<BoardFlash> &boards, std::string &problem);
// Reads all boards again, writes the number if the board is unchanged, reads it back and compares.
// Returns ok after a confirmed write. protocol_mismatch: the write failed, or the board then holds
// another value or does not answer. After any other status, nothing was written. after: the board's
// values after ok.
[[nodiscard]] Status write_board_flash(const FlashChange &change, std::uint32_t baud,
                                       const std::atomic<bool> &give_up, BoardFlash &after,
                                       std::string &problem);

} // namespace spidar
