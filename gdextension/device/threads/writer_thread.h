// Writes to a device whose write() may wait for seconds, so that the servo loop never does: a thread of its own with a
// mailbox that holds only the newest command. It is a watchdog too: when the loop stops posting while the motors are
// on, it switches them off itself.
#pragma once

#include <atomic>
#include <cstdint>
#include <semaphore>
#include <thread>

#include "device/contract/transport.h"
#include "device/threads/triple_buffer.h"

namespace spidar {

class WriterThread {
public:
    // Motors on and no post for this long: they are switched off from here.
    static constexpr std::int64_t kStalled_ns = 20'000'000;

    explicit WriterThread(Transport &transport) noexcept : transport_(transport) {}
    ~WriterThread() { stop(); }
    WriterThread(const WriterThread &) = delete;
    WriterThread &operator=(const WriterThread &) = delete;

    // open_failed: the system has no thread left.
    Status start() noexcept;
    // Writes motors off, after a write that is still under way, and joins.
    void stop() noexcept;

    // From the servo thread; wait-free. The newest command wins.
    void post(const DriveCommand &command) noexcept;
    // From any thread: motors off, whatever is posted, until allow().
    void forbid() noexcept;
    void allow() noexcept { forbidden_.store(false, std::memory_order_release); }

    // Result of the last write that ended since the last call; ok when none did.
    Status take_result() noexcept;
    // How long the write under way has been waiting (unit: ns); 0 when none is.
    [[nodiscard]] std::int64_t blocked_ns(std::int64_t now_ns) const noexcept;
    // The loop stood still and the motors were switched off, since the last call.
    bool take_stalled() noexcept { return stalled_.exchange(false, std::memory_order_acq_rel); }

private:
    void run() noexcept;
    void write(const DriveCommand &command) noexcept;

    Transport &transport_;
    TripleBuffer<DriveCommand> mailbox_;
    std::counting_semaphore<> posted_{0};
    std::thread thread_;
    std::atomic<bool> stop_asked_{false};
    std::atomic<bool> forbidden_{false};
    std::atomic<bool> stalled_{false};
    std::atomic<std::int64_t> last_post_ns_{0};
    std::atomic<std::int64_t> writing_since_ns_{0};
    std::atomic<std::int32_t> result_{0};
    bool motors_are_on_ = false; // as last written
};

} // namespace spidar
