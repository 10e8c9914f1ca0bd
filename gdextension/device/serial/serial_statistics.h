// What a serial link has gone through: counted by the threads that use it, read by any.
#pragma once

#include <atomic>
#include <cstdint>

#include "device/serial/protocol/reply_reader.h"

namespace spidar {

// Each only grows, over all plug-ins; but `lost` falls again by what comes late.
template <typename Count>
struct SerialCountersOf {
    Count asked{0};         // rounds of CURRENT sent to all boards
    Count rounds{0};        // answered in full, and believed
    Count lost{0};          // rounds that were not
    Count superseded{0};    // readings not acted on: a newer one was there
    Count bytes{0};         // received
    Count garbage_bytes{0}; // belonged to no reply that was believed
    Count implausible{0};   // whole replies with counts that no string makes
    Count damaged{0};       // cut short, run together, or in pieces
    Count unasked{0};
    Count postponed{0}; // commands left out because the wire was still busy with the one before
    Count write_failures{0};
    Count losses{0};       // unplugged, or failed as if
    Count replugs{0};      // found again
    Count guard_trips{0};  // the guard zeroed the currents: this process was silent
    Count guard_losses{0}; // the guard died or hung
};
using SerialCounters = SerialCountersOf<std::uint64_t>;

class SerialStatistics : public SerialCountersOf<std::atomic<std::uint64_t>> {
public:
    static void add(std::atomic<std::uint64_t> &counter, std::uint64_t count = 1) noexcept {
        counter.fetch_add(count, std::memory_order_relaxed);
    }
    // What the reader counted since `before`, which becomes `now`. From the reader's thread.
    void take(const ReplyCounters &now, ReplyCounters &before) noexcept {
        add(rounds, now.rounds - before.rounds);
        add(bytes, now.bytes - before.bytes);
        add(garbage_bytes, now.garbage_bytes - before.garbage_bytes);
        add(implausible, now.implausible - before.implausible);
        add(unasked, now.unasked - before.unasked);
        add(damaged, now.cut_short + now.run_together + now.in_pieces + now.passed_over -
                         before.cut_short - before.run_together - before.in_pieces -
                         before.passed_over);
        before = now;
    }
    [[nodiscard]] SerialCounters counters() const noexcept {
        return {asked,          rounds,      lost,    superseded,  bytes,
                garbage_bytes,  implausible, damaged, unasked,     postponed,
                write_failures, losses,      replugs, guard_trips, guard_losses};
    }
};

} // namespace spidar
