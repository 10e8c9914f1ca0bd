#include "device/serial/serial_transport.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>
#include <thread>
#include <utility>

#include "device/serial/protocol/wire_rate.h"
#include "device/serial/serial_transport_impl.h"
#include "device/threads/real_time_thread.h"

namespace spidar {

namespace {

constexpr auto kWatch = std::chrono::milliseconds(100);
constexpr auto kHangingWritePoll = std::chrono::milliseconds(1);
// Longest delay of a pulling command after the guard's answer: less than the guard's patience, and
// far more than composing a command takes.
constexpr std::int64_t kHeldUp_ns = 10'000'000;
constexpr int kFirstRounds = 50; // ten times what a good line needs
constexpr auto kFirstRound = std::chrono::milliseconds(2);
constexpr int kMostReadsAtOnce = 8; // of kReadRoom bytes: what is left is for the next cycle
constexpr std::size_t kReadRoom = 512;
constexpr std::uint16_t kSequences = 0xFFFF; // the last one means "none"
constexpr std::int64_t kNanosecondsPerMicrosecond = 1000;

} // namespace

SerialTransport::Impl::Borrowed
SerialTransport::Impl::borrow(std::shared_ptr<SerialPort> BoardSession::*which) const {
    const std::lock_guard<std::mutex> lock(mutex);
    return {session.*which, session_number, session.boards, motors,
            boards_of(motors, session.boards)};
}

// Borrows only when the link has changed, so that the loop takes no lock.
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
    } catch (const std::exception &) { // no memory: treated as unplugged until the next cycle
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

Status SerialTransport::Impl::connect(const std::string &path, const std::atomic<bool> &give_up,
                                      std::string &why) {
    BoardSession fresh;
    const Status status = open_session(path, settings.baud, give_up, fresh, why);
    if (!usable(status)) {
        return status;
    }
    const SerialMotorTable table =
        settings.motors_in_order ? motors_in_order(fresh.boards, settings.motors) : settings.motors;
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

// Called from the controlling thread before the watcher runs, then from the watcher.
void SerialTransport::Impl::start_guard() {
    const Borrowed mine = borrow(&BoardSession::writer);
    if (mine.port) {
        std::string remark = guard.start(settings.guard, mine.port->descriptor(), mine.boards);
        const std::lock_guard<std::mutex> lock(mutex);
        guard_remark = std::move(remark);
    }
}

// Looks for the device while it is lost, and starts a guard while there is none.
void SerialTransport::Impl::watch() {
    std::string why;
    std::unique_lock<std::mutex> lock(mutex);
    const std::string path = session.path;
    while (!stop_watcher) {
        wake.wait_for(lock, kWatch, [this] { return stop_watcher.load(); });
        if (stop_watcher) {
            return;
        }
        const bool reconnects = !connected;
        lock.unlock();
        try {
            if (reconnects) {
                guard.end(); // it holds the lost port, which nobody else could open
                if (usable(connect(path, stop_watcher, why))) {
                    SerialStatistics::add(statistics.replugs);
                    start_guard();
                }
            } else if (guard.is_wanted()) {
                start_guard();
            }
        } catch (const std::exception &) { // no memory: tried again at the next search
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
    return open_unless(std::atomic<bool>{false});
}

Status SerialTransport::open_unless(const std::atomic<bool> &give_up) noexcept {
    Impl &m = *impl_;
    if (m.first_waits && m.is_open.load()) {
        return Status::ok;
    }
    close();
    try {
        std::string path;
        Status status = choose_serial_port(m.settings.port, path, m.problem);
        status = usable(status) ? m.connect(path, give_up, m.problem) : status;
        if (!usable(status)) {
            return status;
        }
        m.start_guard();
        m.guard.allow();
        m.stop_watcher = false;
        m.is_open.store(true);
        m.watcher = std::thread([&m] { m.watch(); });
        // A loop that starts without a reading would take the counts of an unknown device as
        // zeroed.
        for (int i = 0; i < kFirstRounds && !m.first_waits && !give_up.load(); ++i) {
            (void)write(DriveCommand());
            std::this_thread::sleep_for(kFirstRound);
            m.first_waits = read(m.first) == Status::ok;
        }
        if (m.first_waits) {
            return status;
        }
        m.problem = "Port " + path +
                    ": the boards answer, but their counts do not agree; check the cable and open "
                    "the device again.";
        close();
        return Status::protocol_mismatch;
    } catch (const std::exception &) { // no memory, no thread
        close();
        return Status::open_failed;
    }
}

void SerialTransport::keep_asking() noexcept {
    Impl &m = *impl_;
    if (!m.first_waits) {
        return;
    }
    (void)write(DriveCommand());
    m.first_waits = false;
    (void)read(m.first); // unchanged when nothing came
    m.first_waits = true;
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
    m.guard.end();
    BoardSession dropped;
    const std::lock_guard<std::mutex> lock(m.mutex);
    m.first_waits = false;
    m.connected = false;
    m.link_number.fetch_add(1);
    m.reader = Impl::Borrowed();
    std::swap(dropped, m.session);
}

void SerialTransport::Impl::fill(DeviceReading &reading) noexcept {
    for (std::size_t i = 0; i < kStringCount; ++i) {
        const SerialMotor &motor = reader.motors[i];
        const std::int32_t count =
            replies.count(reader.board_of[i], static_cast<std::size_t>(motor.motor));
        reading.counts[i] = motor.count_sign < 0 ? -count : count;
    }
    reading.device_time_us = 0; // the boards report no clock
    reading.sequence =
        static_cast<std::uint16_t>((replies.counters().rounds + lost_seen) % kSequences);
    reading.buttons = 0;
    std::size_t sensor = 0;
    for (std::size_t board = 0; board < replies.board_count(); ++board) {
        for (std::size_t i = 0; i < replies.force_count(board) && sensor < kSensorCount; ++i) {
            reading.sensors[sensor++] = replies.force(board, i);
        }
    }
    reading.zeroed = false; // the counts have an arbitrary origin
    reading.device_status = guard.allows() ? Status::ok : Status::device_watchdog;
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
        m.lost_before += m.asked_seen - std::min(m.asked_seen, m.replies_seen.rounds);
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
    // Late answers are not lost; the sequence of readings has already reported the gap.
    const std::uint64_t lost = m.replies.lost(m.asked_seen);
    m.statistics.lost.store(m.lost_before + lost, std::memory_order_relaxed);
    m.lost_seen = std::max(m.lost_seen, lost);
    if (m.replies.reference_lost(now_us)) { // silent for too long, or a board restarted
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

bool SerialTransport::Impl::may_pull(const DriveCommand &command) noexcept {
    if (!command.motors_on && command.clear_faults) {
        guard.allow();
    }
    return command.motors_on && guard.allows();
}

Status SerialTransport::Impl::send(const DriveCommand &command) noexcept {
    const std::int64_t now_ns = monotonic_ns();
    guard.beat(now_ns, last_pulled);
    const bool pull = may_pull(command);
    // Only commands that change nothing for the worse wait for the wire: never one that stops the
    // pull.
    if (now_ns < wire_free_ns && pull == last_pulled) {
        SerialStatistics::add(statistics.postponed);
        return Status::ok;
    }
    BoardFrame frame;
    append_currents(frame, writer.boards, writer.motors, pull ? command.currents_a : StringArray{},
                    settings.units_per_a, settings.most_units);
    if (!frame.whole()) {
        return Status::write_failed;
    }
    // The process may have been stopped and continued since the guard's answer: then the guard has
    // set the currents to zero.
    if (pull && monotonic_ns() - now_ns > kHeldUp_ns) {
        SerialStatistics::add(statistics.postponed);
        return Status::ok;
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
        return Status::write_failed; // a write runs in another thread
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
    const std::string path = port();
    return path.empty() ? std::string() : serial_device_name(path);
}

std::string SerialTransport::port() const {
    const std::lock_guard<std::mutex> lock(impl_->mutex);
    return impl_->session.path;
}

std::vector<BoardLayout> SerialTransport::boards() const {
    const std::lock_guard<std::mutex> lock(impl_->mutex);
    return impl_->session.boards;
}

double SerialTransport::highest_rate_hz() const {
    return spidar::highest_rate_hz(boards(), impl_->settings.baud);
}

// The answer waits for the loop's next cycle, and the command computed from it must pass the wire.
double SerialTransport::latency_s(double rate_hz) const {
    const std::lock_guard<std::mutex> lock(impl_->mutex);
    const double trip_s = impl_->session.round_trip_s;
    if (!(trip_s > 0.0 && rate_hz > 0.0)) {
        return 0.0;
    }
    return std::ceil(trip_s * rate_hz) / rate_hz +
           round_time_s(impl_->session.boards, impl_->settings.baud);
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
