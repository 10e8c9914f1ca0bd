// The real-time thread that runs servo cycles against the clock, or at the device's own reports.
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

    // open_status: of the source. While it is not open, the thread opens it again each reopen_interval_s.
    // open_failed: the system has no thread left.
    Status start(const ServoSettings &settings, Status open_status) noexcept;
    // Motors off, then joined.
    void stop() noexcept;
    [[nodiscard]] bool running() const noexcept { return thread_.joinable(); }
    // Since the last cycle began (unit: s); 0 when no thread runs. From any thread.
    [[nodiscard]] double since_last_cycle_s() const noexcept;

private:
    void run() noexcept;
    // False: stopped before the source opened.
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
