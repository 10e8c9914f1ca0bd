// State of SerialTransport's threads: the reader (servo loop), the writer, the watcher, which looks
// for a lost device, and the controlling thread, which opens and closes.
#pragma once

#include <array>
#include <atomic>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "device/serial/board_session.h"
#include "device/serial/guard_link.h"
#include "device/serial/protocol/reply_reader.h"
#include "device/serial/serial_transport.h"

namespace spidar {

struct SerialTransport::Impl {
    explicit Impl(const SerialTransportSettings &settings_in) : settings(settings_in) {}

    // One thread's copy of the present connection; `port` is null without a connection.
    struct Borrowed {
        std::shared_ptr<SerialPort> port;
        std::uint32_t session = 0;
        std::vector<BoardLayout> boards;
        SerialMotorTable motors{};
        std::array<std::size_t, kStringCount> board_of{}; // each string's index into `boards`
    };
    [[nodiscard]] Borrowed borrow(std::shared_ptr<SerialPort> BoardSession::*which) const;
    void refresh(Borrowed &mine, std::uint32_t &link_seen,
                 std::shared_ptr<SerialPort> BoardSession::*which) const noexcept;
    void lose(std::uint32_t which) noexcept;
    Status connect(const std::string &path, const std::atomic<bool> &give_up, std::string &why);
    void start_guard();
    void watch();
    [[nodiscard]] bool may_pull(const DriveCommand &command) noexcept;
    Status send(const DriveCommand &command) noexcept;
    void fill(DeviceReading &reading) noexcept;

    const SerialTransportSettings settings;
    std::string problem; // used by the controlling thread

    // Locked only to copy or swap the members up to session_number, and by the watcher's wait. A
    // port handle's last owner closes the port after unlocking.
    mutable std::mutex mutex;
    BoardSession session;
    SerialMotorTable motors{};
    std::string guard_remark;
    std::uint32_t session_number = 0;
    // Counts connections, losses and closings. After a change, each thread must borrow() again.
    std::atomic<std::uint32_t> link_number{0};
    bool connected = false;
    std::atomic<bool> stop_watcher{false};
    std::condition_variable wake;
    std::thread watcher;
    std::atomic<bool> is_open{false};

    SerialStatistics statistics;
    GuardLink guard{statistics};
    std::atomic<std::uint64_t> asked{0}; // rounds requested in this connection

    // Used by the reader.
    Borrowed reader;
    std::uint32_t link_read = 0;
    std::uint32_t session_read = 0;
    ReplyReader replies;
    ReplyCounters replies_seen;
    std::uint64_t lost_seen = 0;
    std::uint64_t lost_before = 0; // rounds lost in earlier connections
    std::uint64_t asked_seen = 0;
    DeviceReading first;      // reading that open() or keep_asking() received
    bool first_waits = false; // read() has not yet returned `first`

    // Used by the writer.
    std::atomic<bool> write_busy{false};
    Borrowed writer;
    std::uint32_t link_written = 0;
    std::int64_t wire_free_ns = 0;
    bool last_pulled = false;
};

} // namespace spidar
