// Estimates whether a hand holds the grip. A hand is never quite still; a grip held by strings
// alone is. A real device arms only when the grip has moved lately.
#pragma once

#include <algorithm>

#include <glm/geometric.hpp>

#include "core/base/sound_state.h"
#include "core/geometry/grip_geometry.h"
#include "device/settings/servo_settings.h"

namespace spidar {

class HandPresence {
public:
    // Movement of P0 or of a pole's end that counts (unit: m): twenty encoder counts, more than
    // encoder flicker.
    static constexpr double kMove_m = 0.0005;

    void configure(const SafetySettings &safety) noexcept {
        limit_s_ = safety.hand_presence_s;
        restart();
    }
    // Counts the grip as still until it moves.
    void restart() noexcept {
        known_ = false;
        moved_ = false;
        still_s_ = 0.0;
    }
    // True when the last update() found no movement: only the time without motion changes.
    [[nodiscard]] bool at_rest() const noexcept { return !moving_; }
    void advance_at_rest(double dt_s) noexcept { still_s_ += dt_s; }
    void update(const GripPose &pose, double dt_s) noexcept {
        const auto square = [](const Vec3 &apart) { return glm::dot(apart, apart); };
        const double moved_m2 =
            std::max({square(pose.position_m - anchor_.position_m),
                      square(pose.r1_m - anchor_.r1_m), square(pose.r2_m - anchor_.r2_m)});
        still_s_ += dt_s;
        moving_ = !known_ || moved_m2 > kMove_m * kMove_m;
        if (!moving_) {
            return;
        }
        moved_ = known_;
        known_ = true;
        anchor_ = pose;
        still_s_ = 0.0;
    }
    // True when the grip moved within the limit, or when the limit is 0.
    [[nodiscard]] bool present() const noexcept {
        return !(limit_s_ > 0.0) || (moved_ && still_s_ <= limit_s_);
    }
    // Checks restored memory: see core/base/sound_state.h.
    [[nodiscard]] bool is_sound() const noexcept { return are_flags(known_, moved_, moving_); }

private:
    double limit_s_ = 0.0;
    double still_s_ = 0.0;
    bool known_ = false;
    bool moved_ = false;
    bool moving_ = false; // moved in the last update()
    GripPose anchor_{};
};

} // namespace spidar
