// Decides when the world takes a held body away: when it has pressed on the body, or torn it from the grip, for long enough.
#pragma once

#include <algorithm>

namespace spidar {

class HoldWatch {
public:
    // A body has just been caught.
    void reset() noexcept { *this = HoldWatch(); }

    // Once a physics tick of tick_s. press_n: what the world presses on the body; since_s: device time since it was told
    // before, 0 when nothing new is known of it. stretch_m: device metres between the body and its place in the grip.
    [[nodiscard]] bool breaks(double press_n, double break_force, double since_s, double stretch_m,
                              double tick_s) noexcept {
        if (since_s > 0.0) {
            overload_s_ = press_n > break_force ? overload_s_ + since_s : 0.0;
        }
        torn_s_ = stretch_m > kMaxStretch_m ? torn_s_ + tick_s : 0.0;
        return std::max(overload_s_, torn_s_) >= kBreakTime_s;
    }

private:
    // A held body torn this far from the grip is stuck behind something.
    static constexpr double kMaxStretch_m = 0.015;
    // How long it takes to break a hold: a load by the device's time, a stretch by the number of physics ticks.
    static constexpr double kBreakTime_s = 0.05;

    double overload_s_ = 0.0;
    double torn_s_ = 0.0;
};

} // namespace spidar
