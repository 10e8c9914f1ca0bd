// First-order low-pass filter, exact at any time step. The caller keeps the filtered value and
// moves it toward the input by share() of their difference.
#pragma once

#include <cmath>
#include <numbers>

namespace spidar {

class OnePole {
public:
    explicit OnePole(double cutoff_hz = 0.0) noexcept
        : cutoff_rad_s_(2.0 * std::numbers::pi * cutoff_hz) {}

    // Returns the share (0..1) for one step of dt_s seconds. The share of the last dt_s is kept,
    // which saves an exponential per cycle.
    double share(double dt_s) noexcept {
        if (dt_s != dt_s_) {
            dt_s_ = dt_s;
            share_ = -std::expm1(-cutoff_rad_s_ * dt_s);
        }
        return share_;
    }

private:
    double cutoff_rad_s_;
    double dt_s_ = 0.0;
    double share_ = 0.0; // the share for dt_s_
};

} // namespace spidar
