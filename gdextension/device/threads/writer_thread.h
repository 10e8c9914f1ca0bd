// Writes to a device whose write() may wait for seconds, in a thread with a mailbox that holds only
// the newest command. The servo loop never waits. The thread is also a watchdog: when the loop
// stops posting while the motors may be on, the thread switches them off. Motors count as off only
// once the device has accepted a command with motors off. The thread repeats that command until
// then.
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
    // Time without a post, with motors on, after which this thread switches them off.
    static constexpr std::int64_t kStalled_ns = 20'000'000;
    // Time after which a write that is still blocked means that the device accepts no more. By then
    // its firmware has switched the motors off by itself.
    static constexpr std::int64_t kBlockedForGood_ns = 50'000'000;

    explicit WriterThread(Transport &transport) noexcept : transport_(transport) {}
    ~WriterThread() { stop(); }
    WriterThread(const WriterThread &) = delete;
    WriterThread &operator=(const WriterThread &) = delete;

    // Starts with an empty mailbox: earlier posts are never written. Returns open_failed when the
    // system can start no thread.
    Status start() noexcept;
    // Writes motors off, after any write in progress, and joins. Repeats the command for
    // kStopPatience_ns when the device does not accept it; after that time its firmware switches
    // off by itself (docs/reference/safety.md, row 34).
    void stop() noexcept;

    // Posts a command; the newest wins. Called from the servo thread; wait-free.
    void post(const DriveCommand &command) noexcept;
    // Keeps the motors off, whatever is posted, until allow(). Called from any thread.
    void forbid() noexcept;
    void allow() noexcept { forbidden_.store(false, std::memory_order_release); }

    // Returns ok if no write of a posted command has failed since the last call. Otherwise returns
    // the status of the last one that failed.
    Status take_result() noexcept;
    // Time for which the current write has been waiting (unit: ns); 0 when there is none.
    [[nodiscard]] std::int64_t blocked_ns(std::int64_t now_ns) const noexcept;
    // True when, since the last call, the loop stalled and the motors were switched off. They stay
    // off until allow().
    bool take_stalled() noexcept { return stalled_.exchange(false, std::memory_order_acq_rel); }

private:
    // Time after which a device's firmware switches the motors off by itself.
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
    // Used by the thread only, and kept between runs: a device that did not accept the off command
    // still has its motors on.
    bool motors_may_be_on_ = false;
    // The last command that was written had its motors off.
    bool off_is_wanted_ = false;
};

} // namespace spidar
