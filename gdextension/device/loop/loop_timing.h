// How punctual a loop's thread is: counted by that thread, read by any other at any time.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>

#include "device/threads/loop_histogram.h"

namespace spidar {

struct LoopStatistics {
    double measured_rate_hz = 0.0; // over the last second; the set rate when stepped
    double lateness_p50_us = 0.0;  // wake-up after the deadline; 0 when stepped
    double lateness_p99_us = 0.0;
    double lateness_max_us = 0.0;
    double step_p50_us = 0.0; // read + compute + write
    double step_p99_us = 0.0;
    std::uint64_t missed_deadlines = 0;
    std::uint64_t late_cycles = 0;   // more than 1 ms after the deadline
    bool real_time_priority = false; // SCHED_FIFO granted
};

class LoopTiming {
public:
    // While no thread runs. rate_hz: what measured_rate_hz says until a second was measured.
    void restart(double rate_hz) noexcept;

    // From the loop's thread.
    void set_real_time_priority(bool granted) noexcept {
        real_time_priority_.store(granted, std::memory_order_relaxed);
    }
    void begin(std::int64_t now_ns) noexcept;
    // A cycle begins so long after its deadline. True: too many of the last hundred came late.
    bool woken(std::int64_t late_ns) noexcept;
    void cycle_ended(std::int64_t woken_ns, std::int64_t now_ns) noexcept;
    void missed(std::int64_t deadlines) noexcept;

    [[nodiscard]] LoopStatistics statistics() const noexcept;
    // Samples of the lateness in each of LoopHistogram's buckets.
    [[nodiscard]] std::array<std::uint32_t, LoopHistogram::kBuckets>
    lateness_counts() const noexcept;

private:
    LoopHistogram lateness_;
    LoopHistogram step_time_;
    std::atomic<std::uint64_t> missed_deadlines_{0};
    std::atomic<std::uint64_t> late_cycles_{0};
    std::atomic<double> measured_rate_hz_{0.0};
    std::atomic<bool> real_time_priority_{false};
    // The thread's own: of the hundred cycles that are being counted, and of the second that is being measured.
    int cycles_of_hundred_ = 0;
    int late_of_hundred_ = 0;
    std::int64_t second_began_ns_ = 0;
    std::int64_t cycles_of_second_ = 0;
};

} // namespace spidar
