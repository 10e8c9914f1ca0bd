// Reasons of the host's own to switch the motors off: a panic stop, a servo thread that stood still, a device that takes
// no more writes.
#pragma once

#include <atomic>
#include <cstdint>

#include "device/contract/device_event.h"
#include "device/contract/haptic_command.h"
#include "device/threads/real_time_thread.h"
#include "device/threads/writer_thread.h"

namespace spidar {

class HostWatchdogs {
public:
    // From any thread.
    void panic() noexcept { panics_.fetch_add(1, std::memory_order_acq_rel); }

    // Before the first cycle: what happened until now is over.
    void restart() noexcept {
        panics_seen_ = panics_.load(std::memory_order_acquire);
        stops_ = 0;
        write_is_blocked_ = false;
    }
    // Once a cycle. Fills in the command's stop_count and stop_reason. writer: null when the loop writes by itself.
    // True: there is a new reason.
    bool watch(WriterThread *writer, HapticCommand &command, EventLog &events) noexcept {
        const std::uint32_t before = stops_;
        const std::uint32_t panics = panics_.load(std::memory_order_acquire);
        if (panics != panics_seen_) {
            panics_seen_ = panics;
            stop(Status::panic_stopped);
        }
        if (writer != nullptr) {
            watch_writer(*writer, events);
        }
        command.stop_count = stops_;
        command.stop_reason = stop_reason_;
        return stops_ != before;
    }

private:
    // A write that waits so long is told; one that waits longer is a device lost, whose firmware has let go by itself.
    static constexpr std::int64_t kBlocked_ns = 20'000'000;
    static constexpr std::int64_t kBlockedForGood_ns = 50'000'000;

    void watch_writer(WriterThread &writer, EventLog &events) noexcept {
        if (writer.take_stalled()) {
            stop(Status::loop_stalled);
        }
        const std::int64_t blocked_ns = writer.blocked_ns(monotonic_ns());
        if (blocked_ns > kBlocked_ns) {
            events.tell(DeviceEventKind::write_blocked, -1, static_cast<double>(blocked_ns) * 1e-9);
        }
        const bool for_good = blocked_ns > kBlockedForGood_ns;
        if (for_good && !write_is_blocked_) {
            stop(Status::write_failed);
        }
        write_is_blocked_ = for_good;
    }
    void stop(Status reason) noexcept {
        ++stops_;
        stop_reason_ = reason;
    }

    std::atomic<std::uint32_t> panics_{0};
    std::uint32_t panics_seen_ = 0;
    std::uint32_t stops_ = 0;
    Status stop_reason_ = Status::ok;
    bool write_is_blocked_ = false;
};

} // namespace spidar
