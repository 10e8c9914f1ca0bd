// From the bytes of an input report to a reading that may be trusted. Used by the servo loop only.
#pragma once

#include "device/contract/transport.h"
#include "device/hid/hid_statistics.h"
#include "device/hid/protocol/hid_codec.h"
#include "device/hid/protocol/report_sequence.h"
#include "device/hid/report_monitor.h"

namespace spidar {

class ReportIntake {
public:
    explicit ReportIntake(HidStatistics &statistics) noexcept : statistics_(statistics) {}

    // Starts a new session after a plug-in: forgets all state.
    void begin() noexcept;
    // Returns true when the report is valid and the newest so far. now_us: the host's clock.
    bool take(ReportBytes bytes, std::uint64_t now_us) noexcept;

    [[nodiscard]] const StateReport &newest() const noexcept { return newest_; }
    // Number of begin() calls and device restarts. A change voids zero and command numbering.
    [[nodiscard]] std::uint32_t epoch() const noexcept { return epoch_; }
    // True when the current epoch began with a restart of the device.
    [[nodiscard]] bool restarted() const noexcept { return restarted_; }

    // Fills in the newest report. zero_number counts zeroings: after a new one, readings are not
    // zeroed until all older reports must have left every queue.
    void fill(DeviceReading &reading, std::uint32_t zero_number, bool zero_counts) noexcept;

private:
    void follow_echo(std::uint16_t accepted, std::uint64_t now_us) noexcept;

    HidStatistics &statistics_;
    ReportMonitor monitor_;
    StateReport newest_;
    std::uint32_t epoch_ = 0;
    bool restarted_ = false;
    std::uint16_t echoed_ = kNoSequence;
    std::uint32_t zero_number_ = 0;
    std::uint64_t settled_at_us_ = 0; // device time
};

} // namespace spidar
