// The real-time thread that runs servo cycles, timed by the clock or by the device's reports.
#pragma once

#include <atomic>
#include <cstdint>
#include <thread>

#include "device/loop/loop_timing.h"
#include "device/loop/servo_cycle.h"

namespace spidar {

class ServoThread {
public:
    ServoThread(ServoCycle &cycle, LoopTiming &timing) noexcept : cycle_(cycle), timing_(timing) {}

    // open_status: result of opening the source. While the source is not open, the thread tries
    // again every reopen_interval_s. Returns open_failed when the system can start no thread.
    Status start(const ServoSettings &settings, Status open_status) noexcept;
    // Switches the motors off and joins the thread.
    void stop() noexcept;
    [[nodiscard]] bool running() const noexcept { return thread_.joinable(); }
    // Time since the last cycle began (unit: s); 0 before the first cycle and when no thread runs.
    // Called from any thread.
    [[nodiscard]] double since_last_cycle_s() const noexcept;

private:
    void run() noexcept;
    // Opens the source, with retries. Returns false when stopped before the source opened.
    bool open_patiently() noexcept;
    void run_cycles() noexcept;

    ServoCycle &cycle_;
    LoopTiming &timing_;
    std::thread thread_;
    std::atomic<bool> stop_asked_{false};
    std::atomic<std::int64_t> cycle_began_ns_{0}; // 0: no thread
    Status open_status_ = Status::ok;
    double period_s_ = 0.001;
    double reopen_interval_s_ = 0.0;
};

} // namespace spidar
