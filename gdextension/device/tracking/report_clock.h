// Age of the newest report and time between two reports, by the device's clock. A report that is
// lost, late or superseded, or a device clock that differs from the host's, therefore changes
// neither the velocity nor the present pose.
//
// A report arrives some time after it was made. The shortest delay counts as zero, since the
// prediction of the renderer covers it as part of the link's latency. The age of a report is its
// delay minus the shortest one. The two clocks run at different rates: the drift is the growth of
// the shortest delay from one interval of kStretch_s to the next.
#pragma once

#include <cstdint>

#include "core/base/sound_state.h"

namespace spidar {

class ReportClock {
public:
    // Largest age that is used (unit: s). A larger one comes from a wrong clock.
    static constexpr double kOldest_s = 0.003;
    // Largest drift between two crystal clocks. Beyond it the device's times are not used.
    static constexpr double kMostDrift = 0.02;

    void reset() noexcept { *this = ReportClock(); }

    // Takes one cycle, before its report. dt_s: by the host's clock.
    void advance(double dt_s) noexcept { since_arrival_s_ += dt_s; }
    // Takes a new report. device_us: device time at which the report was made; always 0 when the
    // device has no clock.
    void arrived(std::uint64_t device_us) noexcept;
    // Notes that the last report gave a pose.
    void used() noexcept { since_used_s_ = 0.0; }

    // Time between the making of the last used report and that of the newest (unit: s).
    [[nodiscard]] double since_used_s() const noexcept { return since_used_s_; }
    // Time between the making of the last two reports (unit: s).
    [[nodiscard]] double apart_s() const noexcept { return apart_s_; }
    // Age of the newest report, 0 to kOldest_s. Valid in cycles with a report.
    [[nodiscard]] double age_s() const noexcept { return age_s_; }
    // Checks restored memory: see core/base/sound_state.h.
    [[nodiscard]] bool is_sound() const noexcept {
        return are_flags(known_, believed_, has_before_);
    }

private:
    static constexpr double kStretch_s = 0.25;
    // Resolution of the device's clock.
    static constexpr double kGrain_s = 2e-6;
    // A shorter time between two reports counts as this.
    static constexpr double kClosest_s = 1e-4;

    [[nodiscard]] double made_after_s(std::uint64_t device_us) const noexcept;
    void end_stretch() noexcept;

    std::uint64_t device_us_ = 0;
    bool known_ = false;   // a report has arrived
    bool believed_ = true; // the device's clock is used
    double since_arrival_s_ = 0.0;
    double since_used_s_ = 0.0;
    double apart_s_ = 0.0;
    double age_s_ = 0.0;
    // Host time minus the device time corrected for drift, since the first report.
    double lag_s_ = 0.0;
    // Value of lag_s_ for the shortest delay; the age of a report is measured from it.
    double floor_s_ = 0.0;
    // Part of a change of the floor that is still to be made, in small steps: a jump would be felt.
    double to_come_s_ = 0.0;
    double drift_ = 0.0;
    // The current interval: its length so far, its smallest lag and the time of that lag.
    double stretch_s_ = 0.0;
    double least_s_ = 0.0;
    double least_at_s_ = 0.0;
    // Smallest lag of the previous interval, extrapolated by the drift to its end, and how long
    // before that end it was measured.
    bool has_before_ = false;
    double before_s_ = 0.0;
    double before_ago_s_ = 0.0;
};

} // namespace spidar
