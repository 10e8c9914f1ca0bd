// Detects a grip that leaves the rendered contacts faster than it came. A contact that is too stiff
// for its latency throws a light hand back, and the hand returns: an oscillation of a few hertz,
// too slow for the shake monitor, that gains energy at each touch. A tap loses energy.
#pragma once

#include "core/base/sound_state.h"
#include "device/contract/dof_lanes.h"

namespace spidar {

class BounceMonitor {
public:
    void configure() noexcept { *this = BounceMonitor(); }
    // Takes one cycle. push: wrench of all contacts on the grip in the last cycle. Returns true at
    // the third such bounce in a row.
    bool update(const Twist &twist, const Wrench &push, double dt_s) noexcept;
    // True when nothing touches and no series has begun.
    [[nodiscard]] bool at_rest() const noexcept { return !touching_ && row_ == 0; }
    // Speed after the last bounce (unit: m/s at the pole ends).
    [[nodiscard]] double speed_m_s() const noexcept { return speed_m_s_; }
    // Checks restored memory: see core/base/sound_state.h.
    [[nodiscard]] bool is_sound() const noexcept { return are_flags(touching_) && is_tally(row_); }

private:
    DofLanes arrival_m_s_{};
    DofLanes impulse_ns_{};
    double touched_s_ = 0.0; // duration of the current touch
    double since_s_ = 0.0;   // time since the last bounce
    double speed_m_s_ = 0.0;
    int row_ = 0;
    bool touching_ = false;
};

} // namespace spidar
