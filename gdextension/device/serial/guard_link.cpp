#include "device/serial/guard_link.h"

#include <thread>

namespace spidar {

// The writer holds the lock for microseconds.
void GuardLink::take() noexcept {
    while (busy_.test_and_set(std::memory_order_acquire)) {
        std::this_thread::yield();
    }
}

std::string GuardLink::start(const std::string &program, int port,
                             std::span<const BoardLayout> boards) {
    BoardFrame off;
    off.zeros(kResyncZeros);
    for (const BoardLayout &board : boards) {
        append_current(off, board, {});
    }
    take();
    std::string problem =
        guard_.start(program.empty() ? guard_beside_library() : program, port, off.bytes());
    give();
    is_wanted_.store(false);
    return problem;
}

void GuardLink::end() noexcept {
    take();
    guard_.end();
    give();
}

void GuardLink::beat(std::int64_t now_ns, bool pulled) noexcept {
    if (busy_.test_and_set(std::memory_order_acquire)) {
        return; // a new guard is being started
    }
    guard_.beat(now_ns);
    if (guard_.take_tripped() && pulled) {
        tripped_.store(true, std::memory_order_release);
        SerialStatistics::add(statistics_.guard_trips);
    }
    const bool alive = guard_.alive();
    give();
    if (was_alive_ && !alive) {
        tripped_.store(true, std::memory_order_release);
        SerialStatistics::add(statistics_.guard_losses);
        is_wanted_.store(true);
    }
    was_alive_ = alive;
}

} // namespace spidar
