#include "device/hid/hid_transport.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>
#include <utility>

#include "device/hid/hid_session.h"
#include "device/hid/protocol/hid_codec.h"
#include "device/hid/protocol/report_sequence.h"
#include "device/hid/report_intake.h"
#include "device/threads/real_time_thread.h"

namespace spidar {

namespace {

constexpr auto kReplugPoll = std::chrono::milliseconds(250);
constexpr auto kHangingWritePoll = std::chrono::milliseconds(1);
// Largest number of reports read per cycle: twice the system's queue.
constexpr int kMostReportsAtOnce = 128;
// Number of commands with motors off that clear faults which an earlier host left latched.
constexpr int kClearingCommands = 20;
// Longest wait for a report; the caller's own limits are shorter.
constexpr std::int64_t kLongestWait_ms = 50;
constexpr double kMillinewtonsPerNewton = 1000.0;
constexpr double kHalf = 0.5;
constexpr std::uint32_t kSequenceBits = 16;

std::uint16_t millinewtons(double tension_n, std::uint16_t most_mn) noexcept {
    if (!(tension_n > 0.0)) {
        return 0; // NaN too
    }
    const double rounded = tension_n * kMillinewtonsPerNewton + kHalf;
    return rounded >= most_mn ? most_mn : static_cast<std::uint16_t>(rounded);
}

} // namespace

struct HidTransport::Impl {
    Impl(std::shared_ptr<HidBus> bus_in, const HidTransportSettings &settings_in)
        : bus(std::move(bus_in)), settings(settings_in), intake(statistics) {}

    // Returns a handle of the present session with its number; null when there is none.
    struct Borrowed {
        std::shared_ptr<HidHandle> handle;
        std::uint32_t session = 0;
    };
    [[nodiscard]] Borrowed borrow(std::shared_ptr<HidHandle> HidSession::*which) const noexcept;
    // Marks this session's device as lost. A late failure of an earlier session has no effect.
    void lose(std::uint32_t which) noexcept;
    Status connect(const HidDeviceFilter &filter, std::string &why);
    void watch();
    CommandReport next_command(const DriveCommand &command, std::uint32_t newest_state) noexcept;

    const std::shared_ptr<HidBus> bus;
    const HidTransportSettings settings;
    std::string problem; // used by the controlling thread

    // Locked only to copy or swap. The last owner of a handle closes it without the lock.
    mutable std::mutex mutex;
    HidSession session;
    std::uint32_t session_number = 0;          // counts connects
    std::atomic<std::uint32_t> link_number{0}; // counts connects and losses: when to borrow anew
    bool connected = false;
    bool stop_watcher = false;
    std::condition_variable wake;
    std::thread watcher;

    std::atomic<bool> is_open{false};
    std::atomic<bool> write_busy{false};
    std::atomic<std::uint32_t> zero_number{0}; // counts zeroings
    // The earlier zero is void: the device was plugged in again or restarted.
    std::atomic<bool> zero_required{false};

    HidStatistics statistics;

    // Used by the reader. It borrows only when the link has changed: the loop takes no lock.
    ReportIntake intake;
    Borrowed reader;
    std::uint32_t link_read = 0;
    std::uint32_t session_read = 0;
    std::array<std::uint8_t, 2 * kLargestReport> bytes{}; // room to detect one that is too long
    int waiting = 0; // length of a report in `bytes` that wait_report() left for read()
    void refresh_reader() noexcept;

