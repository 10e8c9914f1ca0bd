// How old the newest report is, by the device's own clock, and how long apart two reports were made. So a report that is
// lost, late or overtaken, or a device whose clock is not the host's, changes no velocity and no pose of now.
//
// A report comes in some time after it was made. The shortest such delay counts as none: it is part of the link's latency,
// which prediction takes care of. What comes later than that is old by the difference. Both clocks run at their own rate,
// so the shortest delay is looked for in each stretch of kStretch_s, and what it grows by is the drift.
#pragma once

#include <cstdint>

#include "core/base/sound_state.h"

namespace spidar {

class ReportClock {
public:
    // A report that seems older than this is a clock that is wrong, not a pose to be carried on so far.
    static constexpr double kOldest_s = 0.003;
    // Clocks of crystals differ by less than this. Else the device's times are not believed.
    static constexpr double kMostDrift = 0.02;

    void reset() noexcept { *this = ReportClock(); }

    // Once a cycle, before its report. dt_s: of the host's clock.
    void advance(double dt_s) noexcept { since_arrival_s_ += dt_s; }
    // A new report came in. device_us: when it was made; 0 each time when the device has no clock.
    void arrived(std::uint64_t device_us) noexcept;
    // The report that came in last gave a pose.
    void used() noexcept { since_used_s_ = 0.0; }

    // From when the report that was used last was made to when the newest was.
    [[nodiscard]] double since_used_s() const noexcept { return since_used_s_; }
    // From when the report before was made to when the newest was.
    [[nodiscard]] double apart_s() const noexcept { return apart_s_; }
    // From when the newest report was made to now, 0 to kOldest_s. In cycles with a report.
    [[nodiscard]] double age_s() const noexcept { return age_s_; }
    // core/base/sound_state.h
    [[nodiscard]] bool is_sound() const noexcept {
        return are_flags(known_, believed_, has_before_);
    }

private:
    static constexpr double kStretch_s = 0.25;
    // Steps of the device's clock are as fine as this.
    static constexpr double kGrain_s = 2e-6;
    // Two reports are not made closer together than this, whatever their times say.
    static constexpr double kClosest_s = 1e-4;

    [[nodiscard]] double made_after_s(std::uint64_t device_us) const noexcept;
    void end_stretch() noexcept;

    std::uint64_t device_us_ = 0;
    bool known_ = false;   // any report yet
    bool believed_ = true; // the device's clock
    double since_arrival_s_ = 0.0;
    double since_used_s_ = 0.0;
    double apart_s_ = 0.0;
    double age_s_ = 0.0;
    // Host's time less the device's time stretched by the drift, from the first report on; and the least it can be now.
    double lag_s_ = 0.0;
    double floor_s_ = 0.0;
    double to_come_s_ =
        0.0; // of a change of the floor that is made little by little: a step would be felt
    double drift_ = 0.0;
    // This stretch: its length so far, the least lag in it and when that was.
    double stretch_s_ = 0.0;
    double least_s_ = 0.0;
    double least_at_s_ = 0.0;
    // The least lag of the stretch before, on today's scale, and how long before this stretch it was.
    bool has_before_ = false;
    double before_s_ = 0.0;
    double before_ago_s_ = 0.0;
};

} // namespace spidar
