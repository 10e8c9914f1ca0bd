// Drives a device, or plays a recording again, by ServoStep: in a real-time thread of its own, or stepped in simulated
// time. One controlling thread (the game's) calls everything here.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <limits>
#include <memory>
#include <string>

#include "device/contact/touch/touch_scene.h"
#include "device/contract/transport.h"
#include "device/loop/loop_timing.h"
#include "device/loop/servo_cycle.h"
#include "device/loop/servo_thread.h"
#include "device/loop/tick_accumulator.h"

namespace spidar {

class ServoLoop {
public:
    // A device.
    explicit ServoLoop(std::unique_ptr<Transport> transport);
    // What brings its own commands: a Replay (recording/replay.h).
    explicit ServoLoop(std::unique_ptr<CycleSource> source) : cycle_(std::move(source)) {}
    ~ServoLoop() { stop(); }
    ServoLoop(const ServoLoop &) = delete;
    ServoLoop &operator=(const ServoLoop &) = delete;

    // Opens the device. On failure nothing runs, unless reopen_interval_s lets the thread try again: then the
    // state is closed until the device opens.
    Status start_threaded(const ServoSettings &settings);
    Status start_stepped(const ServoSettings &settings);
    // Motors to zero, thread joined, then the handle closed. Safe at any time, twice too. Waits for a write that is
    // under way.
    void stop() noexcept;
    // From any thread, at any time, one atomic: the motors go off in the next cycle, and at once where a writer thread
    // serves the device. Latched: clear_fault() and arm() lead back. While no loop runs, or no device is open, it is
    // remembered: the device opens in FAULT.
    void panic_stop() noexcept { cycle_.source().panic(); }
    // Since the thread began its last cycle (unit: s); 0 when none runs. What a game watches the loop by.
    [[nodiscard]] double since_last_cycle_s() const noexcept {
        return thread_.since_last_cycle_s();
    }
    // What happened, in order. False: nothing more, or nothing before until_s (snapshot time). From the controlling
    // thread.
    bool next_event(DeviceEvent &event,
                    double until_s = std::numeric_limits<double>::infinity()) noexcept {
        return cycle_.next_event(event, until_s);
    }
    [[nodiscard]] bool running() const noexcept { return is_running_; }
    [[nodiscard]] bool threaded() const noexcept { return thread_.running(); }

    // Stepped only: advance by numerator/denominator seconds of simulated time in whole servo cycles; the rest
    // is carried (rational accumulator: 1/60 s at 1 kHz gives 16 or 17 cycles). Returns the cycles run.
    int advance(std::uint32_t numerator, std::uint32_t denominator) noexcept;

    // Stepped only: whole cycles until the newest one is `tick`, or a replay is at its end.
    void advance_to(std::uint64_t tick) noexcept;

    // Newest command wins. Wait-free.
    void publish(const HapticCommand &command) noexcept { cycle_.source().publish(command); }
    // The same with the scene that command.touch shall point to: kept, with its shapes, until the loop renders a newer one.
    void publish(HapticCommand &command, std::shared_ptr<const TouchScene> touch);
    // The newest snapshot. True when it is newer than at the last call. Wait-free.
    bool latest(ServoSnapshot &snapshot) noexcept;
    [[nodiscard]] LoopStatistics statistics() const noexcept { return timing_.statistics(); }
    // How late the thread woke, all cycles since the start: samples in each of LoopHistogram's buckets.
    [[nodiscard]] std::array<std::uint32_t, LoopHistogram::kBuckets>
    lateness_counts() const noexcept {
        return timing_.lateness().counts();
    }

    // Every cycle from the next one on goes into a file that replays to the bit. Empty: recording. Else one sentence;
    // a recording that runs goes on. stop() ends a recording too.
    [[nodiscard]] std::string start_recording(const std::string &path) {
        return running() ? cycle_.recordings().start(path, settings_, threaded(), touches_)
                         : "No device is open: there is nothing to record. Open one first.";
    }
    void stop_recording() noexcept { cycle_.recordings().stop(); }
    [[nodiscard]] bool recording() const noexcept { return cycle_.recordings().recording(); }
    // What the game has just read of this loop: a recording keeps it, so that a replay hands it out in the same way.
    void note_read(const GameRead &read) noexcept { cycle_.recordings().note(read); }
    // Of the recording that runs, or else of the last one.
    [[nodiscard]] RecorderStatistics recording_statistics() const noexcept {
        return cycle_.recordings().statistics();
    }

private:
    // Ready for the first cycle, and the source open if it can be.
    Status prepare(const ServoSettings &settings) noexcept;

    ServoCycle cycle_;
    LoopTiming timing_;
    ServoThread thread_{cycle_, timing_};
    TickAccumulator ticks_; // stepped
    ServoSettings settings_;
    std::deque<NumberedTouch> touches_; // that the loop's thread may still look at
    bool is_running_ = false;
};

} // namespace spidar
