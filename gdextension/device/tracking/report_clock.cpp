#include "device/tracking/report_clock.h"

#include <algorithm>
#include <cmath>

namespace spidar {

namespace {

constexpr double kMicrosecondsPerSecond = 1e6;
// Longest plausible time between two reports, and largest disagreement of the two clocks over it.
// Beyond either, one clock was set or stopped, and the lag is measured anew.
constexpr double kMostApart_s = 0.05;

} // namespace

// Returns the time since the last report, by the device's clock where it is used, else by the
// host's.
double ReportClock::made_after_s(std::uint64_t device_us) const noexcept {
    if (!believed_ || !known_ || device_us <= device_us_) {
        return since_arrival_s_;
    }
    const double by_device_s = static_cast<double>(device_us - device_us_) / kMicrosecondsPerSecond;
    return std::abs(by_device_s - since_arrival_s_) <= kMostApart_s ? by_device_s
                                                                    : since_arrival_s_;
}

void ReportClock::arrived(std::uint64_t device_us) noexcept {
    const double host_s = since_arrival_s_;
    const double device_s = made_after_s(device_us);
    since_arrival_s_ = 0.0;
    apart_s_ = std::max(device_s, kClosest_s);
    since_used_s_ += apart_s_;
    device_us_ = device_us;
    if (!known_) {
        known_ = true;
        return;
    }
    lag_s_ += host_s - device_s * (1.0 + drift_);
    stretch_s_ += host_s;
    if (stretch_s_ == host_s || lag_s_ < least_s_) {
        least_s_ = lag_s_;
        least_at_s_ = stretch_s_;
    }
    const double step_s = std::clamp(to_come_s_, -kMostDrift * host_s, kMostDrift * host_s);
    to_come_s_ -= step_s;
    floor_s_ = std::min(floor_s_ + step_s, lag_s_);
    if (stretch_s_ >= kStretch_s) {
        end_stretch();
    }
    age_s_ = believed_ ? std::clamp(lag_s_ - floor_s_ - kGrain_s, 0.0, kOldest_s) : 0.0;
}

void ReportClock::end_stretch() noexcept {
    const double left_s = stretch_s_ - least_at_s_;
    double slope = 0.0;
    if (has_before_) {
        // Two minima close together do not determine a rate.
        const double apart_s = std::max(before_ago_s_ + least_at_s_, 0.5 * kStretch_s);
        slope = std::clamp((least_s_ - before_s_) / apart_s, -kMostDrift, kMostDrift);
    }
    drift_ += slope;
    believed_ = believed_ && std::abs(drift_) < kMostDrift;
    before_s_ = least_s_ + slope * left_s;
    to_come_s_ = before_s_ - floor_s_;
    before_ago_s_ = left_s;
    has_before_ = true;
    stretch_s_ = 0.0;
}

} // namespace spidar
