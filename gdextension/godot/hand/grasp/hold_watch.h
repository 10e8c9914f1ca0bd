// Decides when a hold breaks: when the world presses on the held body too strongly, or keeps it too
// far from the grip, for long enough.
#pragma once

#include <algorithm>

namespace spidar {

class HoldWatch {
public:
    // Restarts for a body that was just grasped.
    void reset() noexcept { *this = HoldWatch(); }

    // Called once per physics tick, whose length is tick_s. Returns true when the hold breaks.
    // press_n: force of the world on the body. break_force: its limit (unit: N). since_s: device
    // time since the last value of press_n; 0: no new value. stretch_m: device meters between the
    // body and its target in the grip.
    [[nodiscard]] bool breaks(double press_n, double break_force, double since_s, double stretch_m,
                              double tick_s) noexcept {
        if (since_s > 0.0) {
            overload_s_ = press_n > break_force ? overload_s_ + since_s : 0.0;
        }
        torn_s_ = stretch_m > kMaxStretch_m ? torn_s_ + tick_s : 0.0;
        return std::max(overload_s_, torn_s_) >= kBreakTime_s;
    }

private:
    // Distance from its target at which a held body counts as stuck behind something (unit: m).
    static constexpr double kMaxStretch_m = 0.015;
    // A hold breaks after this long with too much force (in device time) or with too much stretch
    // (in physics ticks; unit: s).
    static constexpr double kBreakTime_s = 0.05;

    double overload_s_ = 0.0;
    double torn_s_ = 0.0;
};

} // namespace spidar
