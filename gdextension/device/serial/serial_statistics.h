// Counters of a serial link: written by the threads that use the link, read by any thread.
#pragma once

#include <atomic>
#include <cstdint>

#include "device/serial/protocol/reply_reader.h"

namespace spidar {

// Counters since the transport was created. They only grow, except `lost`, which a late answer
// lowers.
template <typename Count>
struct SerialCountersOf {
    Count asked{0};         // rounds of CURRENT commands sent to all boards
    Count rounds{0};        // rounds answered in full and accepted
    Count lost{0};          // rounds not answered in full, without the newest ones
    Count superseded{0};    // complete rounds not used, because a newer one had arrived
    Count bytes{0};         // received
    Count garbage_bytes{0}; // bytes dropped one by one in search of a reply
    Count implausible{0};   // complete replies with impossible speeds or steps
    Count damaged{0};       // incomplete, run together, in pieces, or the first after garbage
    Count unasked{0};       // replies that were not requested
    // Commands dropped because the wire was busy or this process had been stopped.
    Count postponed{0};
    Count write_failures{0};
    Count losses{0};       // connections lost: port unplugged or failed, board silent or restarted
    Count replugs{0};      // connections made again
    Count guard_trips{0};  // the guard stopped pulling motors, because this process was silent
    Count guard_losses{0}; // the guard died or hung
};
using SerialCounters = SerialCountersOf<std::uint64_t>;

class SerialStatistics : public SerialCountersOf<std::atomic<std::uint64_t>> {
public:
    static void add(std::atomic<std::uint64_t> &counter, std::uint64_t count = 1) noexcept {
        counter.fetch_add(count, std::memory_order_relaxed);
    }
    // Adds the differences between `now` and `before`, then sets `before` to `now`. Only the
    // thread that reads the port calls it.
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
