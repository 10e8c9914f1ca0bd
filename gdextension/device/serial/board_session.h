// One plug-in of a bus of boards, found by a handshake. The boards know each other's command
// lengths, and no motor has current.
#pragma once

#include <atomic>
#include <memory>
#include <string>
#include <vector>

#include "device/serial/protocol/board_codec.h"
#include "device/serial/serial_port.h"

namespace spidar {

struct BoardSession {
    std::shared_ptr<SerialPort> reader; // used by the servo loop
    std::shared_ptr<SerialPort> writer; // used by the writer thread
    std::string path;
    std::vector<BoardLayout> boards;             // in the order of their ids
    std::vector<std::uint32_t> quadrature_masks; // one per board
    // Median time from asking all boards to the last answer.
    double round_trip_s = 0.0;
    std::string remarks; // problems that do not prevent operation, one sentence each
};

// Finds the boards by asking ids 0 to 7 in turn; takes about 0.15 s. Returns no_device,
// no_permission, device_in_use, open_failed or protocol_mismatch (nothing answers like a board),
// with a sentence in `problem` and the port closed. give_up: another thread may set it to end the
// call early.
[[nodiscard]] Status open_session(const std::string &path, std::uint32_t baud,
                                  const std::atomic<bool> &give_up, BoardSession &session,
                                  std::string &problem);

} // namespace spidar
