// Energy at the grip per DOF. An observer measures the work of the achieved wrench on the hand. A
// controller takes back the energy that a coupling gives in excess because the game updates it only
// once a frame (Hannaford and Ryu 2002).
#pragma once

#include "core/base/sound_state.h"
#include "device/contract/dof_lanes.h"
#include "device/contract/haptic_command.h"

namespace spidar {

// Sums force of the last cycle times displacement since then: the exact work of a wrench that is
// held over each cycle.
class EnergyObserver {
public:
    // moved: displacement in the cycle in which the last held wrench acted.
    void update(const Displacement &moved) noexcept;
    // Sets the wrench that acts until the next update.
    void hold(const Wrench &wrench) noexcept;
    // True without motion, since no work is done.
    [[nodiscard]] bool at_rest() const noexcept { return !moving_; }
    // Net work on the hand per DOF since the start (unit: J); positive: given to the hand.
    [[nodiscard]] const DofLanes &injected_j() const noexcept { return injected_j_; }
    // Checks restored memory: see core/base/sound_state.h.
    [[nodiscard]] bool is_sound() const noexcept { return are_flags(moving_); }

private:
    DofLanes held_{};
    DofLanes injected_j_{};
    bool moving_ = false; // in the last update()
};

// Damps a DOF while the changing part of its force has given the hand more energy than it took
// back. A slow force, such as a weight, is intended by the game and is left alone: a low-pass
// filter with the time constant kSlow_s separates it from the changing part.
class PassivityController {
public:
    // Time constant that separates slow forces from changing ones.
    static constexpr double kSlow_s = 0.2;
    // Limit of the balance that is kept, for energy taken and for energy given: energy that was
    // taken in a long hold must not allow a later jolt.
    static constexpr double kStore_j = 0.005;
    // Time constant with which the balance is forgotten, so that each tap is judged by itself.
    static constexpr double kMemory_s = 0.2;

    // most_damping: largest damping that may be added; all zero switches the controller off.
    void configure(const DofGains &most_damping) noexcept;
    void reset() noexcept;
    // Returns the wrench to render in place of `asked`.
    Wrench correct(const Wrench &asked, const Displacement &moved, const Twist &velocity,
                   double dt_s) noexcept;
    // True if correct() would return a request of zero unchanged, however the grip moves.
    [[nodiscard]] bool at_rest() const noexcept { return at_rest_; }
    // Checks restored memory: see core/base/sound_state.h.
    [[nodiscard]] bool is_sound() const noexcept { return are_flags(at_rest_); }

private:
    DofGains most_{};
    DofLanes slow_{};
    DofLanes changing_{}; // force of the last cycle minus slow_
    DofLanes store_j_{};
    bool at_rest_ = true;
};

} // namespace spidar
