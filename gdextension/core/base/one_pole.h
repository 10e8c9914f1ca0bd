// A first-order low-pass filter, exact at any time step: which share of the way to its input a value goes.
#pragma once

#include <cmath>
#include <numbers>

namespace spidar {

class OnePole {
public:
    explicit OnePole(double cutoff_hz = 0.0) noexcept
        : cutoff_rad_s_(2.0 * std::numbers::pi * cutoff_hz) {}

    // In one step. The last time step's share is kept: an exponential a cycle is saved.
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
    double share_ = 0.0; // of a time step of dt_s_
};

} // namespace spidar
