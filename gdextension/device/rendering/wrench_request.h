// The wrench in seven DOF that a game asks for itself, beside contacts and coupling: in full for the time asked for, then
// faded. And the limits that every sum of requests is brought within.
#pragma once

#include "core/base/sound_state.h"
#include "device/settings/gain_clamp.h"
#include "device/settings/servo_settings.h"

namespace spidar {

// The factor (0..1] that brings force, moment and grasp torque inside their limits. One factor for all seven
// DOF: the direction of the wrench is kept. Holds for every finite wrench, 1e308 too; 0 for one that is not.
[[nodiscard]] double limit_factor(const Wrench &wrench, const SafetySettings &safety) noexcept;

class WrenchRequest {
public:
    void configure(const SafetySettings &safety) noexcept;
    // Other limits for what is accepted from now on.
    void retune(const SafetySettings &safety) noexcept { safety_ = safety; }
    // A valid request (validate_wrench). Says when it had to be brought down to a limit.
    GainClamp accept(const Wrench &wrench, double duration_s) noexcept;
    // Once a cycle, before accept(). True in the cycle in which the request ends.
    bool age(double dt_s) noexcept;
    [[nodiscard]] Wrench value() const noexcept;
    // Not asked for, or in full.
    [[nodiscard]] bool at_rest() const noexcept { return rests_through(0.0); }
    [[nodiscard]] bool rests_through(double dt_s) const noexcept {
        return !live_ || age_s_ + dt_s <= duration_s_;
    }
    // core/base/sound_state.h
    [[nodiscard]] bool is_sound() const noexcept { return are_flags(live_); }

private:
    SafetySettings safety_{};
    Wrench wrench_{};
    double duration_s_ = 0.0;
    double age_s_ = 0.0;
    bool live_ = false;
};

} // namespace spidar
