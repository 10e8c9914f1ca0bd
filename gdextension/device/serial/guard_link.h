// Shares the guard process (port_guard.h) between the threads of SerialTransport. The writer calls
// beat(); the watcher starts a new guard when the old one is lost. allows() says whether the motors
// may pull.
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

    // Starts a guard, which replaces the old one. Returns an empty string when it runs, else a
    // sentence. May wait, so the writer must not call it.
    [[nodiscard]] std::string start(const std::string &program, int port,
                                    std::span<const BoardLayout> boards);
    void end() noexcept;
    // True from the loss of a guard to the next start().
    [[nodiscard]] bool is_wanted() const noexcept { return is_wanted_.load(); }

    // Called by the writer once per write. Tells the guard that this process is alive, and checks
    // the guard. pulled: the last write let the motors pull.
    void beat(std::int64_t now_ns, bool pulled) noexcept;
    // True when the guard runs and, since allow(), was not lost and did not set pulling motors to
    // zero current. Called from any thread.
    [[nodiscard]] bool allows() const noexcept {
        return guard_.alive() && !tripped_.load(std::memory_order_acquire);
    }
    // Lets the motors pull again if the guard runs. Called with the motors off, when a fault is
    // cleared.
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
    // The thread that sets it owns guard_ until that thread clears it.
    std::atomic_flag busy_ = ATOMIC_FLAG_INIT;
    std::atomic<bool> is_wanted_{false};
    std::atomic<bool> tripped_{false};
    bool was_alive_ = false; // used by the writer
};

} // namespace spidar
