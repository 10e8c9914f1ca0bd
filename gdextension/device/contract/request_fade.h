// How requests come and go. A game speaks 30 to 144 times a second and the servo loop renders 1000 times: what the game
// changes must not reach the hand as a blow, and what it stops to refresh must not act for ever.
#pragma once

#include <algorithm>

#include "device/settings/servo_settings.h"

namespace spidar {

// One game period at 60 Hz: what jumps between two updates is spread over it.
inline constexpr double kCrossFade_s = 0.016;
// The new value's share, since_s after the update; the old one has the rest.
[[nodiscard]] inline double cross_fade(double since_s) noexcept {
    return std::min(1.0, since_s / kCrossFade_s);
}
// From `from` (share 0) to `to` (share 1).
[[nodiscard]] inline double blend(double from, double to, double share) noexcept {
    return from + share * (to - from);
}

// What is left of a request whose full duration ended past_s ago (negative: not yet) and that fades over fade_s.
[[nodiscard]] inline double faded_out(double past_s, double fade_s) noexcept {
    return std::clamp(1.0 - std::max(0.0, past_s) / fade_s, 0.0, 1.0);
}

// Strength of a request that the game refreshes each frame: falls to nothing as the last update grows old, and comes
// back gradually when the game does.
class RefreshedStrength {
public:
    // From nothing to full, after a pause of the game too: not with a blow.
    static constexpr double kOnset_s = 0.050;

    explicit RefreshedStrength(double strength) noexcept : strength_(strength) {}
    void configure(const SafetySettings &safety) noexcept {
        full_s_ = safety.contacts_full_s;
        gone_s_ = safety.contacts_gone_s;
    }
    void set(double strength) noexcept { strength_ = strength; }
    // One cycle. age_s: of the last update. False: the request is so old that it is to be dropped.
    bool advance(double age_s, double dt_s) noexcept {
        const double left = std::clamp(1.0 - (age_s - full_s_) / (gone_s_ - full_s_), 0.0, 1.0);
        strength_ = std::min(left, strength_ + dt_s / kOnset_s);
        return left > 0.0;
    }
    // 0..1.
    [[nodiscard]] double value() const noexcept { return strength_; }

private:
    double full_s_ = 0.1;
    double gone_s_ = 0.3;
    double strength_;
};

} // namespace spidar
