// Turns the bytes of input reports into readings, and rejects reports that are damaged, old or out
// of order. Used by the servo loop only.
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

    // Called for each new connection: forgets the reports of the old one.
    void begin() noexcept;
    // Returns true when the report is valid and the newest so far. now_us: the host's clock.
    bool take(ReportBytes bytes, std::uint64_t now_us) noexcept;

    [[nodiscard]] const StateReport &newest() const noexcept { return newest_; }
    // Number of begin() calls and device restarts. When it changes, the encoders' zero and the
    // numbering of commands are no longer valid.
    [[nodiscard]] std::uint32_t epoch() const noexcept { return epoch_; }
    // True when the current epoch began with a restart of the device.
    [[nodiscard]] bool restarted() const noexcept { return restarted_; }

    // Writes the newest report to `reading`. zero_number: how often the encoders were zeroed. For
    // 0.1 s of device time after it changes, reading.zeroed is false, since older reports may still
    // arrive. zero_counts: false makes reading.zeroed false.
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
    std::uint64_t settled_at_us_ = 0; // device time from which reading.zeroed may be true
};

} // namespace spidar
