// The guard as the transport's threads share it: the writer beats, the watcher starts another when it is lost, and whether
// the motors may pull is a matter of both.
#pragma once

#include <atomic>
#include <cstdint>
#include <span>
#include <string>

#include "device/serial/port_guard.h"
#include "device/serial/serial_statistics.h"

namespace spidar {

class GuardLink {
public:
    explicit GuardLink(SerialStatistics &statistics) noexcept : statistics_(statistics) {}

    // Empty when it runs; else one sentence. Not from the writer: it may wait for half a second.
    [[nodiscard]] std::string start(const std::string &program, int port,
                                    std::span<const BoardLayout> boards);
    void end() noexcept;
    // It was lost: start() another.
    [[nodiscard]] bool is_wanted() const noexcept { return is_wanted_.load(); }

    // Once a write, from the writer: tells the guard that this process lives, and hears whether the guard does. pulled:
    // the last currents were not zero.
    void beat(std::int64_t now_ns, bool pulled) noexcept;
    // From any thread. It runs, and has had no reason to step in since allow().
    [[nodiscard]] bool allows() const noexcept {
        return guard_.alive() && !tripped_.load(std::memory_order_acquire);
    }
    // Faults are cleared, with the motors off.
    void allow() noexcept {
        if (guard_.alive()) {
            tripped_.store(false, std::memory_order_release);
        }
    }
    [[nodiscard]] int process() const noexcept { return guard_.process(); }

private:
    void take() noexcept;
    void give() noexcept { busy_.clear(std::memory_order_release); }

    SerialStatistics &statistics_;
    PortGuard guard_;
    std::atomic_flag busy_ = ATOMIC_FLAG_INIT; // whoever has set it may touch the guard
    std::atomic<bool> is_wanted_{false};
    std::atomic<bool> tripped_{false};
    bool was_alive_ = false; // the writer's own
};

} // namespace spidar
