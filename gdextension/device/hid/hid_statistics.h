// Counters and times of a HID link: written by the threads that use the link, read by any thread.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>

#include "device/threads/loop_histogram.h"

namespace spidar {

// Counters over all plug-ins; each only grows.
template <typename Count>
struct HidCountersOf {
    Count reports{0}; // valid and new
    // Valid reports that were not used, because a newer one was already waiting.
    Count superseded{0};
    Count lost{0};         // gaps in the sequence numbers of the device
    Count wrong_length{0}; // too short or too long
    Count corrupt{0};      // wrong report id, CRC or range
    Count replayed{0};
    Count out_of_order{0};
    Count implausible{0}; // implausible time on the device's clock
    Count stale{0};       // waited too long in the system's queue
    // The device restarted without being unplugged.
    Count restarts{0};
    Count commands{0}; // commands written
    // Gaps in the sequence of commands that the device accepted.
    Count skipped_commands{0};
    Count write_failures{0};
    Count losses{0};  // device unplugged or failed
    Count replugs{0}; // device found again
};
using HidCounters = HidCountersOf<std::uint64_t>;

struct HidTimes {
    std::uint64_t round_trips = 0;
    // Time from writing a command to reading a state report that names it.
    double round_trip_p50_us = 0.0;
    double round_trip_p99_us = 0.0;
    double round_trip_max_us = 0.0;
    double write_p99_us = 0.0;
    double write_max_us = 0.0;
};

// Returns the estimated time from an encoder sample to the tensions computed from it (unit: s). A
// command is named in the first report after its arrival, on average half a report period later.
// Returns 0 while there are too few round trips.
[[nodiscard]] double link_latency_s(const HidTimes &times, double report_rate_hz) noexcept;

class HidStatistics : public HidCountersOf<std::atomic<std::uint64_t>> {
public:
    using Counter = std::atomic<std::uint64_t>;

    static void add(Counter &counter, std::uint64_t count = 1) noexcept {
        counter.fetch_add(count, std::memory_order_relaxed);
    }
    // Writer: a command was sent.
    void sent(std::uint16_t sequence, std::uint64_t now_us) noexcept;
    // Reader: a report names this command.
    void answered(std::uint16_t sequence, std::uint64_t now_us) noexcept;
    void write_took(std::uint64_t time_us) noexcept;

    [[nodiscard]] HidCounters counters() const noexcept;
    [[nodiscard]] HidTimes times() const noexcept;

private:
    // Number of commands that can be unanswered at once.
    static constexpr std::size_t kSendTimes = 64;
    std::array<std::atomic<std::uint64_t>, kSendTimes> sent_us_{};
    LoopHistogram round_trip_;
    LoopHistogram write_time_;
};

} // namespace spidar
