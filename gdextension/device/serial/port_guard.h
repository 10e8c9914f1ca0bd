// Starts the guard: a small process that also holds the port. The guard sends zero currents when
// this process dies, hangs or is stopped; the boards alone would keep their last currents. Linux
// only.
#pragma once

#include <atomic>
#include <cstdint>
#include <string>

#include "device/serial/protocol/board_codec.h"

namespace spidar {

class PortGuard {
public:
    // A guard that sends no message for this time counts as lost (unit: ns).
    static constexpr std::int64_t kSilent_ns = 40'000'000;

    PortGuard() = default;
    ~PortGuard() { end(); }
    PortGuard(const PortGuard &) = delete;
    PortGuard &operator=(const PortGuard &) = delete;

    // Ends the old guard and starts `program`. port: file descriptor; off: bytes that set all
    // currents to zero. Returns an empty string when the guard runs and answers, else one sentence.
    // May wait for half a second, and as long for the old guard's end. Must not run during beat().
    [[nodiscard]] std::string start(const std::string &program, int port, BoardBytes off);
    // Makes the guard send zero currents and end. May wait for half a second.
    void end() noexcept;

    // Tells the guard that this process is alive, and reads the guard's messages. Called by the
    // writer thread once per write; never waits.
    void beat(std::int64_t now_ns) noexcept;
    // True while the guard runs and answers. Called from any thread.
    [[nodiscard]] bool alive() const noexcept { return alive_.load(std::memory_order_acquire); }
    [[nodiscard]] int process() const noexcept { return process_.load(); } // -1: no guard
    // Returns true if, since the last call, the guard reported that it sent zero currents because
    // this process was silent. Called from beat()'s thread.
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

// File name of the guard. One folder holds the files for both processor types of Linux.
#if defined(__aarch64__)
inline constexpr char kGuardFile[] = "spidar_g_guard.arm64";
#else
inline constexpr char kGuardFile[] = "spidar_g_guard.x86_64";
#endif

// Returns the path of kGuardFile beside the library or program that contains this code; empty on
// systems other than Linux.
[[nodiscard]] std::string guard_beside_library();

} // namespace spidar
