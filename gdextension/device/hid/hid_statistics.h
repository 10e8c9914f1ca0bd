// What a HID link has gone through: counted by the threads that use it, read by any.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>

#include "device/threads/loop_histogram.h"

namespace spidar {

// Each only grows, over all plug-ins.
struct HidCounters {
    std::uint64_t reports = 0;      // good and new
    std::uint64_t superseded = 0;   // of those, not acted on: a newer one waited behind
    std::uint64_t lost = 0;         // gaps in the device's sequence
    std::uint64_t wrong_length = 0; // short or long
    std::uint64_t corrupt = 0;      // report id, CRC or range
    std::uint64_t replayed = 0;
    std::uint64_t out_of_order = 0;
    std::uint64_t implausible = 0;      // the device's clock
    std::uint64_t stale = 0;            // waited too long in the system's queue
    std::uint64_t restarts = 0;         // the device began anew without being unplugged
    std::uint64_t commands = 0;         // written
    std::uint64_t skipped_commands = 0; // gaps in the sequence of commands that the device accepted
    std::uint64_t write_failures = 0;
    std::uint64_t losses = 0;  // unplugged, or failed as if
    std::uint64_t replugs = 0; // found again
};

struct HidTimes {
    double round_trip_p50_us = 0.0; // command written -> a state report that names it is read
    double round_trip_p99_us = 0.0;
    double round_trip_max_us = 0.0;
    double write_p50_us = 0.0;
    double write_p99_us = 0.0;
    double write_max_us = 0.0;
};

class HidStatistics {
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

    Counter reports{0};
    Counter superseded{0};
    Counter lost{0};
    Counter wrong_length{0};
    Counter corrupt{0};
    Counter replayed{0};
    Counter out_of_order{0};
    Counter implausible{0};
    Counter stale{0};
    Counter restarts{0};
    Counter commands{0};
    Counter skipped_commands{0};
    Counter write_failures{0};
    Counter losses{0};
    Counter replugs{0};

private:
    // More than a device can owe answers for.
    static constexpr std::size_t kSendTimes = 64;
    std::array<std::atomic<std::uint64_t>, kSendTimes> sent_us_{};
    LoopHistogram round_trip_;
    LoopHistogram write_time_;
};

} // namespace spidar
