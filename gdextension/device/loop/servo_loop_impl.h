// What is behind ServoLoop: the cycle, the thread around it and its watchdogs. Included by servo_loop.cpp alone.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "device/loop/servo_loop.h"
#include "device/recording/recorder.h"
#include "device/recording/replay_transport.h"
#include "device/threads/event_queue.h"
#include "device/threads/nonblocking.h"
#include "device/threads/real_time_thread.h"
#include "device/threads/triple_buffer.h"
#include "device/threads/writer_thread.h"

namespace spidar {

// An advance() asking for more than this (a quarter of an hour at 1 kHz) is a mistake: the rest is dropped.
inline constexpr std::uint64_t kMostCyclesAtOnce = 1'000'000;
// Measured time steps of real devices stay within these: a wake-up too early or a suspended computer.
inline constexpr double kShortestStepPart = 0.25; // of the period
inline constexpr std::int64_t kNanosecondsPerSecond = 1'000'000'000;
// A cycle this late is counted; so many in a hundred are told.
inline constexpr std::int64_t kLate_ns = 1'000'000;
inline constexpr int kLateOfHundred = 3;
// A write that waits so long is told; one that waits longer is a device lost, whose firmware has let go by itself.
inline constexpr std::int64_t kBlocked_ns = 20'000'000;
inline constexpr std::int64_t kBlockedForGood_ns = 50'000'000;
// How long a thread that waits to open a device may keep a stop() waiting.
inline constexpr std::int64_t kNap_ns = 20'000'000;

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
        // In a replay the recorded commands are the only ones: what the game goes on asking for must not come between.
        bool command_is_new = replay == nullptr && commands.read(command);
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
        name_thread("spidar_servo");
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

} // namespace spidar
