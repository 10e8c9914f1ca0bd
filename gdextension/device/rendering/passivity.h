// Energy at the grip per DOF. An observer measures the work of all requests on the hand. A
// controller takes back energy that a wrench or coupling, held between two game frames, gives in
// excess (Hannaford and Ryu 2002).
#pragma once

#include "core/base/sound_state.h"
#include "device/contract/dof_lanes.h"
#include "device/contract/haptic_command.h"

namespace spidar {

// Observes the work of the requests. The work is exact for a wrench held over each cycle: force of
// the last cycle times the displacement since.
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

// Damps a DOF while the changing part of its force has given the hand more energy than it took. A
// slow force, such as a weight, is intended by the game and left alone: only changes within kSlow_s
// are watched.
class PassivityController {
public:
    // Time constant that separates slow forces from changing ones.
    static constexpr double kSlow_s = 0.2;
    // Largest energy kept from the hand: a long hold must not pay for a later jolt.
    static constexpr double kStore_j = 0.005;
    // Time over which energies are forgotten, so that each tap is judged by itself.
    static constexpr double kMemory_s = 0.2;

    // most_damping: largest damping that may be added; all zero switches the controller off.
    void configure(const DofGains &most_damping) noexcept;
    void reset() noexcept;
    // Returns the wrench to render in place of `asked`.
    Wrench correct(const Wrench &asked, const Displacement &moved, const Twist &velocity,
                   double dt_s) noexcept;
    // True when nothing changes while nothing is requested, wherever the grip moves.
    [[nodiscard]] bool at_rest() const noexcept { return at_rest_; }
    // Checks restored memory: see core/base/sound_state.h.
    [[nodiscard]] bool is_sound() const noexcept { return are_flags(at_rest_); }

private:
    DofGains most_{};
    DofLanes slow_{};
    DofLanes changing_{}; // held since the last cycle
    DofLanes store_j_{};
    bool at_rest_ = true;
};

} // namespace spidar
