#include "device/serial/serial_transport.h"

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>
#include <utility>

#include "device/serial/board_session.h"
#include "device/serial/port_guard.h"
#include "device/serial/protocol/wire_rate.h"
#include "device/threads/real_time_thread.h"

namespace spidar {

namespace {

constexpr auto kWatch = std::chrono::milliseconds(100);
constexpr auto kHangingWritePoll = std::chrono::milliseconds(1);
constexpr int kFirstRounds = 50; // ten times what a good line needs
constexpr auto kFirstRound = std::chrono::milliseconds(2);
constexpr int kMostReadsAtOnce = 8; // of kReadRoom bytes: what is left is for the next cycle
constexpr std::size_t kReadRoom = 512;
constexpr std::uint16_t kSequences = 0xFFFF; // the last one means "none"
constexpr std::int64_t kNanosecondsPerMicrosecond = 1000;

} // namespace

struct SerialTransport::Impl {
    explicit Impl(const SerialTransportSettings &settings_in) : settings(settings_in) {}

    // What a thread works with, of the present plug-in; null handles when there is none.
    struct Borrowed {
        std::shared_ptr<SerialPort> port;
        std::uint32_t session = 0;
        std::vector<BoardLayout> boards;
        SerialMotorTable motors{};
    };
    [[nodiscard]] Borrowed borrow(std::shared_ptr<SerialPort> BoardSession::*which) const;
    void refresh(Borrowed &mine, std::uint32_t &link_seen,
                 std::shared_ptr<SerialPort> BoardSession::*which) const noexcept;
    void lose(std::uint32_t which) noexcept;
    Status find_port(std::string &path, std::string &why) const;
    Status connect(const std::string &path, std::string &why);
    void start_guard();
    void end_guard() noexcept;
    void watch();
    void guard_the_port() noexcept;
    [[nodiscard]] bool append_command(BoardFrame &frame, const DriveCommand &command,
                                      bool pull) const noexcept;
    [[nodiscard]] bool may_pull(const DriveCommand &command) noexcept;
    Status send(const DriveCommand &command) noexcept;
    void fill(DeviceReading &reading) noexcept;

    const SerialTransportSettings settings;
    std::string problem; // the controlling thread's own

    // Held only to copy or swap; ports are closed outside, by whoever drops the last reference.
    mutable std::mutex mutex;
    BoardSession session;
    SerialMotorTable motors{};
    std::string guard_remark;
    std::uint32_t session_number = 0;
    std::atomic<std::uint32_t> link_number{0}; // counts connects and losses: when to borrow anew
    bool connected = false;
    bool stop_watcher = false;
    std::condition_variable wake;
    std::thread watcher;
    std::atomic<bool> is_open{false};

    // The guard is used by the writer and replaced by the watcher: whoever has this flag may touch it.
    PortGuard guard;
    std::atomic_flag guard_busy = ATOMIC_FLAG_INIT;
    std::atomic<bool> guard_wanted{false}; // it is lost: the watcher starts another
    std::atomic<bool> tripped{false};      // latched until faults are cleared with the motors off

    SerialStatistics statistics;
    std::atomic<std::uint64_t> asked{0}; // rounds of this session

    // Reader's own.
    Borrowed reader;
    std::uint32_t link_read = 0;
    std::uint32_t session_read = 0;
    ReplyReader replies;
    ReplyCounters replies_seen;
    std::uint64_t lost_seen = 0;
    std::uint64_t asked_seen = 0;
    DeviceReading first; // that open() heard
    bool first_waits = false;

