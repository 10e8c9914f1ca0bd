#include "device/loop/loop_timing.h"

namespace spidar {

namespace {

constexpr std::int64_t kNanosecondsPerSecond = 1'000'000'000;
// A cycle this late is counted; so many in a hundred are told.
constexpr std::int64_t kLate_ns = 1'000'000;
constexpr int kLateOfHundred = 3;

} // namespace

void LoopTiming::restart(double rate_hz) noexcept {
    lateness_.clear();
    step_time_.clear();
    missed_deadlines_.store(0, std::memory_order_relaxed);
    late_cycles_.store(0, std::memory_order_relaxed);
    measured_rate_hz_.store(rate_hz, std::memory_order_relaxed);
    real_time_priority_.store(false, std::memory_order_relaxed);
    cycles_of_hundred_ = 0;
    late_of_hundred_ = 0;
}

void LoopTiming::begin(std::int64_t now_ns) noexcept {
    second_began_ns_ = now_ns;
    cycles_of_second_ = 0;
}

bool LoopTiming::woken(std::int64_t late_ns) noexcept {
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

void LoopTiming::cycle_ended(std::int64_t woken_ns, std::int64_t now_ns) noexcept {
    step_time_.add(now_ns - woken_ns);
    ++cycles_of_second_;
    const std::int64_t window_ns = now_ns - second_began_ns_;
    if (window_ns >= kNanosecondsPerSecond) {
        measured_rate_hz_.store(static_cast<double>(cycles_of_second_) * 1e9 /
                                    static_cast<double>(window_ns),
                                std::memory_order_relaxed);
        begin(now_ns);
    }
}

void LoopTiming::missed(std::int64_t deadlines) noexcept {
    missed_deadlines_.fetch_add(static_cast<std::uint64_t>(deadlines), std::memory_order_relaxed);
}

LoopStatistics LoopTiming::statistics() const noexcept {
    constexpr double kMedian = 0.5;
    constexpr double kTail = 0.99;
    LoopStatistics statistics;
    statistics.measured_rate_hz = measured_rate_hz_.load(std::memory_order_relaxed);
    statistics.lateness_p50_us = lateness_.quantile_us(kMedian);
    statistics.lateness_p99_us = lateness_.quantile_us(kTail);
    statistics.lateness_max_us = lateness_.max_us();
    statistics.step_p50_us = step_time_.quantile_us(kMedian);
    statistics.step_p99_us = step_time_.quantile_us(kTail);
    statistics.missed_deadlines = missed_deadlines_.load(std::memory_order_relaxed);
    statistics.late_cycles = late_cycles_.load(std::memory_order_relaxed);
    statistics.real_time_priority = real_time_priority_.load(std::memory_order_relaxed);
    return statistics;
}

std::array<std::uint32_t, LoopHistogram::kBuckets> LoopTiming::lateness_counts() const noexcept {
    std::array<std::uint32_t, LoopHistogram::kBuckets> counts{};
    for (int i = 0; i < LoopHistogram::kBuckets; ++i) {
        counts[static_cast<std::size_t>(i)] = lateness_.count(i);
    }
    return counts;
}

} // namespace spidar
