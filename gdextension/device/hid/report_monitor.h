// Checks whether a decoded report is the next one. Detects gaps, replays, reports out of order,
// jumps of the device's clock, and reports that waited too long in a queue. SampleGuard later
// checks the counts themselves.
#pragma once

#include <cstdint>

#include "device/hid/protocol/hid_protocol.h"

namespace spidar {

class ReportMonitor {
public:
    enum class Verdict : std::uint8_t {
        fresh,
        replayed,     // the sequence number of the last good report
        out_of_order, // older than the last good report
        // The device's clock stood still, went back or jumped.
        implausible_time,
        // Older on arrival, by kStale_us, than the freshest reports.
        stale,
        // Accepted as the new reference after kResyncReports refused in a row: the device
        // restarted, so that its zero is void.
        restarted,
    };

    // Largest extra age of a report (unit: us).
    static constexpr std::uint32_t kStale_us = 10'000;
    // Longest plausible gap between two reports (unit: us).
    static constexpr std::uint32_t kLongestSilence_us = 2'000'000;
    static constexpr int kResyncReports = 20;
    // Stale reports in a row (more than any queue holds) that mean the clocks have drifted apart.
    static constexpr int kStaleReports = 256;

    void reset() noexcept { *this = ReportMonitor(); }
    // host_us: the host's monotonic clock on arrival.
    Verdict check(const StateReport &report, std::uint64_t host_us) noexcept;

    // Number of reports missing before the last one when that was fresh or stale, else 0.
    [[nodiscard]] std::uint32_t lost() const noexcept { return lost_; }
    // Device time of the last good report, unwrapped (unit: us).
    [[nodiscard]] std::uint64_t device_time_us() const noexcept { return device_us_; }

private:
    void start(const StateReport &report, std::uint64_t host_us) noexcept;
    void advance(const StateReport &report, std::uint64_t device_us,
                 std::uint64_t host_us) noexcept;
    [[nodiscard]] Verdict judge(const StateReport &report, std::uint64_t host_us) noexcept;

    bool has_reference_ = false;
    std::uint16_t sequence_ = 0;
    std::uint32_t last_time_us_ = 0;
    std::uint64_t device_us_ = 0;
    std::uint64_t last_host_us_ = 0;
    double offset_us_ = 0.0; // host clock minus device clock for the freshest reports
    std::uint32_t lost_ = 0;
    int refused_in_row_ = 0;
    int stale_in_row_ = 0;
};

} // namespace spidar
