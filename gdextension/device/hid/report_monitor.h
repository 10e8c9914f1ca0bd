// Checks whether a decoded report is newer than the last good one. Detects missing, repeated and
// late reports, reports out of order and jumps of the device's clock. SampleGuard later checks the
// counts themselves.
#pragma once

#include <cstdint>

#include "device/hid/protocol/hid_protocol.h"

namespace spidar {

class ReportMonitor {
public:
    enum class Verdict : std::uint8_t {
        fresh,
        replayed,     // has the sequence number of the last good report
        out_of_order, // is older than the last good report
        // The device's clock stood still, went back or jumped by more than kLongestSilence_us.
        implausible_time,
        // The way from the device took over kStale_us longer than that of the fastest reports.
        stale,
        // The last of kResyncReports reports in a row that were replayed, out_of_order or
        // implausible_time. It is accepted: the device has restarted and lost its zero.
        restarted,
    };

    // A report that is older than this on arrival, relative to the fastest, is stale (unit: us).
    static constexpr std::uint32_t kStale_us = 10'000;
    // Longest plausible gap between two reports (unit: us).
    static constexpr std::uint32_t kLongestSilence_us = 2'000'000;
    static constexpr int kResyncReports = 20;
    // After this many stale reports in a row, more than the system's queue holds, the clocks are
    // taken to have drifted apart, and the report is fresh.
    static constexpr int kStaleReports = 256;

    void reset() noexcept { *this = ReportMonitor(); }
    // host_us: the host's monotonic clock when the report is read.
    Verdict check(const StateReport &report, std::uint64_t host_us) noexcept;

    // Number of reports missing just before the last checked one, if it was fresh or stale; else 0.
    [[nodiscard]] std::uint32_t lost() const noexcept { return lost_; }
    // Device time of the last fresh, stale or restarted report, in 64 bits (unit: us).
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
    double offset_us_ = 0.0; // host clock minus device clock for the fastest reports
    std::uint32_t lost_ = 0;
    int refused_in_row_ = 0;
    int stale_in_row_ = 0;
};

} // namespace spidar
