#include "device/servo_loop.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <system_error>
#include <vector>

#include "device/event_queue.h"
#include "device/nonblocking.h"
#include "device/real_time_thread.h"
#include "device/recording/recorder.h"
#include "device/recording/replay_transport.h"
#include "device/triple_buffer.h"
#include "device/writer_thread.h"

namespace spidar {

namespace {

// An advance() asking for more than this (a quarter of an hour at 1 kHz) is a mistake: the rest is dropped.
constexpr std::uint64_t kMostCyclesAtOnce = 1'000'000;
// Measured time steps of real devices stay within these: a wake-up too early or a suspended computer.
constexpr double kShortestStepPart = 0.25; // of the period
constexpr double kLongestStep_s = 0.05;
constexpr std::int64_t kNanosecondsPerSecond = 1'000'000'000;
// A cycle this late is counted; so many in a hundred are told.
constexpr std::int64_t kLate_ns = 1'000'000;
constexpr int kLateOfHundred = 3;
// A write that waits so long is told; one that waits longer is a device lost, whose firmware has let go by itself.
constexpr std::int64_t kBlocked_ns = 20'000'000;
constexpr std::int64_t kBlockedForGood_ns = 50'000'000;
// How long a thread that waits to open a device may keep a stop() waiting.
constexpr std::int64_t kNap_ns = 20'000'000;

} // namespace

struct ServoLoop::Impl {
    std::unique_ptr<Transport> transport;
    ReplayTransport *replay = nullptr; // the transport, when it is one
    ServoStep step;
    HapticCommand command;
    DeviceReading reading;
    TripleBuffer<HapticCommand> commands;
    TripleBuffer<ServoSnapshot> snapshots;

    std::thread thread;
    std::atomic<bool> stop_asked{false};
    bool is_running = false; // the controlling thread's own
    bool is_threaded = false;

    // Started when the loop has a thread and the transport's write may block.
    std::optional<WriterThread> writer;
    bool use_writer = false;
    EventQueue events;
    EventLog own_events; // of the loop, beside the step's
    std::atomic<std::uint32_t> panics{0};
    std::uint32_t panics_seen = 0;
    std::uint32_t stops = 0;
    Status stop_reason = Status::ok;
    bool write_is_blocked = false;
    std::atomic<std::int64_t> cycle_began_ns{0}; // 0: no thread
    std::atomic<std::uint64_t> late_cycles{0};
    int hundred = 0; // cycles of the hundred that is being counted, and how many of them were late
    int late_of_hundred = 0;
    Status open_status = Status::ok;

    // The one that records now is the last. One that was closed stays until the loop has surely let go of it.
    struct OwnedRecorder {
        std::unique_ptr<Recorder> recorder;
        std::uint64_t free_at_cycle = UINT64_MAX;
    };
    std::vector<OwnedRecorder> recorders;
    std::atomic<Recorder *> recorder{nullptr};
    std::atomic<std::uint64_t> cycles_done{0};
    RecorderStatistics last_recording;

    ServoSettings settings_in_use;
    double rate_hz = 1000.0;
    double period_s = 0.001;
    // Stepped: the part of a cycle not run yet, in units of 1 / carry_denominator cycles.
    std::uint64_t carry = 0;
    std::uint64_t carry_denominator = 1;

    LoopHistogram lateness;
    LoopHistogram step_time;
    std::atomic<std::uint64_t> missed_deadlines{0};
    std::atomic<double> measured_rate_hz{0.0};
    std::atomic<bool> real_time_priority{false};

