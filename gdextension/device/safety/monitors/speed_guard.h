// Detects a grip that is faster than a hand moves it. Above the fade limits for kHold_s the wrench
// fades until the grip slows; above the maximum limits the motors go off at once.
#pragma once

#include <algorithm>

#include <glm/geometric.hpp>

#include "core/base/sound_state.h"
#include "core/base/types.h"
#include "device/settings/servo_settings.h"

namespace spidar {

class SpeedGuard {
public:
    static constexpr double kHold_s = 0.003;

    void configure(const SafetySettings &safety) noexcept {
        safety_ = safety;
        fast_s_ = 0.0;
        too_fast_ = false;
    }
    // fastest_m_s: speed of the fastest point among grip center and pole ends.
    void update(double fastest_m_s, const Twist &twist, double dt_s) noexcept {
        const double turn_rad_s = glm::length(twist.angular_rad_s);
        // Written so that NaN counts as too fast.
        too_fast_ = !(fastest_m_s <= safety_.max_grip_speed_m_s) ||
                    !(turn_rad_s <= safety_.max_turn_rate_rad_s);
        const bool fast = too_fast_ || fastest_m_s > safety_.fade_grip_speed_m_s ||
                          turn_rad_s > safety_.fade_turn_rate_rad_s;
        fast_s_ = fast ? std::min(1.0, fast_s_ + dt_s) : 0.0;
    }

    [[nodiscard]] bool at_rest() const noexcept { return fast_s_ == 0.0; }
    // True when fast for kHold_s. Half a time step of slack covers rounding of summed steps.
    [[nodiscard]] bool fast(double dt_s) const noexcept {
        return fast_s_ > 0.0 && fast_s_ + 0.5 * dt_s >= kHold_s;
    }
    [[nodiscard]] bool too_fast() const noexcept { return too_fast_; }
    // Checks restored memory: see core/base/sound_state.h.
    [[nodiscard]] bool is_sound() const noexcept { return are_flags(too_fast_); }

private:
    SafetySettings safety_{};
    double fast_s_ = 0.0;
    bool too_fast_ = false;
};

} // namespace spidar
