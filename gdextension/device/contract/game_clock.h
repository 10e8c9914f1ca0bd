// How old a request is that a game computed from a snapshot, and how long it may be carried on without the next one.
#pragma once

#include <algorithm>

#include "core/base/sound_state.h"

namespace spidar {

// What moves is carried on by its velocity no longer than this; for games with longer frames, two and a half of them
// (one may be dropped), but never longer than the second.
inline constexpr double kExtrapolation_s = 0.030;
inline constexpr double kMostExtrapolation_s = 0.100;

class GameClock {
public:
    // A request came. state_time_s: of the snapshot that it was computed from; negative or later than now: unknown.
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

    // Since it came.
    [[nodiscard]] double age_s() const noexcept { return age_s_; }
    // How far to carry it on.
    [[nodiscard]] double carried_s() const noexcept { return std::min(late_s_ + age_s_, most_s()); }
    // The part of that since it came: what has been carried to that moment already moves on by this.
    [[nodiscard]] double carried_since_s() const noexcept {
        return carried_s() - std::min(late_s_, most_s());
    }
    [[nodiscard]] bool carries() const noexcept { return late_s_ + age_s_ <= most_s(); }
    // core/base/sound_state.h
    [[nodiscard]] bool is_sound() const noexcept { return are_flags(received_); }

private:
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
