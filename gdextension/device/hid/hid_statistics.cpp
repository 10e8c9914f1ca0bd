#include "device/hid/hid_statistics.h"

#include <algorithm>

namespace spidar {

namespace {

constexpr std::int64_t kNanosecondsPerMicrosecond = 1000;
constexpr double kMedian = 0.5;
constexpr double kTail = 0.99;
constexpr std::uint64_t kFewestRoundTrips = 200; // a fifth of a second at 1 kHz

} // namespace

double link_latency_s(const HidTimes &times, double report_rate_hz) noexcept {
    if (times.round_trips < kFewestRoundTrips || !(report_rate_hz > 0.0)) {
        return 0.0;
    }
    return std::max(0.0, 1e-6 * times.round_trip_p50_us - 0.5 / report_rate_hz);
}

void HidStatistics::sent(std::uint16_t sequence, std::uint64_t now_us) noexcept {
    sent_us_[sequence % kSendTimes].store(now_us, std::memory_order_release);
}

void HidStatistics::answered(std::uint16_t sequence, std::uint64_t now_us) noexcept {
    const std::uint64_t sent =
        sent_us_[sequence % kSendTimes].exchange(0, std::memory_order_acq_rel);
    if (sent != 0 && now_us >= sent) {
        round_trip_.add(static_cast<std::int64_t>(now_us - sent) * kNanosecondsPerMicrosecond);
    }
}

void HidStatistics::write_took(std::uint64_t time_us) noexcept {
    write_time_.add(static_cast<std::int64_t>(time_us) * kNanosecondsPerMicrosecond);
}

HidCounters HidStatistics::counters() const noexcept {
    return {reports,  superseded,       lost,           wrong_length, corrupt,
            replayed, out_of_order,     implausible,    stale,        restarts,
            commands, skipped_commands, write_failures, losses,       replugs};
}

HidTimes HidStatistics::times() const noexcept {
    HidTimes times;
    times.round_trips = round_trip_.total();
    times.round_trip_p50_us = round_trip_.quantile_us(kMedian);
    times.round_trip_p99_us = round_trip_.quantile_us(kTail);
    times.round_trip_max_us = round_trip_.max_us();
    times.write_p99_us = write_time_.quantile_us(kTail);
    times.write_max_us = write_time_.max_us();
    return times;
}

} // namespace spidar
