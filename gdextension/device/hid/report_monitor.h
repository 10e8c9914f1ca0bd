// Is a decoded report the next one? Finds gaps, replays, reports out of order, device clocks that jump, and reports
// that waited too long in a queue. What passes still goes through SampleGuard, which knows how fast a string can be.
#pragma once

#include <cstdint>

#include "device/hid/protocol/hid_protocol.h"

namespace spidar {

class ReportMonitor {
public:
    enum class Verdict : std::uint8_t {
        fresh,
        replayed,         // the sequence number of the last good report
        out_of_order,     // an older one
        implausible_time, // the device's clock stands still, went back or leapt
        stale,            // kStale_us older than the freshest reports are on arrival
        restarted, // taken as the new reference after kResyncReports refused in a row: the device
                   // began anew, so its zero is worth nothing
    };

    static constexpr std::uint32_t kStale_us = 10'000;
    static constexpr std::uint32_t kLongestSilence_us = 2'000'000;
    static constexpr int kResyncReports = 20;
    // More in a row than any queue holds: the clocks have moved apart, not the reports grown old.
    static constexpr int kStaleReports = 256;

    void reset() noexcept { *this = ReportMonitor(); }
    // host_us: the host's clock on arrival, never going back.
    Verdict check(const StateReport &report, std::uint64_t host_us) noexcept;

    // Reports missing before the last one, when that was fresh or stale; else 0.
    [[nodiscard]] std::uint32_t lost() const noexcept { return lost_; }
    // The device's time of the last good report, unwrapped (unit: us).
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
    double offset_us_ = 0.0; // host clock - device clock of the freshest reports
    std::uint32_t lost_ = 0;
    int refused_in_row_ = 0;
    int stale_in_row_ = 0;
};

} // namespace spidar
