// The age of a game's request, and how long the loop may extrapolate it without a newer one.
#pragma once

#include <algorithm>

#include "core/base/sound_state.h"

namespace spidar {

// Time for which a request is extrapolated by its velocity (unit: s). If 2.5 frames of the game
// take longer, that time is used, up to kMostExtrapolation_s: one frame may be dropped.
inline constexpr double kExtrapolation_s = 0.030;
inline constexpr double kMostExtrapolation_s = 0.100;

class GameClock {
public:
    // Takes a request. state_time_s: time of the snapshot that the game computed it from. If it is
    // negative or later than now_s, the age of the snapshot counts as 0.
    void receive(double state_time_s, double now_s) noexcept {
        const bool stamped = state_time_s >= 0.0 && state_time_s <= now_s;
        late_s_ = stamped ? std::min(now_s - state_time_s, kMostExtrapolation_s) : 0.0;
        if (received_) {
            frame_s_ += kNewest * (std::min(age_s_, kMostExtrapolation_s) - frame_s_);
        }
        received_ = true;
        age_s_ = 0.0;
    }
    void advance(double dt_s) noexcept { age_s_ += dt_s; }

    // Time since the request arrived.
    [[nodiscard]] double age_s() const noexcept { return age_s_; }
    // How far ahead to extrapolate the request: the time since its snapshot, at most most_s()
    // (unit: s).
    [[nodiscard]] double carried_s() const noexcept { return std::min(late_s_ + age_s_, most_s()); }
    // The part of carried_s() that lies after the arrival of the request (unit: s).
    [[nodiscard]] double carried_since_s() const noexcept {
        return carried_s() - std::min(late_s_, most_s());
    }
    // True until the time since the snapshot exceeds most_s().
    [[nodiscard]] bool carries() const noexcept { return late_s_ + age_s_ <= most_s(); }
    // Checks restored memory: see core/base/sound_state.h.
    [[nodiscard]] bool is_sound() const noexcept { return are_flags(received_); }

private:
    // Number of frames for which a request is extrapolated.
    static constexpr double kFrames = 2.5;
    static constexpr double kNewest = 0.25; // share of the newest frame in the mean

    [[nodiscard]] double most_s() const noexcept {
        return std::clamp(kFrames * frame_s_, kExtrapolation_s, kMostExtrapolation_s);
    }

    double age_s_ = 0.0;
    double late_s_ = 0.0;
    double frame_s_ = 0.0; // mean time between requests
    bool received_ = false;
};

} // namespace spidar
