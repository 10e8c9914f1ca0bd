// A weight on a string that was taken off the grip, resting on the ground until its motor lifts it.
#pragma once

#include <algorithm>
#include <cmath>

namespace spidar::test {

class HungWeight {
public:
    // A string of -1 takes the weight away: it is let down by hand, as no string gets longer in no time. The same string
    // again: as it hangs.
    void hang(int string, double weight_n) noexcept {
        if (string < 0) {
            weight_n_ = 0.0;
            return;
        }
        if (string != string_) {
            string_ = string;
            height_m_ = 0.0;
            speed_m_s_ = 0.0;
        }
        weight_n_ = weight_n;
    }
    [[nodiscard]] bool hangs() const noexcept {
        return string_ >= 0 && (weight_n_ > 0.0 || height_m_ > 0.0);
    }
    [[nodiscard]] int string() const noexcept { return string_; }
    [[nodiscard]] double height_m() const noexcept { return height_m_; }

    // pull_n: of the motor. Friction of the drum is against the movement, and holds the weight while it can.
    void advance(double pull_n, double dt_s) noexcept {
        if (!(weight_n_ > 0.0)) {
            speed_m_s_ = 0.0;
            height_m_ = std::max(0.0, height_m_ - kLetDown_m_s * dt_s);
            return;
        }
        const double force_n = pull_n - weight_n_;
        const double mass_kg = weight_n_ / kGravity_m_s2 + kRotor_kg;
        const double hold_n = kFriction_n + mass_kg * std::fabs(speed_m_s_) / std::max(dt_s, 1e-6);
        const double pushed_n = force_n + mass_kg * speed_m_s_ / std::max(dt_s, 1e-6);
        if (std::fabs(pushed_n) <= kFriction_n && std::fabs(force_n) <= hold_n) {
            speed_m_s_ = 0.0;
        } else {
            const double friction_n = std::copysign(kFriction_n, pushed_n);
            speed_m_s_ += (force_n - friction_n - kViscous_n_s_m * speed_m_s_) / mass_kg * dt_s;
        }
        height_m_ += speed_m_s_ * dt_s;
        if (height_m_ < 0.0) { // on the ground
            height_m_ = 0.0;
            speed_m_s_ = std::max(0.0, speed_m_s_);
        }
    }

private:
    static constexpr double kGravity_m_s2 = 9.81;
    static constexpr double kLetDown_m_s = 0.2;
    static constexpr double kRotor_kg = 0.017; // as the plant's
    static constexpr double kFriction_n = 0.05;
    static constexpr double kViscous_n_s_m = 0.3;

    int string_ = -1;
    double weight_n_ = 0.0;
    double height_m_ = 0.0;
    double speed_m_s_ = 0.0;
};

} // namespace spidar::test
