// The last stage before the motors. Whatever comes in, what goes out is finite, within [0, max], and moves no
// faster than the slew limit.
#pragma once

#include "core/base/types.h"

namespace spidar {

class SafetyGate {
public:
    struct Output {
        StringArray tensions_n{};
        bool slewed = false;  // the slew limit changed a tension
        bool clamped = false; // an input was NaN, negative or above the maximum
    };

    // Both must be positive and finite; else the gate stays shut (everything zero).
    void configure(const StringArray &max_tensions_n, double slew_n_per_ms) noexcept;

    // NaN and negative tensions become 0 N at once; all else approaches by at most slew * dt.
    Output pass(const StringArray &tensions_n, double dt_s) noexcept;
    // Motors off, in this very cycle: no slew.
    void shut() noexcept { last_n_ = {}; }

private:
    StringArray max_n_{};
    double slew_n_per_s_ = 0.0;
    StringArray last_n_{};
};

} // namespace spidar
