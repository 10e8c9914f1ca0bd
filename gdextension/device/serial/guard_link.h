// The guard process as the transport's threads share it. The writer sends its beats, the watcher
// starts a new guard when it is lost, and both decide whether the motors may pull.
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

    // Returns an empty string when the guard runs, else a sentence. Not for the writer: may wait.
    [[nodiscard]] std::string start(const std::string &program, int port,
                                    std::span<const BoardLayout> boards);
    void end() noexcept;
    // True when the guard was lost and start() must be called.
    [[nodiscard]] bool is_wanted() const noexcept { return is_wanted_.load(); }

    // Called by the writer once per write. Tells the guard that this process is alive, and checks
    // the guard. pulled: the last currents were not zero.
    void beat(std::int64_t now_ns, bool pulled) noexcept;
    // True when the guard runs and has not stepped in since allow(). Called from any thread.
    [[nodiscard]] bool allows() const noexcept {
        return guard_.alive() && !tripped_.load(std::memory_order_acquire);
    }
    // Called when faults are cleared, with the motors off.
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
    // Whoever sets it may use the guard.
    std::atomic_flag busy_ = ATOMIC_FLAG_INIT;
    std::atomic<bool> is_wanted_{false};
    std::atomic<bool> tripped_{false};
    bool was_alive_ = false; // used by the writer
};

} // namespace spidar
