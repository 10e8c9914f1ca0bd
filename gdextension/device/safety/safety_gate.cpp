#include "device/safety/safety_gate.h"

#include <cmath>

namespace spidar {

void SafetyGate::configure(const StringArray &max_tensions_n, double slew_n_per_ms) noexcept {
    constexpr double kMillisecondsPerSecond = 1000.0;
    slew_n_per_s_ = slew_n_per_ms > 0.0 && std::isfinite(slew_n_per_ms)
                        ? slew_n_per_ms * kMillisecondsPerSecond
                        : 0.0;
    for (std::size_t i = 0; i < max_n_.size(); ++i) {
        const double limit = max_tensions_n[i];
        max_n_[i] = limit > 0.0 && std::isfinite(limit) ? limit : 0.0;
    }
    last_n_ = {};
}

SafetyGate::Output SafetyGate::pass(const StringArray &tensions_n, double dt_s) noexcept {
    Output output;
    const double step_n = dt_s > 0.0 && std::isfinite(dt_s) ? slew_n_per_s_ * dt_s : 0.0;
    for (std::size_t i = 0; i < last_n_.size(); ++i) {
        double wanted_n = tensions_n[i];
        // Written so that NaN fails the comparison and gives zero.
        if (!(wanted_n >= 0.0)) {
            output.clamped = true;
            last_n_[i] = 0.0;
            continue;
        }
        if (!(wanted_n <= max_n_[i])) {
            output.clamped = true;
            wanted_n = max_n_[i];
        }
        const double change_n = wanted_n - last_n_[i];
        if (std::abs(change_n) > step_n) {
            output.slewed = true;
            wanted_n = last_n_[i] + std::copysign(step_n, change_n);
        }
        last_n_[i] = wanted_n;
    }
    output.tensions_n = last_n_;
    return output;
}

} // namespace spidar
