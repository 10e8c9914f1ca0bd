// One servo cycle after the other: read, compute, write; and what the rest of the program sees of it.
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

    // At rest. What was asked and what happened before does not act after it.
    Status configure(const ServoSettings &settings) noexcept;
    // While no cycle runs and the source is open: the motors are as warm as an earlier loop left them, and what they are
    // now is kept for a later one. False: there is no memory for it.
    void recall_heat() noexcept;
    bool keep_heat() noexcept;
    // While no cycle runs and the source is open: a source that begins in the middle shows what came before.
    void recall() noexcept;
    // From the loop's thread: one cycle of this length. False: the source has none left.
    bool run(double dt_s) noexcept SPIDAR_NONBLOCKING;
    // Where no cycle runs: what a reader sees of a device that did not open, or was closed.
    void show_open_failed(Status why) noexcept;
    void show_closed() noexcept;

    [[nodiscard]] CycleSource &source() noexcept { return *source_; }
    [[nodiscard]] Recordings &recordings() noexcept { return recordings_; }
    [[nodiscard]] const Recordings &recordings() const noexcept { return recordings_; }
    // The cycle that was shown last. From the loop's thread.
    [[nodiscard]] std::uint64_t tick() const noexcept { return tick_; }
    // Of the host, beside the step's. From the loop's thread.
    [[nodiscard]] EventLog &host_events() noexcept { return host_events_; }
    // From the controlling thread; false: nothing new.
    bool latest(ServoSnapshot &snapshot) noexcept { return snapshots_.read(snapshot); }
    // False as well when the next event happened after until_s, in snapshot time.
    bool next_event(DeviceEvent &event, double until_s) noexcept {
        const DeviceEvent *const waiting = events_.oldest();
        return waiting != nullptr && !(waiting->time_s > until_s) && events_.take(event);
    }

private:
    // When nobody reads them, the newest are dropped.
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