    // Writer's own.
    std::atomic<bool> write_busy{false};
    Borrowed writer;
    std::uint32_t link_written = 0;
    std::int64_t wire_free_ns = 0;
    bool last_pulled = false;
    bool guard_was_alive = false;
};

SerialTransport::Impl::Borrowed
SerialTransport::Impl::borrow(std::shared_ptr<SerialPort> BoardSession::*which) const {
    const std::lock_guard<std::mutex> lock(mutex);
    return {session.*which, session_number, session.boards, motors};
}

// Only after the link has changed, so that the loop meets no lock.
void SerialTransport::Impl::refresh(
    Borrowed &mine, std::uint32_t &link_seen,
    std::shared_ptr<SerialPort> BoardSession::*which) const noexcept {
    const std::uint32_t link = link_number.load();
    if (link_seen == link) {
        return;
    }
    try {
        mine = borrow(which);
        link_seen = link;
    } catch (const std::exception &) { // no memory: as good as unplugged, until the next cycle
        mine.port.reset();
    }
}

void SerialTransport::Impl::lose(std::uint32_t which) noexcept {
    BoardSession dropped;
    {
        const std::lock_guard<std::mutex> lock(mutex);
        if (!connected || which != session_number) {
            return;
        }
        connected = false;
        std::swap(dropped.reader, session.reader);
        std::swap(dropped.writer, session.writer);
        link_number.fetch_add(1);
    }
    SerialStatistics::add(statistics.losses);
    wake.notify_all();
}

Status SerialTransport::Impl::find_port(std::string &path, std::string &why) const {
    path = settings.port;
    if (!path.empty()) {
        return Status::ok;
    }
    std::string names;
    int found = 0;
    for (const SerialPortInfo &port : list_serial_ports()) {
        if (port.usb) {
            path = found++ == 0 ? port.path : path;
            names += (names.empty() ? "" : ", ") + describe(port);
        }
    }
    if (found == 1) {
        return Status::ok;
    }
    why = found == 0 ? "No serial port of a USB bridge is plugged in."
                     : "Several serial ports are plugged in (" + names + "): choose one.";
    return found == 0 ? Status::no_device : Status::invalid_settings;
}

Status SerialTransport::Impl::connect(const std::string &path, std::string &why) {
    BoardSession fresh;
    const Status status = open_session(path, settings.baud, fresh, why);
    if (!usable(status)) {
        return status;
    }
    const SerialMotorTable table =
        settings.motors_in_order ? motors_in_order(fresh.boards) : settings.motors;
    why = validate(table, fresh.boards);
    if (!why.empty()) {
        return settings.motors_in_order ? Status::protocol_mismatch : Status::invalid_settings;
    }
    const std::lock_guard<std::mutex> lock(mutex);
    session = std::move(fresh);
    motors = table;
    ++session_number;
    asked.store(0);
    connected = true;
    link_number.fetch_add(1);
    return Status::ok;
}

// From the controlling thread before the watcher runs, then from the watcher.
void SerialTransport::Impl::start_guard() {
    Borrowed mine = borrow(&BoardSession::writer);
    if (!mine.port) {
        return;
    }
    BoardFrame off;
    off.zeros(kResyncZeros);
    for (const BoardLayout &board : mine.boards) {
        append_current(off, board, {});
    }
    const std::string program = settings.guard.empty() ? guard_beside_library() : settings.guard;
    while (guard_busy.test_and_set(std::memory_order_acquire)) { // the writer beats: microseconds
        std::this_thread::yield();
    }
    std::string remark = guard.start(program, mine.port->descriptor(), off.bytes());
    guard_busy.clear(std::memory_order_release);
    guard_wanted.store(false);
    const std::lock_guard<std::mutex> lock(mutex);
    guard_remark = std::move(remark);
}

void SerialTransport::Impl::end_guard() noexcept {
    while (guard_busy.test_and_set(std::memory_order_acquire)) {
        std::this_thread::yield();
    }
    guard.end();
    guard_busy.clear(std::memory_order_release);
}

// Looks for the device while it is gone, and for a guard while there is none.
void SerialTransport::Impl::watch() {
    std::string why;
    std::unique_lock<std::mutex> lock(mutex);
    const std::string path = session.path;
    while (!stop_watcher) {
        wake.wait_for(lock, kWatch, [this] { return stop_watcher; });
        if (stop_watcher) {
            return;
        }
        const bool reconnects = !connected;
        lock.unlock();
        try {
            if (reconnects) {
                end_guard(); // it holds the port that is gone, and nobody else may open it
                if (usable(connect(path, why))) {
                    SerialStatistics::add(statistics.replugs);
                    start_guard();
                }
            } else if (guard_wanted.load()) {
                start_guard();
            }
        } catch (const std::exception &) { // no memory: the next look may have some
            why.clear();
        }
        lock.lock();
    }
}

SerialTransport::SerialTransport(const SerialTransportSettings &settings)
    : impl_(std::make_unique<Impl>(settings)) {}

SerialTransport::~SerialTransport() {
    close();
    while (impl_->write_busy.load(std::memory_order_acquire)) {
        std::this_thread::sleep_for(kHangingWritePoll);
    }
}

Status SerialTransport::open() noexcept {
    Impl &m = *impl_;
    close();
    try {
        std::string path;
        Status status = m.find_port(path, m.problem);
        status = usable(status) ? m.connect(path, m.problem) : status;
        if (!usable(status)) {
            return status;
        }
        m.tripped.store(false);
        m.start_guard();
        m.stop_watcher = false;
        m.is_open.store(true);
        m.watcher = std::thread([&m] { m.watch(); });
        // A loop that begins without a reading would take the counts of a device that it has not heard for zeroed.
        for (int i = 0; i < kFirstRounds && !m.first_waits; ++i) {
            (void)write(DriveCommand());
            std::this_thread::sleep_for(kFirstRound);
            m.first_waits = read(m.first) == Status::ok;
        }
        if (m.first_waits) {
            return status;
        }
        m.problem = "Port " + path + ": the boards answer, but not with counts that agree.";
        close();
        return Status::protocol_mismatch;
    } catch (const std::exception &) { // no memory, no thread
        close();
        return Status::open_failed;
    }
}

void SerialTransport::close() noexcept {
    Impl &m = *impl_;
    write(DriveCommand()); // motors off
    {
        const std::lock_guard<std::mutex> lock(m.mutex);
        m.is_open.store(false);
        m.stop_watcher = true;
    }
    m.wake.notify_all();
    if (m.watcher.joinable()) {
        m.watcher.join();
    }
    m.end_guard();
    BoardSession dropped;
    const std::lock_guard<std::mutex> lock(m.mutex);
    m.first_waits = false;
    m.connected = false;
    m.link_number.fetch_add(1);
    m.reader = Impl::Borrowed();
    std::swap(dropped, m.session);
}

void SerialTransport::Impl::fill(DeviceReading &reading) noexcept {
    const std::uint64_t lost = replies.lost(asked_seen);
    if (lost > lost_seen) {
        SerialStatistics::add(statistics.lost, lost - lost_seen);
        lost_seen = lost;
    }
    for (std::size_t i = 0; i < kStringCount; ++i) {
        const SerialMotor &motor = reader.motors[i];
        for (std::size_t board = 0; board < reader.boards.size(); ++board) {
            if (reader.boards[board].id == motor.board_id) {
                const std::int32_t count =
                    replies.count(board, static_cast<std::size_t>(motor.motor));
                reading.counts[i] = motor.count_sign < 0 ? -count : count;
            }
        }
    }
    reading.device_time_us = 0; // the boards have no clock that they tell
    reading.sequence =
        static_cast<std::uint16_t>((replies.counters().rounds + lost_seen) % kSequences);
    reading.buttons = 0;
    reading.zeroed = false; // their counts begin anywhere
    const bool guarded = guard.alive() && !tripped.load(std::memory_order_acquire);
    reading.device_status = guarded ? Status::ok : Status::device_watchdog;
    reading.fault_strings = 0;
}

Status SerialTransport::read(DeviceReading &reading) noexcept {
    Impl &m = *impl_;
    if (m.first_waits) {
        m.first_waits = false;
        reading = m.first;
        return Status::ok;
    }
    m.refresh(m.reader, m.link_read, &BoardSession::reader);
    if (!m.reader.port) {
        return m.is_open.load() ? Status::read_failed : Status::not_open;
    }
    if (m.session_read != m.reader.session) {
        m.session_read = m.reader.session;
        if (m.asked_seen > m.replies_seen.rounds + m.lost_seen) { // nobody answers them any more
            SerialStatistics::add(m.statistics.lost,
                                  m.asked_seen - m.replies_seen.rounds - m.lost_seen);
        }
        m.asked_seen = 0;
        m.replies.configure(m.reader.boards, m.settings.counts);
        m.replies_seen = {};
        m.lost_seen = 0;
    }
    std::array<std::uint8_t, kReadRoom> bytes{};
    int rounds = 0;
    const auto now_us = static_cast<std::uint64_t>(monotonic_ns() / kNanosecondsPerMicrosecond);
    for (int i = 0; i < kMostReadsAtOnce; ++i) {
        const int count = m.reader.port->read(bytes, 0);
        if (count < 0) {
            m.lose(m.reader.session);
            return Status::read_failed;
        }
        m.asked_seen = std::max(m.asked_seen, m.asked.load(std::memory_order_acquire));
        rounds += m.replies.take(BoardBytes(bytes).first(static_cast<std::size_t>(count)),
                                 m.asked_seen, now_us);
        if (count == 0) {
            break;
        }
    }
    m.statistics.take(m.replies.counters(), m.replies_seen);
    if (m.replies.reference_lost(now_us)) { // silent for too long, or a board began anew
        m.lose(m.reader.session);
        return Status::read_failed;
    }
    if (rounds == 0) {
        return Status::read_timeout;
    }
    SerialStatistics::add(m.statistics.superseded, static_cast<std::uint64_t>(rounds - 1));
    reading.overtaken = static_cast<std::uint16_t>(rounds - 1);
    m.fill(reading);
    return Status::ok;
}

// Tells the guard that this process lives, and hears whether the guard does.
void SerialTransport::Impl::guard_the_port() noexcept {
    if (guard_busy.test_and_set(std::memory_order_acquire)) {
        return; // another one is being started
    }
    guard.beat(monotonic_ns());
    if (guard.take_tripped() && last_pulled) {
        tripped.store(true, std::memory_order_release);
        SerialStatistics::add(statistics.guard_trips);
    }
    const bool alive = guard.alive();
    guard_busy.clear(std::memory_order_release);
    if (guard_was_alive && !alive) {
        SerialStatistics::add(statistics.guard_losses);
        tripped.store(true, std::memory_order_release);
        guard_wanted.store(true);
    }
    guard_was_alive = alive;
}

bool SerialTransport::Impl::may_pull(const DriveCommand &command) noexcept {
    if (!command.motors_on) {
        if (command.clear_faults && guard.alive()) {
            tripped.store(false, std::memory_order_release);
        }
        return false;
    }
    return guard.alive() && !tripped.load(std::memory_order_acquire);
}

bool SerialTransport::Impl::append_command(BoardFrame &frame, const DriveCommand &command,
                                           bool pull) const noexcept {
    for (const BoardLayout &board : writer.boards) {
        BoardCurrents currents{};
        for (std::size_t i = 0; i < kStringCount && pull; ++i) {
            const SerialMotor &motor = writer.motors[i];
            if (motor.board_id == board.id) {
                currents[static_cast<std::size_t>(motor.motor)] =
                    board_units(command.currents_a[i], settings.units_per_a, settings.most_units,
                                motor.current_sign);
            }
        }
        append_current(frame, board, currents);
    }
    return frame.whole();
}

Status SerialTransport::Impl::send(const DriveCommand &command) noexcept {
    guard_the_port();
    const bool pull = may_pull(command);
    const std::int64_t now_ns = monotonic_ns();
    // Only what changes nothing for the worse waits for the wire: never the command that stops the pull.
    if (now_ns < wire_free_ns && pull == last_pulled) {
        SerialStatistics::add(statistics.postponed);
        return Status::ok;
    }
    BoardFrame frame;
    if (!append_command(frame, command, pull)) {
        return Status::write_failed;
    }
    last_pulled = last_pulled || pull;
    asked.fetch_add(1, std::memory_order_acq_rel); // before the boards can answer
    SerialStatistics::add(statistics.asked);
    if (!writer.port->write(frame.bytes(), kLongestWrite_ms)) {
        SerialStatistics::add(statistics.write_failures);
        lose(writer.session);
        return Status::write_failed;
    }
    wire_free_ns =
        now_ns + static_cast<std::int64_t>(1e9 * round_time_s(writer.boards, settings.baud));
    last_pulled = pull;
    return Status::ok;
}

Status SerialTransport::write(const DriveCommand &command) noexcept {
    Impl &m = *impl_;
    if (m.write_busy.exchange(true, std::memory_order_acq_rel)) {
        return Status::write_failed; // under way in another thread
    }
    m.refresh(m.writer, m.link_written, &BoardSession::writer);
    Status status = Status::ok;
    if (m.writer.port) {
        status = m.send(command);
    } else {
        status = m.is_open.load() ? Status::write_failed : Status::not_open;
    }
    m.write_busy.store(false, std::memory_order_release);
    return status;
}

std::string SerialTransport::device_name() const {
    const std::lock_guard<std::mutex> lock(impl_->mutex);
    return impl_->session.path.empty() ? std::string() : "serial:" + impl_->session.path;
}

std::vector<BoardLayout> SerialTransport::boards() const {
    const std::lock_guard<std::mutex> lock(impl_->mutex);
    return impl_->session.boards;
}

double SerialTransport::highest_rate_hz() const {
    return spidar::highest_rate_hz(boards(), impl_->settings.baud);
}

std::string SerialTransport::problem() const {
    return impl_->problem;
}

std::string SerialTransport::remarks() const {
    const std::lock_guard<std::mutex> lock(impl_->mutex);
    return impl_->session.remarks + impl_->guard_remark;
}

int SerialTransport::guard_process() const noexcept {
    return impl_->guard.process();
}

SerialCounters SerialTransport::counters() const noexcept {
    return impl_->statistics.counters();
}

} // namespace spidar
