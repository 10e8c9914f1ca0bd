// One plug-in of a bus of boards: found by handshake, told each other's lengths, with no current on any motor.
#pragma once

#include <atomic>
#include <memory>
#include <string>
#include <vector>

#include "device/serial/protocol/board_codec.h"
#include "device/serial/serial_port.h"

namespace spidar {

struct BoardSession {
    std::shared_ptr<SerialPort> reader; // servo loop
    std::shared_ptr<SerialPort> writer; // writer thread
    std::string path;
    std::vector<BoardLayout> boards;             // in the order of their ids
    std::vector<std::uint32_t> quadrature_masks; // of each board
    double round_trip_s = 0.0; // median: all boards asked -> the last of their answers here
    std::string remarks;       // what works, but not as it should: one sentence each
};

// Finds the boards, ids 0 to 7 in turn; takes about 0.15 s. no_device, no_permission, device_in_use, open_failed,
// protocol_mismatch: nothing answers as a board does. `problem` is a sentence then, and nothing stays
// open. Ends early, with any of these, once another thread sets `give_up`.
[[nodiscard]] Status open_session(const std::string &path, std::uint32_t baud,
                                  const std::atomic<bool> &give_up, BoardSession &session,
                                  std::string &problem);

} // namespace spidar
