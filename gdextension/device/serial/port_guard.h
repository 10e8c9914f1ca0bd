// The guard: a small process that also holds the port, and sends zero currents when this process
// dies, hangs or is stopped. Without a guard the boards would keep their last currents. Linux only.
#pragma once

#include <atomic>
#include <cstdint>
#include <string>

#include "device/serial/protocol/board_codec.h"

namespace spidar {

class PortGuard {
public:
    // Silence after which a guard counts as lost (unit: ns).
    static constexpr std::int64_t kSilent_ns = 40'000'000;

    PortGuard() = default;
    ~PortGuard() { end(); }
    PortGuard(const PortGuard &) = delete;
    PortGuard &operator=(const PortGuard &) = delete;

    // Starts `program` with this port and the bytes that set all currents to zero. Returns an empty
    // string when the guard runs and answers, else one sentence. May wait for half a second. Must
    // not run while beat() runs.
    [[nodiscard]] std::string start(const std::string &program, int port, BoardBytes off);
    // The guard sets the currents to zero once more and ends.
    void end() noexcept;

    // Signals that this process is alive. Writer thread, once per write; never waits.
    void beat(std::int64_t now_ns) noexcept;
    // Called from any thread.
    [[nodiscard]] bool alive() const noexcept { return alive_.load(std::memory_order_acquire); }
    [[nodiscard]] int process() const noexcept { return process_.load(); }
    // Returns true when, since the last call, the guard set the currents to zero because this
    // process was silent. Called from beat()'s thread.
    bool take_tripped() noexcept {
        const bool tripped = tripped_;
        tripped_ = false;
        return tripped;
    }

private:
    int socket_ = -1;
    std::atomic<int> process_{-1};
    std::atomic<bool> alive_{false};
    bool tripped_ = false;
    std::int64_t answered_ns_ = 0;
};

// File name of the guard. One folder holds the libraries and guards of both Linux processors.
#if defined(__aarch64__)
inline constexpr char kGuardFile[] = "spidar_g_guard.arm64";
#else
inline constexpr char kGuardFile[] = "spidar_g_guard.x86_64";
#endif

// Returns the path of kGuardFile beside the library or program that contains this code.
[[nodiscard]] std::string guard_beside_library();

} // namespace spidar
