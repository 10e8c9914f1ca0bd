// Writes to a device whose write() may wait for seconds, so that the servo loop never does: a thread of its own with a
// mailbox that holds only the newest command. It is a watchdog too: when the loop stops posting while the motors may be
// on, it switches them off itself. The motors count as off only once the device has accepted a command that says so;
// until then that command is written again and again.
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
    // A write that waits so long: the device takes no more of them, and its firmware has let go by itself.
    static constexpr std::int64_t kBlockedForGood_ns = 50'000'000;

    explicit WriterThread(Transport &transport) noexcept : transport_(transport) {}
    ~WriterThread() { stop(); }
    WriterThread(const WriterThread &) = delete;
    WriterThread &operator=(const WriterThread &) = delete;

    // Begins with an empty mailbox: what was posted before is never written. open_failed: the system has no thread left.
    Status start() noexcept;
    // Writes motors off, after a write that is still under way, and joins. A device that does not accept it is asked
    // again for kStopPatience_ns; then its firmware lets go by itself (docs/reference/safety.md, row 34).
    void stop() noexcept;

    // From the servo thread; wait-free. The newest command wins.
    void post(const DriveCommand &command) noexcept;
    // From any thread: motors off, whatever is posted, until allow().
    void forbid() noexcept;
    void allow() noexcept { forbidden_.store(false, std::memory_order_release); }

    // Result of the last posted command whose write ended since the last call; ok when none did.
    Status take_result() noexcept;
    // How long the write under way has been waiting (unit: ns); 0 when none is.
    [[nodiscard]] std::int64_t blocked_ns(std::int64_t now_ns) const noexcept;
    // The loop stood still and the motors were switched off, since the last call. They stay off until allow().
    bool take_stalled() noexcept { return stalled_.exchange(false, std::memory_order_acq_rel); }

private:
    // As long as a firmware waits before it switches the motors off itself.
    static constexpr std::int64_t kStopPatience_ns = 50'000'000;

    void run() noexcept;
    void forget_posts() noexcept;
    void look() noexcept;
    void write_posted(const DriveCommand &command) noexcept;
    void write_off() noexcept { (void)write(DriveCommand()); }
    Status write(const DriveCommand &command) noexcept;
    [[nodiscard]] bool stands_still() const noexcept;

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
    // The thread's own, and kept from one start() to the next: a device that was not told remembers too.
    bool motors_may_be_on_ = false;
    bool off_is_wanted_ = false; // by the last command, or by this thread
};

} // namespace spidar