    // Upper half: epoch of the intake. Lower half: number of the newest state. 0: none yet.
    std::atomic<std::uint32_t> answered{0};
    // The command that the device had accepted when that epoch began.
    std::atomic<std::uint16_t> start_after{kNoSequence};
    // Used by the writer.
    std::uint32_t epoch_written = 0;
    std::uint16_t sequence = kNoSequence;
    int clearing = 0;
    std::atomic<std::uint16_t> most_mn{0};
};

HidTransport::Impl::Borrowed
HidTransport::Impl::borrow(std::shared_ptr<HidHandle> HidSession::*which) const noexcept {
    const std::lock_guard<std::mutex> lock(mutex);
    return {session.*which, session_number};
}

void HidTransport::Impl::lose(std::uint32_t which) noexcept {
    HidSession dropped;
    {
        const std::lock_guard<std::mutex> lock(mutex);
        if (!connected || which != session_number) {
            return;
        }
        connected = false;
        link_number.fetch_add(1);
        std::swap(dropped.reader, session.reader);
        std::swap(dropped.writer, session.writer);
        std::swap(dropped.control, session.control);
    }
    HidStatistics::add(statistics.losses);
    wake.notify_all();
}

Status HidTransport::Impl::connect(const HidDeviceFilter &filter, std::string &why) {
    std::vector<HidDeviceInfo> found;
    Status status = find_devices(*bus, filter, found);
    if (!usable(status)) {
        why = std::string(describe(status)) + " The settings name product \"" + filter.product +
              (filter.serial.empty() ? "\"." : "\", serial \"" + filter.serial + "\".");
        return status;
    }
    HidSession fresh;
    status = open_session(*bus, found.front(), settings.limits, fresh, why);
    if (!usable(status)) {
        return status;
    }
    most_mn.store(std::min(fresh.limits.max_tension_mn, fresh.capabilities.max_tension_mn));
    const std::lock_guard<std::mutex> lock(mutex);
    session = std::move(fresh);
    ++session_number;
    link_number.fetch_add(1);
    connected = true;
    return Status::ok;
}

// Looks for the device while it is lost.
void HidTransport::Impl::watch() {
    HidDeviceFilter filter = settings.filter;
    std::string why;
    std::unique_lock<std::mutex> lock(mutex);
    // Accepts only the same device. With a serial number the path may change; without one only a
    // device at the same path can be the same.
    filter.serial = session.device.serial;
    filter.path = session.device.serial.empty() ? session.device.path : std::string();
    while (!stop_watcher) {
        if (connected) {
            wake.wait(lock);
            continue;
        }
        if (wake.wait_for(lock, kReplugPoll, [this] { return stop_watcher; })) {
            return;
        }
        lock.unlock();
        zero_required.store(true);
        try {
            if (usable(connect(filter, why))) {
                HidStatistics::add(statistics.replugs);
            }
        } catch (const std::exception &) { // no memory: tried again at the next poll
            why.clear();
        }
        lock.lock();
    }
}

HidTransport::HidTransport(std::shared_ptr<HidBus> bus, const HidTransportSettings &settings)
    : impl_(std::make_unique<Impl>(std::move(bus), settings)) {}

HidTransport::~HidTransport() {
    close();
    while (impl_->write_busy.load(std::memory_order_acquire)) {
        std::this_thread::sleep_for(kHangingWritePoll);
    }
}

Status HidTransport::open() noexcept {
    Impl &m = *impl_;
    close();
    try {
        m.problem = validate(m.settings.filter);
        if (!m.problem.empty()) {
            return Status::invalid_settings;
        }
        const Status status = m.connect(m.settings.filter, m.problem);
        if (!usable(status)) {
            return status;
        }
        m.zero_required.store(false); // the device itself says whether it has been zeroed
        m.stop_watcher = false;
        m.is_open.store(true);
        m.watcher = std::thread([&m] { m.watch(); });
        return status;
    } catch (const std::exception &) { // no memory, no thread
        close();
        return Status::open_failed;
    }
}

void HidTransport::close() noexcept {
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
    HidSession dropped;
    const std::lock_guard<std::mutex> lock(m.mutex);
    m.connected = false;
    m.link_number.fetch_add(1);
    m.reader = Impl::Borrowed();
    std::swap(dropped, m.session);
}

void HidTransport::Impl::refresh_reader() noexcept {
    const std::uint32_t link = link_number.load();
    if (link_read != link) {
        link_read = link;
        reader = borrow(&HidSession::reader);
        waiting = 0;
    }
}

bool HidTransport::wait_report(std::int64_t until_ns) noexcept {
    Impl &m = *impl_;
    m.refresh_reader();
    if (!m.reader.handle) {
        return false;
    }
    if (m.waiting == 0) {
        constexpr std::int64_t kNanosecondsPerMillisecond = 1'000'000;
        // Rounded up: a wait below 1 ms would be none, and the loop would spin.
        const std::int64_t wait_ms = (until_ns - monotonic_ns() + kNanosecondsPerMillisecond - 1) /
                                     kNanosecondsPerMillisecond;
        m.waiting = m.reader.handle->read(
            m.bytes, static_cast<int>(std::clamp<std::int64_t>(wait_ms, 0, kLongestWait_ms)));
    }
    return true;
}

Status HidTransport::read(DeviceReading &reading) noexcept {
    Impl &m = *impl_;
    m.refresh_reader();
    const Impl::Borrowed &reader = m.reader;
    if (!reader.handle) {
        return m.is_open.load() ? Status::read_failed : Status::not_open;
    }
    if (m.session_read != reader.session) {
        m.session_read = reader.session;
        m.intake.begin();
    }
    const std::uint32_t epoch_before = m.intake.epoch();
    std::uint64_t good = 0;
    for (int i = 0; i < kMostReportsAtOnce; ++i) {
        const int length = m.waiting != 0 ? m.waiting : reader.handle->read(m.bytes, 0);
        m.waiting = 0;
        if (length < 0) {
            m.lose(reader.session);
            return Status::read_failed;
        }
        if (length == 0) {
            break;
        }
        const auto size = static_cast<std::size_t>(length);
        good += m.intake.take(ReportBytes(m.bytes).first(size), m.bus->now_us()) ? 1U : 0U;
    }
    if (m.intake.epoch() != epoch_before && m.intake.restarted()) {
        m.zero_required.store(true);
    }
    if (good == 0) {
        return Status::read_timeout;
    }
    HidStatistics::add(m.statistics.superseded, good - 1);
    const StateReport &newest = m.intake.newest();
    const std::uint32_t epoch = m.intake.epoch();
    if (m.answered.load(std::memory_order_relaxed) >> kSequenceBits != (epoch & 0xFFFFU)) {
        m.start_after.store(newest.accepted_command, std::memory_order_relaxed);
    }
    m.answered.store((epoch << kSequenceBits) | newest.sequence, std::memory_order_release);
    reading.overtaken = static_cast<std::uint16_t>(good - 1);
    m.intake.fill(reading, m.zero_number.load(), !m.zero_required.load());
    return Status::ok;
}

CommandReport HidTransport::Impl::next_command(const DriveCommand &command,
                                               std::uint32_t newest_state) noexcept {
    if (epoch_written != newest_state >> kSequenceBits) {
        epoch_written = newest_state >> kSequenceBits;
        sequence = start_after.load(std::memory_order_relaxed);
        clearing = kClearingCommands;
    }
    sequence = next_sequence(sequence);
    CommandReport report;
    report.sequence = sequence;
    report.valid_for_ms = settings.command_valid_ms;
    report.answers_state = static_cast<std::uint16_t>(newest_state);
    report.host_time_us = static_cast<std::uint32_t>(bus->now_us());
    if (command.motors_on) {
        report.flags = command_flag::kEnable;
        clearing = 0;
        const std::uint16_t most = most_mn.load();
        for (std::size_t i = 0; i < report.tensions_mn.size(); ++i) {
            report.tensions_mn[i] = millinewtons(command.tensions_n[i], most);
        }
    } else if (command.clear_faults || clearing > 0) {
        report.flags = command_flag::kClearFaults;
        clearing = std::max(0, clearing - 1);
    }
    return report;
}

Status HidTransport::write(const DriveCommand &command) noexcept {
    Impl &m = *impl_;
    if (m.write_busy.exchange(true, std::memory_order_acq_rel)) {
        return Status::write_failed; // a write blocks in another thread
    }
    const Impl::Borrowed writer = m.borrow(&HidSession::writer);
    // Until the device has sent a report its command numbering is unknown.
    const std::uint32_t newest_state = m.answered.load(std::memory_order_acquire);
    Status status = Status::ok;
    if (!writer.handle) {
        status = m.is_open.load() ? Status::write_failed : Status::not_open;
    } else if (newest_state != 0) {
        const CommandReport report = m.next_command(command, newest_state);
        const auto bytes = encode(report);
        const std::uint64_t start_us = m.bus->now_us();
        m.statistics.sent(report.sequence, start_us);
        const int written = writer.handle->write(bytes);
        m.statistics.write_took(m.bus->now_us() - start_us);
        if (written == static_cast<int>(bytes.size())) {
            HidStatistics::add(m.statistics.commands);
        } else {
            HidStatistics::add(m.statistics.write_failures);
            m.lose(writer.session);
            status = Status::write_failed;
        }
    }
    m.write_busy.store(false, std::memory_order_release);
    return status;
}

Status HidTransport::zero(const CountArray &home_counts) noexcept {
    Impl &m = *impl_;
    const Impl::Borrowed control = m.borrow(&HidSession::control);
    if (!control.handle) {
        return Status::not_open;
    }
    const auto bytes = encode(HidZero{home_counts});
    if (control.handle->send_feature(bytes) < 0) {
        return Status::write_failed;
    }
    m.zero_number.fetch_add(1);
    m.zero_required.store(false);
    return Status::ok;
}

HidCapabilities HidTransport::capabilities() const noexcept {
    const std::lock_guard<std::mutex> lock(impl_->mutex);
    return impl_->session.capabilities;
}

HidLimits HidTransport::limits() const noexcept {
    const std::lock_guard<std::mutex> lock(impl_->mutex);
    return impl_->session.limits;
}

HidDeviceInfo HidTransport::device() const {
    const std::lock_guard<std::mutex> lock(impl_->mutex);
    return impl_->session.device;
}

std::string HidTransport::problem() const {
    return impl_->problem;
}

HidCounters HidTransport::counters() const noexcept {
    return impl_->statistics.counters();
}

HidTimes HidTransport::times() const noexcept {
    return impl_->statistics.times();
}

} // namespace spidar