    // Read, compute, write in one cycle; then simulated time moves on.
    void cycle(double dt_s) noexcept SPIDAR_NONBLOCKING {
        Recorder *const recording = recorder.load(std::memory_order_acquire);
        bool may_arm_itself = transport->simulated();
        bool command_is_new = commands.read(command);
        if (replay != nullptr) {
            if (!replay->next(step, command, dt_s)) {
                return; // the end: what was last shown stays
            }
            may_arm_itself = replay->may_arm_itself();
            command_is_new = true;
        } else if (watch_host()) {
            command_is_new = true;
        }
        command.stop_count = replay != nullptr ? command.stop_count : stops;
        command.stop_reason = replay != nullptr ? command.stop_reason : stop_reason;
        const Status read = transport->read(reading);
        if (recording != nullptr) {
            recording->begin(step);
        }
        const DriveCommand drive = step.step(read, reading, command, dt_s, may_arm_itself);
        const bool lost = step.snapshot().state == DeviceState::closed;
        const Status written = write(drive);
        if (!lost) {
            step.report_write(written); // a lost device is not lost a second time
        }
        if (recording != nullptr) {
            recording->end({reading, dt_s, read, written, may_arm_itself}, drive, step.snapshot(),
                           command, command_is_new);
        }
        if (replay != nullptr) {
            replay->compare(step.snapshot(), drive);
        }
        for (const DeviceEvent &event : step.events()) {
            events.push(event);
        }
        for (const DeviceEvent &event : own_events.events()) {
            events.push(event);
        }
        own_events.begin_cycle(step.snapshot().time_s);
        snapshots.write(step.snapshot());
        transport->advance(dt_s);
        cycles_done.store(cycles_done.load(std::memory_order_relaxed) + 1,
                          std::memory_order_release);
    }

    // Reasons of the host's own to switch the motors off. True: there is a new one.
    bool watch_host() noexcept {
        const std::uint32_t before = stops;
        const std::uint32_t asked = panics.load(std::memory_order_acquire);
        if (asked != panics_seen) {
            panics_seen = asked;
            ++stops;
            stop_reason = Status::panic_stopped;
        }
        if (use_writer) {
            if (writer->take_stalled()) {
                ++stops;
                stop_reason = Status::loop_stalled;
            }
            const std::int64_t blocked_ns = writer->blocked_ns(monotonic_ns());
            if (blocked_ns > kBlocked_ns) {
                own_events.tell(DeviceEventKind::write_blocked, -1,
                                static_cast<double>(blocked_ns) * 1e-9);
            }
            const bool for_good = blocked_ns > kBlockedForGood_ns;
            if (for_good && !write_is_blocked) {
                ++stops;
                stop_reason = Status::write_failed;
            }
            write_is_blocked = for_good;
        }
        return stops != before;
    }

    Status write(const DriveCommand &drive) noexcept {
        if (!use_writer) {
            return transport->write(drive);
        }
        writer->post(drive);
        if (!drive.motors_on) {
            writer->allow(); // what a panic forbade is off in what is posted, too
        }
        return writer->take_result();
    }

    void count_late(std::int64_t late_ns) noexcept {
        lateness.add(late_ns);
        const bool late = late_ns > kLate_ns;
        late_cycles.fetch_add(late ? 1 : 0, std::memory_order_relaxed);
        late_of_hundred += late ? 1 : 0;
        if (++hundred >= 100) {
            if (late_of_hundred > kLateOfHundred) {
                own_events.tell(DeviceEventKind::cycles_late, -1,
                                static_cast<double>(late_ns) * 1e-9);
            }
            hundred = 0;
            late_of_hundred = 0;
        }
    }

    // The device did not open: tells it, and tries again until it does or the loop is stopped.
    bool open_patiently() noexcept {
        ServoSnapshot closed;
        closed.fault = open_status;
        snapshots.write(closed);
        events.push({0.0, 0.0, DeviceEventKind::open_failed, -1, 0});
        const auto wait_ns =
            static_cast<std::int64_t>(std::llround(settings_in_use.reopen_interval_s * 1e9));
        while (!usable(open_status)) {
            const std::int64_t next_ns = monotonic_ns() + wait_ns;
            for (std::int64_t now_ns = monotonic_ns(); now_ns < next_ns; now_ns = monotonic_ns()) {
                if (stop_asked.load(std::memory_order_acquire)) {
                    return false;
                }
                sleep_until_ns(std::min(next_ns, now_ns + kNap_ns));
            }
            open_status = transport->open();
        }
        return true;
    }

