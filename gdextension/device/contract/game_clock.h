// The age of a game's request, and how long the loop may extrapolate it without a newer one.
#pragma once

#include <algorithm>

#include "core/base/sound_state.h"

namespace spidar {

// Time for which the velocity of a request extrapolates it (unit: s). Games with longer frames get
// 2.5 frames, since one frame may be dropped, up to kMostExtrapolation_s.
inline constexpr double kExtrapolation_s = 0.030;
inline constexpr double kMostExtrapolation_s = 0.100;

class GameClock {
public:
    // Takes a request. state_time_s: time of its snapshot; negative or in the future: unknown.
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
    // Time by which to extrapolate the request, from its snapshot.
    [[nodiscard]] double carried_s() const noexcept { return std::min(late_s_ + age_s_, most_s()); }
    // The part of carried_s() since the request arrived.
    [[nodiscard]] double carried_since_s() const noexcept {
        return carried_s() - std::min(late_s_, most_s());
    }
    // True while the request may still be extrapolated.
    [[nodiscard]] bool carries() const noexcept { return late_s_ + age_s_ <= most_s(); }
    // Checks restored memory: see core/base/sound_state.h.
    [[nodiscard]] bool is_sound() const noexcept { return are_flags(received_); }

private:
    // frames that a request is extrapolated for
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
