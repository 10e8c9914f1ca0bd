// Runs servo cycles (read, compute, write) and publishes their results.
#pragma once

#include <memory>

#include "device/loop/recordings.h"
#include "device/step/cycle_source.h"
#include "device/step/servo_step.h"
#include "device/threads/nonblocking.h"
#include "device/threads/spsc_ring.h"
#include "device/threads/triple_buffer.h"

namespace spidar {

class ServoCycle {
public:
    explicit ServoCycle(std::unique_ptr<CycleSource> source) : source_(std::move(source)) {
        step_.use(&touch_memory_);
    }

    // Called while no cycle runs. Earlier commands have no effect on later cycles, except a panic
    // stop that was not cleared. On a negative status the old settings stay.
    Status configure(const ServoSettings &settings) noexcept;
    // Sets the motors' heat to the stored heat of an earlier loop, less the cooling since then.
    // Called while no cycle runs and the source is open.
    void recall_heat() noexcept;
    // Stores the motors' heat for a later loop. Called while no cycle runs and the source is open.
    // Returns false if memory cannot be allocated.
    bool keep_heat() noexcept;
    // If the source is a recording that begins in the middle, publishes the state before its first
    // cycle. Called while no cycle runs and the source is open.
    void recall() noexcept;
    // Runs one cycle of dt_s in the loop's thread. Returns false when the source is exhausted.
    bool run(double dt_s) noexcept SPIDAR_NONBLOCKING;
    // Publishes the snapshot of an unopened device, and an event. Called while no cycle runs.
    void show_open_failed(Status why) noexcept;
    // Publishes the snapshot of a closed device. Called while no cycle runs.
    void show_closed() noexcept;

    [[nodiscard]] CycleSource &source() noexcept { return *source_; }
    [[nodiscard]] Recordings &recordings() noexcept { return recordings_; }
    [[nodiscard]] const Recordings &recordings() const noexcept { return recordings_; }
    // Number of the last published cycle. Called from the loop's thread.
    [[nodiscard]] std::uint64_t tick() const noexcept { return tick_; }
    // Events of the host, besides those of the step. Called from the loop's thread.
    [[nodiscard]] EventLog &host_events() noexcept { return host_events_; }
    // Controlling thread: reads the newest snapshot. Returns false when there is no new one.
    bool latest(ServoSnapshot &snapshot) noexcept { return snapshots_.read(snapshot); }
    // Takes the oldest event. Returns false when there is none up to until_s (snapshot time).
    bool next_event(DeviceEvent &event, double until_s) noexcept {
        const DeviceEvent *const waiting = events_.oldest();
        return waiting != nullptr && !(waiting->time_s > until_s) && events_.take(event);
    }

private:
    // Size of the event queue. When it is full, the newest events are dropped.
    static constexpr std::size_t kWaitingEvents = 256;

    std::unique_ptr<CycleSource> source_;
    ProxyMemory touch_memory_;
    ServoStep step_;
    double thermal_time_s_ = 0.0;
    std::uint64_t tick_ = 0;
    CycleGiven given_;
    Recordings recordings_;
    EventLog host_events_;
    SpscRing<DeviceEvent> events_{kWaitingEvents};
    TripleBuffer<ServoSnapshot> snapshots_;
};

} // namespace spidar
