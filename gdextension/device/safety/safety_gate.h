// The last stage before the motors. Its tensions are finite and within [0, max]. They change by no
// more than the slew limit, except that NaN, negative input and shut() give 0 N at once.
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

    // A maximum that is not positive and finite keeps its string at 0 N. A slew limit that is not
    // positive and finite keeps all strings at 0 N.
    void configure(const StringArray &max_tensions_n, double slew_n_per_ms) noexcept;

    // Returns the tensions to send. NaN and negative inputs give 0 N at once; all others are
    // approached by at most slew * dt.
    Output pass(const StringArray &tensions_n, double dt_s) noexcept;
    // Switches the motors off in this cycle, without slew limit.
    void shut() noexcept { last_n_ = {}; }

private:
    StringArray max_n_{};
    double slew_n_per_s_ = 0.0;
    StringArray last_n_{};
};

} // namespace spidar
