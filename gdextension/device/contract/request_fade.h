// How requests start, change and end. A game updates 30 to 144 times per second, and the servo loop
// renders 1000 times (default). A change must not reach the hand as a jolt, and a request that is
// no longer refreshed must end.
#pragma once

#include <algorithm>

#include "device/settings/servo_settings.h"

namespace spidar {

// Time over which the difference between two updates is spread (unit: s): about one frame at 60 Hz.
inline constexpr double kCrossFade_s = 0.016;
// Returns the weight (0..1) of the new value, since_s after the update. The weight of the old value
// is 1 minus this.
[[nodiscard]] inline double cross_fade(double since_s) noexcept {
    return std::min(1.0, since_s / kCrossFade_s);
}
// Returns the value between `from` (share 0) and `to` (share 1).
[[nodiscard]] inline double blend(double from, double to, double share) noexcept {
    return from + share * (to - from);
}

// Returns the strength (0..1) of a request whose duration ended past_s ago and that then fades over
// fade_s. past_s is negative before the end.
[[nodiscard]] inline double faded_out(double past_s, double fade_s) noexcept {
    return std::clamp(1.0 - std::max(0.0, past_s) / fade_s, 0.0, 1.0);
}

// Strength of a request that the game refreshes each frame. It falls to 0 as the last update ages,
// and returns gradually with the next update.
class RefreshedStrength {
public:
    // Time in which the strength rises from 0 to 1 (unit: s), also after a pause of the game.
    static constexpr double kOnset_s = 0.050;

    explicit RefreshedStrength(double strength) noexcept : strength_(strength) {}
    void configure(const SafetySettings &safety) noexcept {
        full_s_ = safety.contacts_full_s;
        gone_s_ = safety.contacts_gone_s;
    }
    void set(double strength) noexcept { strength_ = strength; }
    // Takes one cycle. age_s: time since the last update. Returns false when the request has
    // expired.
    bool advance(double age_s, double dt_s) noexcept {
        const double left = std::clamp(1.0 - (age_s - full_s_) / (gone_s_ - full_s_), 0.0, 1.0);
        strength_ = std::min(left, strength_ + dt_s / kOnset_s);
        return left > 0.0;
    }
    // 0..1.
    [[nodiscard]] double value() const noexcept { return strength_; }

private:
    // Age up to which a request has full strength (unit: s).
    double full_s_ = 0.1;
    // Age at which a request has no strength (unit: s).
    double gone_s_ = 0.3;
    double strength_;
};

} // namespace spidar
