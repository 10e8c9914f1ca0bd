// The guard: a small process beside this one that holds the port too, and sends "no current" when this process dies, hangs
// or is stopped. The boards hold their last current for ever, so nothing else would. Linux only.
#pragma once

#include <atomic>
#include <cstdint>
#include <string>

#include "device/serial/protocol/board_codec.h"

namespace spidar {

class PortGuard {
public:
    // A guard that does not answer for so long is lost (unit: ns).
    static constexpr std::int64_t kSilent_ns = 40'000'000;

    PortGuard() = default;
    ~PortGuard() { end(); }
    PortGuard(const PortGuard &) = delete;
    PortGuard &operator=(const PortGuard &) = delete;

    // Starts `program` with this port and the bytes that bring all currents to zero. May wait for half a second. Empty when
    // it runs and answers; else one sentence. Not while beat() runs in another thread.
    [[nodiscard]] std::string start(const std::string &program, int port, BoardBytes off);
    // The guard zeroes the currents once more and ends.
    void end() noexcept;

    // Once a write, from the writer thread: this process lives. Never waits.
    void beat(std::int64_t now_ns) noexcept;
    // From any thread.
    [[nodiscard]] bool alive() const noexcept { return alive_.load(std::memory_order_acquire); }
    [[nodiscard]] int process() const noexcept { return process_.load(); }
    // It had to zero the currents since the last call: this process was silent. From beat()'s thread.
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

// The guard's file. The libraries for both processors of Linux lie in one folder, and so do their guards.
#if defined(__aarch64__)
inline constexpr char kGuardFile[] = "spidar_g_guard.arm64";
#else
inline constexpr char kGuardFile[] = "spidar_g_guard.x86_64";
#endif

// The path of kGuardFile in the folder of the library or program that this code is linked into.
[[nodiscard]] std::string guard_beside_library();

} // namespace spidar
