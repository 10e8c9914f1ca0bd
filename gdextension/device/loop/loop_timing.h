// Punctuality of a loop's thread: counted by that thread, read by any other at any time.
#pragma once

#include <atomic>
#include <cstdint>

#include "device/threads/loop_histogram.h"

namespace spidar {

struct LoopStatistics {
    double measured_rate_hz = 0.0; // of the last whole second; the set rate when stepped
    double lateness_p50_us = 0.0;  // delay of the wake-up; 0 when stepped
    double lateness_p99_us = 0.0;
    double lateness_max_us = 0.0;
    double step_p50_us = 0.0; // read + compute + write
    double step_p99_us = 0.0;
    std::uint64_t missed_deadlines = 0;
    // Cycles that began more than 1 ms late.
    std::uint64_t late_cycles = 0;
    bool real_time_priority = false; // was granted
};

class LoopTiming {
public:
    // Called while no thread runs. rate_hz: value of measured_rate_hz until a second was measured.
    void restart(double rate_hz) noexcept {
        lateness_.clear();
        step_time_.clear();
        missed_deadlines_.store(0, std::memory_order_relaxed);
        late_cycles_.store(0, std::memory_order_relaxed);
        measured_rate_hz_.store(rate_hz, std::memory_order_relaxed);
        real_time_priority_.store(false, std::memory_order_relaxed);
        cycles_of_hundred_ = 0;
        late_of_hundred_ = 0;
    }

    // Starts the measurement of a second. This function and those up to missed() belong to the
    // loop's thread.
    void begin(std::int64_t now_ns) noexcept {
        second_began_ns_ = now_ns;
        cycles_of_second_ = 0;
    }
    void set_real_time_priority(bool granted) noexcept {
        real_time_priority_.store(granted, std::memory_order_relaxed);
    }
    // A cycle began late_ns after its deadline. At the end of each block of a hundred cycles,
    // returns true if more than kLateOfHundred of the block were late; else false.
    bool woken(std::int64_t late_ns) noexcept {
        lateness_.add(late_ns);
        const bool late = late_ns > kLate_ns;
        late_cycles_.fetch_add(late ? 1 : 0, std::memory_order_relaxed);
        late_of_hundred_ += late ? 1 : 0;
        if (++cycles_of_hundred_ < 100) {
            return false;
        }
        const bool too_many = late_of_hundred_ > kLateOfHundred;
        cycles_of_hundred_ = 0;
        late_of_hundred_ = 0;
        return too_many;
    }
    void cycle_ended(std::int64_t woken_ns, std::int64_t now_ns) noexcept {
        step_time_.add(now_ns - woken_ns);
        ++cycles_of_second_;
        const auto window_ns = static_cast<double>(now_ns - second_began_ns_);
        if (window_ns >= 1e9) {
            measured_rate_hz_.store(cycles_of_second_ * 1e9 / window_ns, std::memory_order_relaxed);
            begin(now_ns);
        }
    }
    void missed(std::int64_t deadlines) noexcept {
        missed_deadlines_.fetch_add(static_cast<std::uint64_t>(deadlines),
                                    std::memory_order_relaxed);
    }

    [[nodiscard]] LoopStatistics statistics() const noexcept {
        constexpr double kMedian = 0.5;
        constexpr double kTail = 0.99;
        return {measured_rate_hz_.load(std::memory_order_relaxed),
                lateness_.quantile_us(kMedian),
                lateness_.quantile_us(kTail),
                lateness_.max_us(),
                step_time_.quantile_us(kMedian),
                step_time_.quantile_us(kTail),
                missed_deadlines_.load(std::memory_order_relaxed),
                late_cycles_.load(std::memory_order_relaxed),
                real_time_priority_.load(std::memory_order_relaxed)};
    }
    [[nodiscard]] const LoopHistogram &lateness() const noexcept { return lateness_; }

private:
    // A cycle with a longer delay counts as late.
    static constexpr std::int64_t kLate_ns = 1'000'000;
    // Largest number of late cycles in a block of a hundred that is not reported.
    static constexpr int kLateOfHundred = 3;

    LoopHistogram lateness_;
    LoopHistogram step_time_;
    std::atomic<std::uint64_t> missed_deadlines_{0};
    std::atomic<std::uint64_t> late_cycles_{0};
    std::atomic<double> measured_rate_hz_{0.0};
    std::atomic<bool> real_time_priority_{false};
    // Used by the loop's thread only: late and total cycles of the current hundred, start and
    // cycles of the current second.
    int cycles_of_hundred_ = 0;
    int late_of_hundred_ = 0;
    std::int64_t second_began_ns_ = 0;
    int cycles_of_second_ = 0;
};

} // namespace spidar
