// The connection to a bus of boards, until the port is lost. A handshake finds the boards, tells
// them each other's command lengths, and sets all currents to zero.
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
    // Median time from a request to all boards to the last answer; 0: too few answers came.
    double round_trip_s = 0.0;
    std::string remarks; // problems that do not prevent operation, one sentence each
};

// Opens the port and finds the boards by asking ids 0 to 7 in turn, until two scans agree. Takes
// 10 ms for each id without a board. Returns ok, or no_device, no_permission, device_in_use,
// open_failed or protocol_mismatch (no board answers, or one does not answer CURRENT), with a
// sentence in `problem` and the port closed. give_up: another thread may set it to end the call
// early.
[[nodiscard]] Status open_session(const std::string &path, std::uint32_t baud,
                                  const std::atomic<bool> &give_up, BoardSession &session,
                                  std::string &problem);

} // namespace spidar
