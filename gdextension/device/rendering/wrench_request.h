// The raw wrench that a game requests in seven DOF: it acts in full for the requested duration and
// then fades. Also the limits of the sum of all requests.
#pragma once

#include "core/base/sound_state.h"
#include "device/settings/gain_clamp.h"
#include "device/settings/servo_settings.h"

namespace spidar {

// Returns the largest factor up to 1 that brings force, moment and grasp torque within their
// limits. One factor for all seven DOF keeps the wrench's direction. Works for finite wrenches of
// any size; 0 for a wrench that is not finite.
[[nodiscard]] double limit_factor(const Wrench &wrench, const SafetySettings &safety) noexcept;

class WrenchRequest {
public:
    void configure(const SafetySettings &safety) noexcept;
    // Changes the limits for requests that are accepted from now on.
    void retune(const SafetySettings &safety) noexcept { safety_ = safety; }
    // Takes a valid request (validate_wrench). Returns what was clamped.
    GainClamp accept(const Wrench &wrench, double duration_s) noexcept;
    // Ages the request by one cycle; called before accept(). Returns true in the cycle in which it
    // ends.
    bool age(double dt_s) noexcept;
    [[nodiscard]] Wrench value() const noexcept;
    // True when nothing is requested, or the request acts in full.
    [[nodiscard]] bool at_rest() const noexcept { return rests_through(0.0); }
    [[nodiscard]] bool rests_through(double dt_s) const noexcept {
        return !live_ || age_s_ + dt_s <= duration_s_;
    }
    // Checks restored memory: see core/base/sound_state.h.
    [[nodiscard]] bool is_sound() const noexcept { return are_flags(live_); }

private:
    SafetySettings safety_{};
    Wrench wrench_{};
    double duration_s_ = 0.0;
    double age_s_ = 0.0;
    bool live_ = false;
};

} // namespace spidar
