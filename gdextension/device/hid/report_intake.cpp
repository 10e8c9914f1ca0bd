#include "device/hid/report_intake.h"

namespace spidar {

namespace {

// A system's queue holds 64 reports.
constexpr std::uint64_t kZeroSettle_us = 100'000;

Status device_status(std::uint8_t flags) noexcept {
    if ((flags & state_flag::kEmergencyStop) != 0) {
        return Status::device_emergency_stop;
    }
    if ((flags & state_flag::kEncoderFault) != 0) {
        return Status::device_encoder_fault;
    }
    if ((flags & state_flag::kOverTemperature) != 0) {
        return Status::device_over_temperature;
    }
    if ((flags & state_flag::kWatchdogTripped) != 0) {
        return Status::device_watchdog;
    }
    return (flags & state_flag::kActuatorPower) != 0 ? Status::ok : Status::device_no_power;
}

} // namespace

void ReportIntake::begin() noexcept {
    monitor_.reset();
    ++epoch_;
    restarted_ = false;
    echoed_ = kNoSequence;
    settled_at_us_ = 0;
}

void ReportIntake::follow_echo(std::uint16_t accepted, std::uint64_t now_us) noexcept {
    if (accepted == kNoSequence || accepted == echoed_) {
        return;
    }
    if (echoed_ != kNoSequence && is_newer(accepted, echoed_)) {
        HidStatistics::add(statistics_.skipped_commands, sequence_steps(echoed_, accepted) - 1);
    }
    echoed_ = accepted;
    statistics_.answered(accepted, now_us);
}

bool ReportIntake::take(ReportBytes bytes, std::uint64_t now_us) noexcept {
    HidStatistics &s = statistics_;
    StateReport report;
    const Decoded decoded = decode(bytes, report);
    if (decoded != Decoded::ok) {
        HidStatistics::add(decoded == Decoded::wrong_length ? s.wrong_length : s.corrupt);
        return false;
    }
    const ReportMonitor::Verdict verdict = monitor_.check(report, now_us);
    HidStatistics::add(s.lost, monitor_.lost());
    switch (verdict) {
    case ReportMonitor::Verdict::replayed:
        HidStatistics::add(s.replayed);
        return false;
    case ReportMonitor::Verdict::out_of_order:
        HidStatistics::add(s.out_of_order);
        return false;
    case ReportMonitor::Verdict::implausible_time:
        HidStatistics::add(s.implausible);
        return false;
    case ReportMonitor::Verdict::stale:
        HidStatistics::add(s.stale);
        return false;
    case ReportMonitor::Verdict::restarted:
        HidStatistics::add(s.restarts);
        ++epoch_;
        restarted_ = true;
        echoed_ = kNoSequence;
        settled_at_us_ = 0;
        break;
    case ReportMonitor::Verdict::fresh:
        break;
    }
    HidStatistics::add(s.reports);
    follow_echo(report.accepted_command, now_us);
    newest_ = report;
    return true;
}

void ReportIntake::fill(DeviceReading &reading, std::uint32_t zero_number,
                        bool zero_counts) noexcept {
    const std::uint64_t device_us = monitor_.device_time_us();
    if (zero_number_ != zero_number) {
        zero_number_ = zero_number;
        settled_at_us_ = device_us + kZeroSettle_us;
    }
    reading.counts = newest_.counts;
    reading.device_time_us = device_us;
    reading.sequence = newest_.sequence;
    reading.buttons = newest_.buttons;
    reading.zeroed =
        zero_counts && (newest_.flags & state_flag::kZeroed) != 0 && device_us >= settled_at_us_;
    reading.device_status = device_status(newest_.flags);
    reading.fault_strings =
        reading.device_status == Status::device_encoder_fault ? newest_.fault_strings : 0;
}

} // namespace spidar
