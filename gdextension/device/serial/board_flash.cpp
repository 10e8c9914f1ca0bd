#include "device/serial/board_flash.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <thread>

#include "device/contract/device_claims.h"
#include "device/serial/board_session.h"
#include "device/serial/board_talk.h"

namespace spidar {

namespace {

const char *const kOwner = "the boards' parameters";
// Time after a write: flash is erased and written in less than a tenth of a second, during which
// the board may not listen.
constexpr std::chrono::milliseconds kFlashTime(200);

std::string as_mask(std::uint32_t mask) {
    std::array<char, 16> text{};
    std::snprintf(text.data(), text.size(), "0x%02x", static_cast<unsigned>(mask));
    return text.data();
}

bool is_id(const FlashChange &change) noexcept {
    return change.parameter == BoardParameter::board_id;
}

std::string value_text(const FlashChange &change, std::uint32_t value) {
    return is_id(change) ? std::to_string(value) : as_mask(value);
}

bool same(const BoardFlash &a, const BoardFlash &b) noexcept {
    return a.board.id == b.board.id && a.board.info == b.board.info && a.stored_id == b.stored_id &&
           a.quadrature_mask == b.quadrature_mask;
}

bool read_flash_of(SerialPort &port, const BoardLayout &board, BoardFlash &flash) {
    std::uint32_t id = 0;
    flash.board = board;
    const bool good =
        read_parameter(port, board, BoardParameter::board_id, id) &&
        read_parameter(port, board, BoardParameter::quadrature_mask, flash.quadrature_mask);
    flash.stored_id = static_cast<std::uint8_t>(id & 0xFFU);
    return good;
}

Status read_all(const std::string &port, std::uint32_t baud, const std::atomic<bool> &give_up,
                BoardSession &session, std::vector<BoardFlash> &boards, std::string &problem) {
    boards.clear();
    const Status status = open_session(port, baud, give_up, session, problem);
    if (!usable(status)) {
        return status;
    }
    for (const BoardLayout &board : session.boards) {
        BoardFlash flash;
        if (!read_flash_of(*session.reader, board, flash)) {
            problem = name_of(board) + " at " + port +
                      " does not report its parameters; check the cable and read again.";
            return Status::protocol_mismatch;
        }
        boards.push_back(flash);
    }
    return status;
}

// Another owner in this process is named; another program has locked the port.
bool claim_port(const std::string &port, DeviceClaim &claim, std::string &problem) {
    const std::string name = serial_device_name(port);
    if (claim.take(name, kOwner)) {
        return true;
    }
    problem = "Port " + port + " belongs to \"" + DeviceClaim::owner_of(name) +
              "\", which may have armed its motors: close the device there first.";
    return false;
}

bool send_change(SerialPort &port, const FlashChange &change) {
    std::array<std::uint8_t, sizeof(change.value)> data{};
    for (std::size_t i = 0; i < data.size(); ++i) {
        data[i] = static_cast<std::uint8_t>(change.value >> 8U * i & 0xFFU);
    }
    BoardFrame frame;
    append_set_parameter(frame, change.board.board, change.parameter, data);
    return frame.whole() && port.write(frame.bytes(), kWrite_ms);
}

// Tries the old and the new id, since the sources do not say when a new id takes effect.
bool read_back(SerialPort &port, const FlashChange &change, BoardFlash &after) {
    if (read_flash_of(port, change.board.board, after)) {
        return true;
    }
    BoardLayout moved = change.board.board;
    moved.id = static_cast<std::uint8_t>(change.value);
    BoardFrame frame;
    append_command_lengths(frame, moved);
    return is_id(change) && port.write(frame.bytes(), kWrite_ms) &&
           read_flash_of(port, moved, after);
}

} // namespace

std::string exact_name(const FlashChange &change) {
    return name_of(change.board.board) + " at " + change.port;
}

std::uint32_t value_before(const FlashChange &change) noexcept {
    return is_id(change) ? change.board.stored_id : change.board.quadrature_mask;
}

std::string describe(const FlashChange &change) {
    return std::string(is_id(change) ? "id " : "quadrature mask ") +
           value_text(change, value_before(change)) + " becomes " +
           value_text(change, change.value);
}

std::string validate(const FlashChange &change, const std::vector<BoardFlash> &all) {
    const std::string value = "value = " + std::to_string(change.value) + ": ";
    const std::size_t motors = change.board.board.motors();
    if (!is_id(change) && change.parameter != BoardParameter::quadrature_mask) {
        return "parameter = " + std::to_string(static_cast<int>(change.parameter)) +
               ": only the board's id (3) and the quadrature mask (7) can be written.";
    }
    if (!is_id(change) && change.value >= 1U << motors) {
        return value + "a quadrature mask has one bit for each of the board's " +
               std::to_string(motors) + " motors; give at most " +
               std::to_string((1U << motors) - 1U) + ", which is all of them.";
    }
    if (is_id(change) && change.value >= kMostBoards) {
        return value + "give an id from 0 to 7.";
    }
    if (change.value == value_before(change)) {
        return value + name_of(change.board.board) + " already holds this value.";
    }
    for (const BoardFlash &other : all) {
        const bool itself = other.board.id == change.board.board.id;
        if (is_id(change) && !itself &&
            (other.board.id == change.value || other.stored_id == change.value)) {
            return value + "another board of this bus has this id, and boards with equal ids "
                           "answer at the same time; give an id that is free.";
        }
    }
    return {};
}

Status read_board_flash(const std::string &port, std::uint32_t baud,
                        const std::atomic<bool> &give_up, std::vector<BoardFlash> &boards,
                        std::string &problem) {
    DeviceClaim claim;
    BoardSession session;
    if (!claim_port(port, claim, problem)) {
        return Status::device_in_use;
    }
    return read_all(port, baud, give_up, session, boards, problem);
}

Status write_board_flash(const FlashChange &change, std::uint32_t baud,
                         const std::atomic<bool> &give_up, BoardFlash &after,
                         std::string &problem) {
    after = change.board;
    DeviceClaim claim;
    BoardSession session;
    std::vector<BoardFlash> now;
    if (!claim_port(change.port, claim, problem)) {
        return Status::device_in_use;
    }
    const Status opened = read_all(change.port, baud, give_up, session, now, problem);
    if (!usable(opened)) {
        problem += " Nothing was written.";
        return opened == Status::protocol_mismatch ? Status::invalid_settings : opened;
    }
    const bool as_read = std::any_of(
        now.begin(), now.end(), [&](const BoardFlash &one) { return same(one, change.board); });
    problem =
        as_read ? validate(change, now)
                : exact_name(change) +
                      " has changed since it was read, or is another board: read the boards again.";
    if (!problem.empty()) {
        problem += " Nothing was written.";
        return Status::invalid_settings;
    }
    if (!send_change(*session.reader, change)) {
        problem = exact_name(change) + ": the port did not accept the command; read the "
                                       "boards again to see what they hold.";
        return Status::protocol_mismatch;
    }
    std::this_thread::sleep_for(kFlashTime);
    if (!read_back(*session.reader, change, after)) {
        problem = exact_name(change) + " does not report what it holds now; switch it off "
                                       "and on, and read the boards again.";
        return Status::protocol_mismatch;
    }
    FlashChange read = change;
    read.board = after;
    if (value_before(read) != change.value) {
        problem = exact_name(change) + " holds " + value_text(change, value_before(read)) +
                  " and not the " + value_text(change, change.value) +
                  " that was written; read the boards again and repeat the write.";
        return Status::protocol_mismatch;
    }
    return Status::ok;
}

} // namespace spidar
