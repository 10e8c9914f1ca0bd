// Energy at the grip, per DOF: an observer of what the requests do to the hand, and a controller that takes back
// what a wrench or coupling held between two frames of the game gives too much (Hannaford and Ryu 2002).
#pragma once

#include "core/base/sound_state.h"
#include "device/contract/dof_lanes.h"
#include "device/contract/haptic_command.h"

namespace spidar {

// The work is exact for a wrench that is held over each cycle: force of the last cycle times the move since.
class EnergyObserver {
public:
    // moved: in the cycle during which the last held() acted.
    void update(const Displacement &moved) noexcept;
    // What acts until the next update.
    void hold(const Wrench &wrench) noexcept;
    // Without motion no work is done.
    [[nodiscard]] bool at_rest() const noexcept { return !moving_; }
    // Net work done on the hand in each DOF since the last reset(); positive is energy given to the hand (unit: J).
    [[nodiscard]] const DofLanes &injected_j() const noexcept { return injected_j_; }
    // core/base/sound_state.h
    [[nodiscard]] bool is_sound() const noexcept { return are_flags(moving_); }

private:
    DofLanes held_{};
    DofLanes injected_j_{};
    bool moving_ = false; // in the last update()
};

// Damps a DOF while its changing part has given the hand more than it took. A slow force, such as a weight, is the
// game's own will and is left alone: only what changes within kSlow_s is watched.
class PassivityController {
public:
    static constexpr double kSlow_s = 0.2;
    // No more than this is remembered as taken, so that a long hold does not pay for a later blow.
    static constexpr double kStore_j = 0.005;
    // Both what was taken and what was given are forgotten over this: each tap is judged by itself.
    static constexpr double kMemory_s = 0.2;

    // Damping that may be added; all zero switches the controller off.
    void configure(const DofGains &most_damping) noexcept;
    void reset() noexcept;
    // The wrench to give in place of `asked`.
    Wrench correct(const Wrench &asked, const Displacement &moved, const Twist &velocity,
                   double dt_s) noexcept;
    // Nothing changes any more while nothing is asked, wherever the grip moves.
    [[nodiscard]] bool at_rest() const noexcept { return at_rest_; }
    // core/base/sound_state.h
    [[nodiscard]] bool is_sound() const noexcept { return are_flags(at_rest_); }

private:
    DofGains most_{};
    DofLanes slow_{};
    DofLanes changing_{}; // held since the last cycle
    DofLanes store_j_{};
    bool at_rest_ = true;
};

} // namespace spidar