    Status prepare(const ServoSettings &settings) noexcept {
        const HapticCommand before = command;
        const Status configured = step.configure(settings);
        if (!usable(configured)) {
            return configured;
        }
        command = before;
        commands.read(command);
        step.acknowledge(command);
        settings_in_use = settings;
        rate_hz = settings.rate_hz;
        period_s = 1.0 / rate_hz;
        reading = DeviceReading();
        carry = 0;
        carry_denominator = 1;
        lateness.clear();
        step_time.clear();
        missed_deadlines.store(0, std::memory_order_relaxed);
        measured_rate_hz.store(0.0, std::memory_order_relaxed);
        real_time_priority.store(false, std::memory_order_relaxed);
        stop_asked.store(false, std::memory_order_relaxed);
        late_cycles.store(0, std::memory_order_relaxed);
        own_events = EventLog();
        panics_seen = panics.load(std::memory_order_acquire);
        stops = 0;
        write_is_blocked = false;
        hundred = 0;
        late_of_hundred = 0;
        open_status = transport->open();
        return open_status;
    }

    void run() noexcept {
        const FlushDenormals flush;
        real_time_priority.store(request_real_time(), std::memory_order_relaxed);
        if (!usable(open_status) && !open_patiently()) {
            return;
        }
        if (!real_time_priority.load(std::memory_order_relaxed)) {
            own_events.tell(DeviceEventKind::no_real_time_priority);
        }
        const auto period_ns = static_cast<std::int64_t>(std::llround(period_s * 1e9));
        const bool simulated = transport->simulated();
        std::int64_t deadline_ns = monotonic_ns() + period_ns;
        std::int64_t last_ns = deadline_ns - period_ns;
        std::int64_t window_start_ns = last_ns;
        std::int64_t window_cycles = 0;
        while (!stop_asked.load(std::memory_order_acquire)) {
            const bool clocked =
                settings_in_use.device_clocked && transport->wait_report(deadline_ns + period_ns);
            if (!clocked) {
                sleep_until_ns(deadline_ns);
            }
            const std::int64_t woken_ns = monotonic_ns();
            cycle_began_ns.store(woken_ns, std::memory_order_release);
            count_late(woken_ns - deadline_ns);
            deadline_ns = clocked ? woken_ns : deadline_ns;
            const double measured_s = static_cast<double>(woken_ns - last_ns) * 1e-9;
            last_ns = woken_ns;
            // A step longer than the longest is a computer that slept: the step is told the truth.
            const double step_s = std::max(measured_s, kShortestStepPart * period_s);
            cycle(simulated ? period_s : step_s);
            const std::int64_t done_ns = monotonic_ns();
            step_time.add(done_ns - woken_ns);

            deadline_ns += period_ns;
            if (done_ns > deadline_ns) { // skip what is missed; catching up would only jerk
                const std::int64_t missed = (done_ns - deadline_ns) / period_ns + 1;
                missed_deadlines.fetch_add(static_cast<std::uint64_t>(missed),
                                           std::memory_order_relaxed);
                deadline_ns += missed * period_ns;
            }
            ++window_cycles;
            const std::int64_t window_ns = done_ns - window_start_ns;
            if (window_ns >= kNanosecondsPerSecond) {
                measured_rate_hz.store(static_cast<double>(window_cycles) * 1e9 /
                                           static_cast<double>(window_ns),
                                       std::memory_order_relaxed);
                window_start_ns = done_ns;
                window_cycles = 0;
            }
        }
        if (!use_writer) {
            transport->write(DriveCommand()); // motors off, in the thread that owns the device
        }
    }
};

ServoLoop::ServoLoop(std::unique_ptr<Transport> transport) : impl_(std::make_unique<Impl>()) {
    impl_->transport = std::move(transport);
    impl_->replay = impl_->transport->as_replay();
    impl_->writer.emplace(*impl_->transport);
}

ServoLoop::~ServoLoop() {
    stop();
}

Status ServoLoop::start_stepped(const ServoSettings &settings) {
    stop();
    const Status status = impl_->prepare(settings);
    if (!usable(status)) {
        return status;
    }
    impl_->measured_rate_hz.store(settings.rate_hz, std::memory_order_relaxed);
    impl_->use_writer = false;
    impl_->is_running = true;
    impl_->is_threaded = false;
    return status;
}

Status ServoLoop::start_threaded(const ServoSettings &settings) {
    stop();
    const Status status = impl_->prepare(settings);
    // Settings that are wrong stay wrong; a device may still be plugged in.
    const bool waits = settings.reopen_interval_s > 0.0 && status <= Status::not_open;
    if (!usable(status) && !waits) {
        return status;
    }
    impl_->use_writer = impl_->transport->write_may_block();
    if (impl_->use_writer && !usable(impl_->writer->start())) {
        impl_->transport->close();
        return Status::open_failed;
    }
    try {
        impl_->thread = std::thread([impl = impl_.get()] { impl->run(); });
    } catch (const std::system_error &) { // the system has no thread left
        impl_->writer->stop();
        impl_->transport->close();
        return Status::open_failed;
    }
    impl_->is_running = true;
    impl_->is_threaded = true;
    return Status::ok;
}

void ServoLoop::stop() noexcept {
    if (!impl_->is_running) {
        return;
    }
    if (impl_->is_threaded) {
        impl_->stop_asked.store(true, std::memory_order_release);
        impl_->thread.join();
        impl_->writer->stop(); // motors off
        impl_->cycle_began_ns.store(0, std::memory_order_release);
    } else {
        impl_->transport->write(DriveCommand());
    }
    stop_recording();
    impl_->recorders.clear(); // the loop rests: none is in use
    impl_->transport->close();
    impl_->is_running = false;
    impl_->is_threaded = false;
    // What a reader sees from now on: no device, no force.
    ServoSnapshot last = impl_->step.snapshot();
    last.state = DeviceState::closed;
    last.tensions_n = {};
    last.requested = Wrench();
    last.achieved = Wrench();
    last.force_scale = 0.0;
    last.at_min_mask = 0;
    last.at_max_mask = 0;
    last.grip.twist = Twist();
    last.grip.status = Status::not_open;
    impl_->snapshots.write(last);
}

bool ServoLoop::running() const noexcept {
    return impl_->is_running;
}

bool ServoLoop::threaded() const noexcept {
    return impl_->is_threaded;
}

int ServoLoop::advance(std::uint32_t numerator, std::uint32_t denominator) noexcept {
    Impl &impl = *impl_;
    if (!impl.is_running || impl.is_threaded || denominator == 0) {
        return 0;
    }
    // The rate as a fraction of whole millihertz keeps the sum exact: no drift in an hour of ticks.
    constexpr std::uint64_t kMillihertz = 1000;
    const auto rate_mhz =
        static_cast<std::uint64_t>(std::llround(impl.rate_hz * static_cast<double>(kMillihertz)));
    const std::uint64_t unit = denominator * kMillihertz;
    if (unit != impl.carry_denominator) { // another tick length: the rest to the nearest new unit
        const double part =
            static_cast<double>(impl.carry) / static_cast<double>(impl.carry_denominator);
        impl.carry = static_cast<std::uint64_t>(std::llround(part * static_cast<double>(unit)));
        impl.carry_denominator = unit;
    }
    const std::uint64_t sum = impl.carry + numerator * rate_mhz;
    impl.carry = sum % unit;
    const std::uint64_t cycles = std::min(sum / unit, kMostCyclesAtOnce);
    const FlushDenormals flush;
    for (std::uint64_t i = 0; i < cycles; ++i) {
        impl.cycle(impl.period_s);
    }
    return static_cast<int>(cycles);
}

void ServoLoop::publish(const HapticCommand &command) noexcept {
    impl_->commands.write(command);
}

void ServoLoop::panic_stop() noexcept {
    impl_->panics.fetch_add(1, std::memory_order_acq_rel);
    impl_->writer->forbid();
}

double ServoLoop::since_last_cycle_s() const noexcept {
    const std::int64_t began_ns = impl_->cycle_began_ns.load(std::memory_order_acquire);
    return began_ns != 0 ? static_cast<double>(monotonic_ns() - began_ns) * 1e-9 : 0.0;
}

bool ServoLoop::next_event(DeviceEvent &event) noexcept {
    return impl_->events.pop(event);
}

bool ServoLoop::latest(ServoSnapshot &snapshot) noexcept {
    return impl_->snapshots.read(snapshot);
}

LoopStatistics ServoLoop::statistics() const noexcept {
    const Impl &impl = *impl_;
    LoopStatistics statistics;
    statistics.measured_rate_hz = impl.measured_rate_hz.load(std::memory_order_relaxed);
    constexpr double kMedian = 0.5;
    constexpr double kTail = 0.99;
    statistics.lateness_p50_us = impl.lateness.quantile_us(kMedian);
    statistics.lateness_p99_us = impl.lateness.quantile_us(kTail);
    statistics.lateness_max_us = impl.lateness.max_us();
    statistics.step_p50_us = impl.step_time.quantile_us(kMedian);
    statistics.step_p99_us = impl.step_time.quantile_us(kTail);
    statistics.missed_deadlines = impl.missed_deadlines.load(std::memory_order_relaxed);
    statistics.late_cycles = impl.late_cycles.load(std::memory_order_relaxed);
    statistics.real_time_priority = impl.real_time_priority.load(std::memory_order_relaxed);
    return statistics;
}

std::array<std::uint32_t, LoopHistogram::kBuckets> ServoLoop::lateness_counts() const noexcept {
    std::array<std::uint32_t, LoopHistogram::kBuckets> counts{};
    for (int i = 0; i < LoopHistogram::kBuckets; ++i) {
        counts[static_cast<std::size_t>(i)] = impl_->lateness.count(i);
    }
    return counts;
}

std::string ServoLoop::start_recording(const std::string &path) {
    Impl &impl = *impl_;
    if (!impl.is_running) {
        return "No device is open: there is nothing to record. Open one first.";
    }
    if (recording()) {
        return "A recording runs already. Stop it before the next one starts.";
    }
    const std::uint64_t done = impl.cycles_done.load(std::memory_order_acquire);
    std::erase_if(impl.recorders, [done, &impl](const Impl::OwnedRecorder &owned) {
        return !impl.is_threaded || done >= owned.free_at_cycle;
    });
    auto recorder = std::make_unique<Recorder>(impl.settings_in_use, impl.is_threaded);
    std::string problem = recorder->open(path);
    if (problem.empty()) {
        impl.recorders.push_back({std::move(recorder)});
        impl.recorder.store(impl.recorders.back().recorder.get(), std::memory_order_release);
    }
    return problem;
}

void ServoLoop::stop_recording() noexcept {
    Recorder *const recorder = impl_->recorder.exchange(nullptr, std::memory_order_acq_rel);
    if (recorder != nullptr) {
        // The cycle that runs now may hold it, and the one that is about to begin has not seen the change.
        constexpr std::uint64_t kCyclesToLetGo = 2;
        impl_->recorders.back().free_at_cycle =
            impl_->cycles_done.load(std::memory_order_acquire) + kCyclesToLetGo;
        recorder->close();
        impl_->last_recording = recorder->statistics();
    }
}

bool ServoLoop::recording() const noexcept {
    return impl_->recorder.load(std::memory_order_relaxed) != nullptr;
}

RecorderStatistics ServoLoop::recording_statistics() const noexcept {
    const Recorder *const recorder = impl_->recorder.load(std::memory_order_relaxed);
    return recorder != nullptr ? recorder->statistics() : impl_->last_recording;
}

Transport &ServoLoop::transport() noexcept {
    return *impl_->transport;
}

} // namespace spidar
