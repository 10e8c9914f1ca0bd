// Counters of a serial link: written by the threads that use the link, read by any thread.
#pragma once

#include <atomic>
#include <cstdint>

#include "device/serial/protocol/reply_reader.h"

namespace spidar {

// Counters over all plug-ins. They only grow, except `lost`, which a late answer lowers.
template <typename Count>
struct SerialCountersOf {
    Count asked{0};         // rounds of CURRENT commands sent to all boards
    Count rounds{0};        // rounds answered in full and accepted
    Count lost{0};          // rounds not answered in full
    Count superseded{0};    // readings not used: a newer one was there
    Count bytes{0};         // received
    Count garbage_bytes{0}; // bytes that belong to no accepted reply
    Count implausible{0};   // complete replies with impossible counts
    Count damaged{0};       // incomplete, run together, or in pieces
    Count unasked{0};
    Count postponed{0}; // commands dropped because the wire was still busy
    Count write_failures{0};
    Count losses{0};       // device unplugged or failed
    Count replugs{0};      // device found again
    Count guard_trips{0};  // the guard set currents to zero: this process was silent
    Count guard_losses{0}; // the guard died or hung
};
using SerialCounters = SerialCountersOf<std::uint64_t>;

class SerialStatistics : public SerialCountersOf<std::atomic<std::uint64_t>> {
public:
    static void add(std::atomic<std::uint64_t> &counter, std::uint64_t count = 1) noexcept {
        counter.fetch_add(count, std::memory_order_relaxed);
    }
    // Adds the reader's counts since `before`, then sets `before` to `now`. Reader's thread only.
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
