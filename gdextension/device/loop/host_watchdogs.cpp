#include "device/loop/host_watchdogs.h"

#include "device/threads/real_time_thread.h"

namespace spidar {

namespace {

// A write that waits so long is told; one that waits longer is a device lost, whose firmware has let go by itself.
constexpr std::int64_t kBlocked_ns = 20'000'000;
constexpr std::int64_t kBlockedForGood_ns = 50'000'000;

} // namespace

void HostWatchdogs::restart() noexcept {
    panics_seen_ = panics_.load(std::memory_order_acquire);
    stops_ = 0;
    write_is_blocked_ = false;
}

void HostWatchdogs::stop(Status reason) noexcept {
    ++stops_;
    stop_reason_ = reason;
}

void HostWatchdogs::watch_writer(WriterThread &writer, EventLog &events) noexcept {
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

bool HostWatchdogs::watch(WriterThread *writer, HapticCommand &command, EventLog &events) noexcept {
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

} // namespace spidar
