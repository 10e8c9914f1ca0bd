#include "device/serial/board_session.h"

#include <algorithm>

#include "device/serial/board_talk.h"
#include "device/threads/real_time_thread.h"

namespace spidar {

namespace {

constexpr int kTries = 3;
constexpr int kScans = 4;
constexpr int kRoundTrips = 15;
constexpr int kSlowestRoundTrip_ms = 40; // more than twice that of a bridge with a long timer

bool find_board(SerialPort &port, std::uint8_t id, BoardLayout &board) {
    BoardFrame frame;
    append_info(frame, id);
    forget_input(port);
    if (!port.write(frame.bytes(), kWrite_ms)) {
        return false;
    }
    const std::size_t length = reply_length(board, BoardCommand::info);
    const auto heard = listen(port, length, kAnswer_ms);
    board.id = id;
    // The line may have been idle or noisy before: the reply is searched for.
    for (std::size_t at = 0; at + length <= heard.size(); ++at) {
        if (decode_info(BoardBytes(heard).subspan(at, length), id, board.info)) {
            return true;
        }
    }
    return false;
}

// Some firmware appends the currents to CURRENT's reply. The length of a reply to zero currents
// shows it.
bool measure_reply(SerialPort &port, BoardLayout &board) {
    const std::size_t usual = reply_length(board, BoardCommand::current);
    BoardLayout longer = board;
    longer.extra_words = board.info.motors;
    const std::size_t with_currents = reply_length(longer, BoardCommand::current);
    for (int i = 0; i < kTries; ++i) {
        BoardFrame frame;
        append_current(frame, longer, {});
        forget_input(port);
        if (!port.write(frame.bytes(), kWrite_ms)) {
            return false;
        }
        const auto heard = listen(port, with_currents, kAnswer_ms);
        const bool begins =
            !heard.empty() && heard[0] == board_header(BoardCommand::current, board.id);
        if (begins && heard.size() >= with_currents) {
            board.extra_words = board.info.motors;
            return true;
        }
        if (begins && heard.size() >= usual) {
            return true;
        }
    }
    return false;
}

std::vector<BoardLayout> scan(SerialPort &port, const std::atomic<bool> &give_up) {
    std::vector<BoardLayout> boards;
    for (std::uint8_t id = 0; id < kMostBoards && !give_up.load(); ++id) {
        BoardLayout board;
        if (find_board(port, id, board)) {
            boards.push_back(board);
        }
    }
    return boards;
}

// Answers may come too late on a busy computer: two consecutive scans must find the same boards.
bool find_boards(SerialPort &port, const std::atomic<bool> &give_up, BoardSession &session) {
    BoardFrame frame;
    frame.zeros(kResyncZeros);
    (void)port.write(frame.bytes(), kWrite_ms);
    bool same = false;
    for (int i = 0; i < kScans && (!same || session.boards.empty()) && !give_up.load(); ++i) {
        std::vector<BoardLayout> found = scan(port, give_up);
        same = i > 0 &&
               std::equal(found.begin(), found.end(), session.boards.begin(), session.boards.end(),
                          [](const BoardLayout &a, const BoardLayout &b) {
                              return a.id == b.id && a.info == b.info;
                          });
        session.boards = std::move(found);
    }
    frame.clear();
    for (const BoardLayout &board : session.boards) {
        append_command_lengths(frame, board);
    }
    return !session.boards.empty() && port.write(frame.bytes(), kWrite_ms);
}

// Conditions that every board must meet before its motors are used.
bool question(SerialPort &port, BoardSession &session, std::string &problem) {
    for (BoardLayout &board : session.boards) {
        std::uint32_t mask = 0;
        if (!measure_reply(port, board)) {
            problem = name_of(board) +
                      " does not answer the command CURRENT; check the wiring of the bus.";
            return false;
        }
        if (!read_parameter(port, board, BoardParameter::quadrature_mask, mask)) {
            session.remarks += name_of(board) + " does not report how its encoders are read. ";
        }
        const std::uint32_t all = (1U << board.info.motors) - 1U;
        if ((mask & all) != all) {
            session.remarks += name_of(board) +
                               " does not read the quadrature encoders of all of its "
                               "motors, which a SPIDAR needs; set its quadrature "
                               "mask. ";
        }
        session.quadrature_masks.push_back(mask);
    }
    return true;
}

// Asks as the servo loop does, one question at a time, so that each answer belongs to a known
// question. Returns 0 when too few answers came.
double measure_round_trip(SerialPort &port, const std::vector<BoardLayout> &boards) {
    BoardFrame frame;
    std::size_t length = 0;
    for (const BoardLayout &board : boards) {
        append_current(frame, board, {});
        length += reply_length(board, BoardCommand::current);
    }
    std::vector<double> times_s;
    for (int i = 0; i < kRoundTrips; ++i) {
        forget_input(port);
        const std::int64_t start_ns = monotonic_ns();
        if (!port.write(frame.bytes(), kWrite_ms)) {
            break;
        }
        if (listen(port, length, kSlowestRoundTrip_ms).size() >= length) {
            times_s.push_back(1e-9 * static_cast<double>(monotonic_ns() - start_ns));
        }
    }
    if (times_s.size() < kRoundTrips / 2) {
        return 0.0;
    }
    const auto middle = times_s.begin() + static_cast<std::ptrdiff_t>(times_s.size() / 2);
    std::nth_element(times_s.begin(), middle, times_s.end());
    return *middle;
}

} // namespace

Status open_session(const std::string &path, std::uint32_t baud, const std::atomic<bool> &give_up,
                    BoardSession &session, std::string &problem) {
    Status status = Status::ok;
    std::shared_ptr<SerialPort> port = open_serial_port(path, baud, status, problem);
    if (!port) {
        return status;
    }
    BoardSession opened;
    opened.path = path;
    std::string latency;
    if (shorten_latency(path, port->descriptor(), latency) == BridgeLatency::long_one) {
        opened.remarks += latency + " ";
    }
    if (!find_boards(*port, give_up, opened)) {
        problem = "Port " + path +
                  ": no motor board answers; check its power, the cable, and that "
                  "the bus runs at " +
                  std::to_string(baud) + " baud.";
        return Status::protocol_mismatch;
    }
    if (!question(*port, opened, problem)) {
        return Status::protocol_mismatch;
    }
    opened.round_trip_s = measure_round_trip(*port, opened.boards);
    forget_input(*port);
    opened.writer = port->another();
    opened.reader = std::move(port);
    if (!opened.writer) {
        problem = "Port " + path +
                  ": the system does not open the port a second time; open the device again.";
        return Status::open_failed;
    }
    session = std::move(opened);
    problem.clear();
    return Status::ok;
}

} // namespace spidar
