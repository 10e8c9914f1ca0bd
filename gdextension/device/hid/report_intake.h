// Everything between the bytes of an input report and a reading that may be trusted. The servo loop's own.
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

    // Another plug-in of the device: nothing of the last one holds.
    void begin() noexcept;
    // True: a good new report, the newest so far. now_us: the host's clock.
    bool take(ReportBytes bytes, std::uint64_t now_us) noexcept;

    [[nodiscard]] const StateReport &newest() const noexcept { return newest_; }
    // Counts begin() and the device's restarts: when it changes, zero and count of commands are worth nothing.
    [[nodiscard]] std::uint32_t epoch() const noexcept { return epoch_; }
    // True when the last begin of an epoch was the device's own.
    [[nodiscard]] bool restarted() const noexcept { return restarted_; }

    // The newest report as the servo step wants it. zero_number counts zeroings; the readings after one are not
    // zeroed until reports made before it must have left every queue.
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
