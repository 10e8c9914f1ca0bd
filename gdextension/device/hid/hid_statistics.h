// What a HID link has gone through: counted by the threads that use it, read by any.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>

#include "device/threads/loop_histogram.h"

namespace spidar {

// Each only grows, over all plug-ins.
template <typename Count>
struct HidCountersOf {
    Count reports{0};      // good and new
    Count superseded{0};   // of those, not acted on: a newer one waited behind
    Count lost{0};         // gaps in the device's sequence
    Count wrong_length{0}; // short or long
    Count corrupt{0};      // report id, CRC or range
    Count replayed{0};
    Count out_of_order{0};
    Count implausible{0};      // the device's clock
    Count stale{0};            // waited too long in the system's queue
    Count restarts{0};         // the device began anew without being unplugged
    Count commands{0};         // written
    Count skipped_commands{0}; // gaps in the sequence of commands that the device accepted
    Count write_failures{0};
    Count losses{0};  // unplugged, or failed as if
    Count replugs{0}; // found again
};
using HidCounters = HidCountersOf<std::uint64_t>;

struct HidTimes {
    std::uint64_t round_trips = 0;
    double round_trip_p50_us = 0.0; // command written -> a state report that names it is read
    double round_trip_p99_us = 0.0;
    double round_trip_max_us = 0.0;
    double write_p99_us = 0.0;
    double write_max_us = 0.0;
};

// From a count being taken to the tensions made from it acting, as the round trips tell: a command is named in the first
// report after it came, which is half a report's period later in the mean. 0 while there are few of them.
[[nodiscard]] double link_latency_s(const HidTimes &times, double report_rate_hz) noexcept;

class HidStatistics : public HidCountersOf<std::atomic<std::uint64_t>> {
public:
    using Counter = std::atomic<std::uint64_t>;

    static void add(Counter &counter, std::uint64_t count = 1) noexcept {
        counter.fetch_add(count, std::memory_order_relaxed);
    }
    // A command left (writer) and the device named it (reader).
    void sent(std::uint16_t sequence, std::uint64_t now_us) noexcept;
    void answered(std::uint16_t sequence, std::uint64_t now_us) noexcept;
    void write_took(std::uint64_t time_us) noexcept;

    [[nodiscard]] HidCounters counters() const noexcept;
    [[nodiscard]] HidTimes times() const noexcept;

private:
    // More than a device can owe answers for.
    static constexpr std::size_t kSendTimes = 64;
    std::array<std::atomic<std::uint64_t>, kSendTimes> sent_us_{};
    LoopHistogram round_trip_;
    LoopHistogram write_time_;
};

} // namespace spidar
