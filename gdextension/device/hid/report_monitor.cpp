#include "device/hid/report_monitor.h"

#include <algorithm>

#include "device/hid/protocol/report_sequence.h"

namespace spidar {

namespace {

// The two clocks may drift apart by this much: twice what USB allows a full-speed device.
constexpr double kDrift_us_per_us = 0.005;

} // namespace

void ReportMonitor::start(const StateReport &report, std::uint64_t host_us) noexcept {
    has_reference_ = true;
    advance(report, report.device_time_us, host_us);
    offset_us_ = static_cast<double>(host_us) - static_cast<double>(device_us_);
    stale_in_row_ = 0;
}

void ReportMonitor::advance(const StateReport &report, std::uint64_t device_us,
                            std::uint64_t host_us) noexcept {
    sequence_ = report.sequence;
    last_time_us_ = report.device_time_us;
    device_us_ = device_us;
    last_host_us_ = host_us;
    refused_in_row_ = 0;
}

ReportMonitor::Verdict ReportMonitor::judge(const StateReport &report,
                                            std::uint64_t host_us) noexcept {
    if (report.sequence == sequence_) {
        return Verdict::replayed;
    }
    if (!is_newer(report.sequence, sequence_)) {
        return Verdict::out_of_order;
    }
    const std::uint32_t advance_us = report.device_time_us - last_time_us_; // wraps
    if (advance_us == 0 || advance_us > kLongestSilence_us) {
        return Verdict::implausible_time;
    }
    const std::uint64_t device_us = device_us_ + advance_us;
    const double arrival_us = static_cast<double>(host_us) - static_cast<double>(device_us);
    offset_us_ += kDrift_us_per_us * static_cast<double>(host_us - last_host_us_);
    offset_us_ = std::min(offset_us_, arrival_us);
    lost_ = sequence_steps(sequence_, report.sequence) - 1;
    advance(report, device_us, host_us);
    if (arrival_us - offset_us_ > kStale_us) {
        ++stale_in_row_;
        if (stale_in_row_ < kStaleReports) {
            return Verdict::stale;
        }
        offset_us_ = arrival_us;
    }
    stale_in_row_ = 0;
    return Verdict::fresh;
}

ReportMonitor::Verdict ReportMonitor::check(const StateReport &report,
                                            std::uint64_t host_us) noexcept {
    lost_ = 0;
    if (!has_reference_) {
        start(report, host_us);
        return Verdict::fresh;
    }
    const Verdict verdict = judge(report, host_us);
    if (verdict == Verdict::fresh || verdict == Verdict::stale) {
        return verdict;
    }
    ++refused_in_row_;
    if (refused_in_row_ < kResyncReports) {
        return verdict;
    }
    start(report, host_us);
    return Verdict::restarted;
}

} // namespace spidar
