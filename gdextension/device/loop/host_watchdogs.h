// Reasons of the host's own to switch the motors off: a panic stop, a servo thread that stood still, a device that takes
// no more writes.
#pragma once

#include <atomic>
#include <cstdint>

#include "device/contract/device_event.h"
#include "device/contract/haptic_command.h"
#include "device/threads/writer_thread.h"

namespace spidar {

class HostWatchdogs {
public:
    // From any thread.
    void panic() noexcept { panics_.fetch_add(1, std::memory_order_acq_rel); }

    // Before the first cycle: what happened until now is over.
    void restart() noexcept;
    // Once a cycle. Fills in the command's stop_count and stop_reason. writer: null when the loop writes by itself.
    // True: there is a new reason.
    bool watch(WriterThread *writer, HapticCommand &command, EventLog &events) noexcept;

private:
    void watch_writer(WriterThread &writer, EventLog &events) noexcept;
    void stop(Status reason) noexcept;

    std::atomic<std::uint32_t> panics_{0};
    std::uint32_t panics_seen_ = 0;
    std::uint32_t stops_ = 0;
    Status stop_reason_ = Status::ok;
    bool write_is_blocked_ = false;
};

} // namespace spidar
