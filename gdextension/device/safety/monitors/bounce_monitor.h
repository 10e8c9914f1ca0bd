// Does the grip bounce off what is rendered harder than it came? A contact that is too stiff for its latency throws a
// light hand back, the hand comes again: a swing of a few hertz, too slow for the shake monitor, that gains energy at
// each touch. A tap loses it.
#pragma once

#include "core/base/sound_state.h"
#include "device/contract/dof_lanes.h"

namespace spidar {

class BounceMonitor {
public:
    void configure() noexcept { *this = BounceMonitor(); }
    // One cycle. push: of all contacts on the grip, in the last cycle. True when a row of such bounces is complete.
    bool update(const Twist &twist, const Wrench &push, double dt_s) noexcept;
    // Nothing touches and no row is begun: time alone changes nothing that matters.
    [[nodiscard]] bool at_rest() const noexcept { return !touching_ && row_ == 0; }
    // With which the last bounce of the row left (unit: m/s at the pole ends).
    [[nodiscard]] double speed_m_s() const noexcept { return speed_m_s_; }
    // core/base/sound_state.h
    [[nodiscard]] bool is_sound() const noexcept { return are_flags(touching_) && is_tally(row_); }

private:
    DofLanes arrival_m_s_{};
    DofLanes impulse_ns_{};
    double touched_s_ = 0.0; // how long, while it touches
    double since_s_ = 0.0;   // the last bounce
    double speed_m_s_ = 0.0;
    int row_ = 0;
    bool touching_ = false;
};

} // namespace spidar
