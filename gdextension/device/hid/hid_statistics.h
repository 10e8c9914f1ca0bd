// Counters and times of a HID link: written by the threads that use the link, read by any thread.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>

#include "device/threads/loop_histogram.h"

namespace spidar {

// Counters since the transport was created; each only grows.
template <typename Count>
struct HidCountersOf {
    Count reports{0}; // reports that are valid and newer than the last one
    // Such reports that were not used, because a still newer one was already waiting.
    Count superseded{0};
    Count lost{0};         // reports whose sequence numbers are missing
    Count wrong_length{0}; // too short or too long
    Count corrupt{0};      // wrong report id, CRC or value
    Count replayed{0};     // ReportMonitor::Verdict, like the next four
    Count out_of_order{0};
    Count implausible{0}; // implausible time on the device's clock
    Count stale{0};       // waited too long in the system's queue
    Count restarts{0};    // restarts of the device without a loss of the connection
    Count commands{0};    // commands written
    // Commands missing between two that the device reported as the last accepted one.
    Count skipped_commands{0};
    Count write_failures{0};
    Count losses{0};  // connections lost: device unplugged or failed
    Count replugs{0}; // connections made again
};
using HidCounters = HidCountersOf<std::uint64_t>;

struct HidTimes {
    std::uint64_t round_trips = 0;
    // Time from the start of writing a command to the first state report that names the command as
    // the last accepted one.
    double round_trip_p50_us = 0.0;
    double round_trip_p99_us = 0.0;
    double round_trip_max_us = 0.0;
    double write_p99_us = 0.0;
    double write_max_us = 0.0;
};

// Returns the estimated time from an encoder sample to the tensions computed from it (unit: s): the
// median round trip minus half a report period, for which an accepted command waits on average
// until the next report. Returns 0 while there are too few round trips.
[[nodiscard]] double link_latency_s(const HidTimes &times, double report_rate_hz) noexcept;

class HidStatistics : public HidCountersOf<std::atomic<std::uint64_t>> {
public:
    using Counter = std::atomic<std::uint64_t>;

    static void add(Counter &counter, std::uint64_t count = 1) noexcept {
        counter.fetch_add(count, std::memory_order_relaxed);
    }
    // The writer is about to write this command.
    void sent(std::uint16_t sequence, std::uint64_t now_us) noexcept;
    // The reader received a report that names this command as the last accepted one.
    void answered(std::uint16_t sequence, std::uint64_t now_us) noexcept;
    void write_took(std::uint64_t time_us) noexcept;

    [[nodiscard]] HidCounters counters() const noexcept;
    [[nodiscard]] HidTimes times() const noexcept;

private:
    // Number of newest commands whose round trip can be measured.
    static constexpr std::size_t kSendTimes = 64;
    std::array<std::atomic<std::uint64_t>, kSendTimes> sent_us_{};
    LoopHistogram round_trip_;
    LoopHistogram write_time_;
};

} // namespace spidar
