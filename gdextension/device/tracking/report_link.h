// The incoming reports of a device: their order, the device's clock, and the fade of the wrench
// while none arrive.
#pragma once

#include <algorithm>

#include "core/base/sound_state.h"
#include "device/contract/transport.h"
#include "device/settings/servo_settings.h"
#include "device/tracking/report_clock.h"
#include "device/tracking/report_order.h"

namespace spidar {

class ReportLink {
public:
    // If a report's device time is earlier than the last one by more than this, the device has
    // restarted; if by less, the report is late.
    static constexpr std::uint64_t kClockBack_us = 50'000;

    void configure(const SafetySettings &safety, double nominal_dt_s) noexcept {
        *this = ReportLink();
        stale_s_ = safety.read_timeout_fade_s;
        lost_s_ = safety.read_timeout_fault_s;
        slack_s_ = 0.5 * nominal_dt_s;
    }
    // Accepts any number and device time in the next report.
    void expect_anew() noexcept {
        order_.reset();
        clock_.reset();
    }
    // Called when a fault is cleared. Like expect_anew(), and restarts the time without reports.
    void forgive() noexcept {
        expect_anew();
        since_report_s_ = 0.0;
    }

    // Returns true when this report shows that the device's clock restarted.
    bool restarted(const DeviceReading &reading) noexcept {
        if (reading.device_time_us + kClockBack_us >= device_time_us_) {
            return false;
        }
        device_time_us_ = reading.device_time_us;
        expect_anew();
        return true;
    }
    // Returns false for an old report, which must not be used.
    bool accept(const DeviceReading &reading) noexcept {
        if (!order_.accept(reading.sequence, reading.overtaken)) {
            return false;
        }
        clock_.arrived(reading.device_time_us);
        device_time_us_ = std::max(device_time_us_, reading.device_time_us);
        return true;
    }
    // Returns whether this report is the next one: no restart, and none missing before it.
    [[nodiscard]] bool follows(const DeviceReading &reading) const noexcept {
        return reading.device_time_us + kClockBack_us >= device_time_us_ &&
               order_.follows(reading.sequence);
    }
    // Reports lost before the last accepted one.
    [[nodiscard]] int missed() const noexcept { return order_.missed(); }

    // Takes one cycle, before all other calls. dt_s: by the host's clock.
    void advance(double dt_s) noexcept { clock_.advance(dt_s); }
    // Notes that the last accepted report gave a pose.
    void used() noexcept { clock_.used(); }
    [[nodiscard]] const ReportClock &clock() const noexcept { return clock_; }

    // Takes a cycle in which a usable report arrived. Call arrived() or absent() once per cycle.
    void arrived(double dt_s) noexcept {
        answered_ = true;
        since_report_s_ = 0.0;
        scale_ = std::min(1.0, scale_ + dt_s / kRecovery_s);
    }
    void absent(double dt_s) noexcept {
        since_report_s_ += dt_s;
        scale_ = stale() ? std::max(0.0, scale_ - dt_s / kFade_s) : scale_;
    }
    [[nodiscard]] double since_report_s() const noexcept { return since_report_s_; }
    // True when the newest report is too old. Half a time step covers rounding of summed steps.
    [[nodiscard]] bool stale() const noexcept { return since_report_s_ + slack_s_ >= stale_s_; }
    // True when a device that sent reports sends no more.
    [[nodiscard]] bool lost() const noexcept {
        return answered_ && since_report_s_ + slack_s_ >= lost_s_;
    }
    // Scale of the wrench, 0..1.
    [[nodiscard]] double scale() const noexcept { return scale_; }
    [[nodiscard]] bool at_rest() const noexcept { return scale_ >= 1.0; }
    // Checks restored memory: see core/base/sound_state.h.
    [[nodiscard]] bool is_sound() const noexcept {
        return are_flags(answered_) && order_.is_sound() && clock_.is_sound();
    }

private:
    // Time in which the wrench falls to zero without reports.
    static constexpr double kFade_s = 0.020;
    // Time in which the wrench returns.
    static constexpr double kRecovery_s = 0.050;

    double stale_s_ = 0.0;
    double lost_s_ = 0.0;
    double slack_s_ = 0.0;
    ReportOrder order_;
    ReportClock clock_;
    std::uint64_t device_time_us_ = 0;
    bool answered_ = false; // a report has arrived
    double since_report_s_ = 0.0;
    double scale_ = 1.0;
};

} // namespace spidar
