// Drives a device, or plays a recording, with ServoStep: in a real-time thread, or stepped in
// simulated time. One controlling thread (the game's) calls all functions unless stated otherwise.
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
    // A loop for a device.
    explicit ServoLoop(std::unique_ptr<Transport> transport);
    // A loop for a source with its own commands, such as a Replay (recording/replay.h).
    explicit ServoLoop(std::unique_ptr<CycleSource> source) : cycle_(std::move(source)) {}
    ~ServoLoop() { stop(); }
    ServoLoop(const ServoLoop &) = delete;
    ServoLoop &operator=(const ServoLoop &) = delete;

    // Opens the device and starts the thread. On failure nothing runs. With reopen_interval_s > 0 a
    // device that does not open is no failure: the state is closed until the thread has opened it.
    Status start_threaded(const ServoSettings &settings);
    // Opens the device; advance() then runs the cycles. On failure nothing runs.
    Status start_stepped(const ServoSettings &settings);
    // Switches the motors off, ends the thread and closes the device. Waits for a write in
    // progress. May be called at any time and repeatedly.
    void stop() noexcept;
    // Switches the motors off in the next cycle, or at once where a writer thread serves the
    // device. May be called from any thread at any time, and never waits. The motors stay off until
    // clear_fault() and arm(). When no loop runs or no device is open, the device later opens in
    // FAULT.
    void panic_stop() noexcept { cycle_.source().panic(); }
    // Time since the thread began its last cycle (unit: s), for a game to watch; 0 before the first
    // cycle and without a thread.
    [[nodiscard]] double since_last_cycle_s() const noexcept {
        return thread_.since_last_cycle_s();
    }
    // Takes the next event in order. Returns false when there is none up to until_s (snapshot
    // time).
    bool next_event(DeviceEvent &event,
                    double until_s = std::numeric_limits<double>::infinity()) noexcept {
        return cycle_.next_event(event, until_s);
    }
    [[nodiscard]] bool running() const noexcept { return is_running_; }
    [[nodiscard]] bool threaded() const noexcept { return thread_.running(); }

    // Stepped only: advances simulated time by numerator/denominator seconds in whole servo cycles
    // and carries the remainder exactly (1/60 s at 1 kHz gives 16 or 17 cycles). Returns the number
    // of cycles in this time, even if a replay ends before.
    int advance(std::uint32_t numerator, std::uint32_t denominator) noexcept;

    // Stepped only: runs whole cycles until the newest is `tick` or the replay ends.
    void advance_to(std::uint64_t tick) noexcept;

    // Publishes a command; the newest wins. Wait-free.
    void publish(const HapticCommand &command) noexcept { cycle_.source().publish(command); }
    // Publishes a command with a scene. The loop keeps the scene and its shapes alive until it
    // renders a newer one. Sets command.touch and command.touch_sequence.
    void publish(HapticCommand &command, std::shared_ptr<const TouchScene> touch);
    // Reads the newest snapshot. Returns true when it is newer than at the last call. Wait-free.
    bool latest(ServoSnapshot &snapshot) noexcept;
    [[nodiscard]] LoopStatistics statistics() const noexcept { return timing_.statistics(); }
    // Lateness of the thread's wake-ups since the start: cycles per bucket of LoopHistogram.
    [[nodiscard]] std::array<std::uint32_t, LoopHistogram::kBuckets>
    lateness_counts() const noexcept {
        return timing_.lateness().counts();
    }

    // Starts a recording with the next cycle, for a replay bit for bit. Returns an empty string, or
    // one sentence that says why nothing is recorded. On failure a running recording continues.
    // stop() ends a recording too.
    [[nodiscard]] std::string start_recording(const std::string &path) {
        return running() ? cycle_.recordings().start(path, settings_, threaded(), touches_)
                         : "No device is open: there is nothing to record. Open one first.";
    }
    void stop_recording() noexcept { cycle_.recordings().stop(); }
    [[nodiscard]] bool recording() const noexcept { return cycle_.recordings().recording(); }
    // Records what the game has just read, so that a replay gives it to the game at the same cycle.
    void note_read(const GameRead &read) noexcept { cycle_.recordings().note(read); }
    // Of the running recording, else of the last one.
    [[nodiscard]] RecorderStatistics recording_statistics() const noexcept {
        return cycle_.recordings().statistics();
    }

private:
    // Configures the cycle and opens the source.
    Status prepare(const ServoSettings &settings) noexcept;

    ServoCycle cycle_;
    LoopTiming timing_;
    ServoThread thread_{cycle_, timing_};
    TickAccumulator ticks_; // stepped only
    ServoSettings settings_;
    std::deque<NumberedTouch> touches_; // scenes that the loop's thread may still use
    bool is_running_ = false;
};

} // namespace spidar
