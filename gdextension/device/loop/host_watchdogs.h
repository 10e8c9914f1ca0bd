// The host's own reasons to switch the motors off: a panic stop, a servo thread that stalled, a
// device that accepts no more writes.
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
    // Called from any thread.
    void panic() noexcept { panics_.fetch_add(1, std::memory_order_acq_rel); }

    // Called before the first cycle with the newest command, and sets its stop_count and
    // stop_reason. A stop of an earlier run has no effect, except a panic after which no fault was
    // cleared: it stops the motors in the first cycle.
    void restart(HapticCommand &newest) noexcept {
        write_is_blocked_ = false;
        hear(newest);
        newest.stop_count = stops_;
        newest.stop_reason = stop_reason_;
        if (panicked_) {
            stop(Status::panic_stopped);
        }
    }
    // Called once per cycle. Sets the command's stop_count and stop_reason. writer: null when no
    // writer thread is used. Returns true when there is a new reason to stop.
    bool watch(WriterThread *writer, HapticCommand &command, EventLog &events) noexcept {
        const std::uint32_t before = stops_;
        if (hear(command)) {
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
    // Time after which a blocked write is reported.
    static constexpr std::int64_t kBlocked_ns = 20'000'000;

    // Returns true when there was a panic since the last call. When panic and clear_fault() arrive
    // together, the panic counts as later.
    bool hear(const HapticCommand &command) noexcept {
        const bool cleared = command.clear_fault_count != clear_fault_count_;
        clear_fault_count_ = command.clear_fault_count;
        const std::uint32_t panics = panics_.load(std::memory_order_acquire);
        const bool heard = panics != panics_seen_;
        panics_seen_ = panics;
        panicked_ = heard || (panicked_ && !cleared);
        return heard;
    }
    void watch_writer(WriterThread &writer, EventLog &events) noexcept {
        if (writer.take_stalled()) {
            stop(Status::loop_stalled);
        }
        const std::int64_t blocked_ns = writer.blocked_ns(monotonic_ns());
        if (blocked_ns > kBlocked_ns) {
            events.tell(DeviceEventKind::write_blocked, -1, static_cast<double>(blocked_ns) * 1e-9);
        }
        const bool for_good = blocked_ns > WriterThread::kBlockedForGood_ns;
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
    std::uint32_t clear_fault_count_ = 0;
    // True after a panic, until a fault is cleared.
    bool panicked_ = false;
    // Only grows, since any change counts as an edge.
    std::uint32_t stops_ = 0;
    Status stop_reason_ = Status::ok;
    bool write_is_blocked_ = false;
};

} // namespace spidar
