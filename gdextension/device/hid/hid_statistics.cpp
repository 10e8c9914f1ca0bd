#include "device/hid/hid_statistics.h"

namespace spidar {

namespace {

constexpr std::int64_t kNanosecondsPerMicrosecond = 1000;
constexpr double kMedian = 0.5;
constexpr double kTail = 0.99;

} // namespace

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
    times.round_trip_p50_us = round_trip_.quantile_us(kMedian);
    times.round_trip_p99_us = round_trip_.quantile_us(kTail);
    times.round_trip_max_us = round_trip_.max_us();
    times.write_p99_us = write_time_.quantile_us(kTail);
    times.write_max_us = write_time_.max_us();
    return times;
}

} // namespace spidar
