#include "device/safety/device_state_machine.h"

#include <algorithm>

namespace spidar {

namespace {

// Forces fall to zero in this time on disarm: fast, but no blow to the hand.
constexpr double kFadeTime_s = 0.020;
// Longer than a fade and than the first report of a device takes; short enough never to surprise.
constexpr double kArmPatience_s = 0.100;
// Slack strings are drawn in within this, at pretension.
constexpr double kTautTime_s = 0.5;

} // namespace

void DeviceStateMachine::configure(double arming_time_s) noexcept {
    *this = DeviceStateMachine();
    arming_time_s_ = arming_time_s;
}

void DeviceStateMachine::open(bool zero_known) noexcept {
    if (state_ == DeviceState::closed && !lost_) {
        state_ = DeviceState::connected;
        zero_known_ = zero_known;
    }
}

void DeviceStateMachine::disarm() noexcept {
    tension_scale_ = 0.0;
    wrench_scale_ = 0.0;
    arm_pending_s_ = 0.0;
    stay_disarmed_ = true;
    zero_taken_ = false;
}

void DeviceStateMachine::lose(Status why) noexcept {
    if (!lost_) {
        fault_ = why;
        fault_string_ = -1;
    }
    lost_ = true;
    state_ = DeviceState::closed;
    disarm();
}

void DeviceStateMachine::raise(Status why, int string) noexcept {
    if (state_ == DeviceState::fault || state_ == DeviceState::closed) {
        return;
    }
    state_ = DeviceState::fault;
    fault_ = why;
    fault_string_ = string;
    disarm();
}

void DeviceStateMachine::stand_down() noexcept {
    stay_disarmed_ = true;
    arm_pending_s_ = 0.0;
    if (state_ == DeviceState::arming || state_ == DeviceState::active) {
        state_ = DeviceState::fading;
    }
}

void DeviceStateMachine::clear(bool answers) noexcept {
    if (state_ == DeviceState::fault || (lost_ && answers)) {
        state_ = DeviceState::connected;
        fault_ = Status::ok;
        fault_string_ = -1;
        lost_ = false;
    }
}

// Where a device waits for arm().
void DeviceStateMachine::rest() noexcept {
    state_ = DeviceState::connected;
    tension_scale_ = 0.0;
    wrench_scale_ = 0.0;
}

void DeviceStateMachine::confirm_zero() noexcept {
    if (checking_zero()) {
        zero_known_ = true;
        zero_taken_ = false;
        state_ = DeviceState::calibrated;
    }
}

void DeviceStateMachine::refuse_zero() noexcept {
    if (state_ == DeviceState::taut) {
        zero_known_ = false;
        zero_taken_ = false;
        rest();
    }
}

void DeviceStateMachine::arm(const Inputs &inputs, bool ramps_wrench, Outcome &outcome) noexcept {
    outcome.no_hand = !inputs.hand_present;
    if (inputs.hand_present && inputs.tracking && inputs.game_alive && inputs.device_ready) {
        state_ = DeviceState::arming;
        wrench_scale_ = ramps_wrench ? 0.0 : 1.0;
        ramps_wrench_ = ramps_wrench;
        arm_pending_s_ = 0.0;
    }
}

DeviceStateMachine::Outcome DeviceStateMachine::advance_connected(const Inputs &inputs,
                                                                  bool wanted) noexcept {
    Outcome outcome;
    tension_scale_ = 0.0;
    wrench_scale_ = 0.0;
    if (inputs.zero && inputs.forces_enabled && !inputs.disarm) {
        state_ = DeviceState::taut;
        zero_taken_ = false;
        zero_known_ = false;
        arm_pending_s_ = 0.0;
        return outcome;
    }
    const bool asked = inputs.may_arm_itself || arm_pending_s_ > 0.0;
    if (!wanted || !asked) {
        return outcome;
    }
    if (!zero_known_) {
        outcome.zero_needed = true;
        return outcome;
    }
    arm(inputs, false, outcome); // pretension and wrench rise together
    return outcome;
}

DeviceStateMachine::Outcome DeviceStateMachine::advance_taut(const Inputs &inputs,
                                                             double dt_s) noexcept {
    Outcome outcome;
    wrench_scale_ = 0.0;
    if (!inputs.forces_enabled || inputs.disarm) {
        refuse_zero();
        return outcome;
    }
    if (!zero_taken_) {
        tension_scale_ = std::min(1.0, tension_scale_ + dt_s / kTautTime_s);
        if (tension_scale_ >= 1.0) {
            zero_taken_ = true;
            outcome.take_zero = true;
        }
    }
    return outcome;
}

DeviceStateMachine::Outcome DeviceStateMachine::advance_calibrated(const Inputs &inputs,
                                                                   bool wanted) noexcept {
    Outcome outcome;
    wrench_scale_ = 0.0;
    if (!inputs.forces_enabled || inputs.disarm) {
        rest();
        return outcome;
    }
    if (inputs.zero) {
        state_ = DeviceState::taut;
        tension_scale_ = 0.0;
        zero_taken_ = false;
        zero_known_ = false;
        return outcome;
    }
    if (!wanted || !(arm_pending_s_ > 0.0)) {
        return outcome;
    }
    arm(inputs, true, outcome); // from pretension: only the wrench rises
    return outcome;
}

DeviceStateMachine::Outcome DeviceStateMachine::advance(const Inputs &inputs,
                                                        double dt_s) noexcept {
    Outcome outcome;
    if (inputs.forces_enabled && !forces_were_enabled_) {
        stay_disarmed_ = false;
    }
    forces_were_enabled_ = inputs.forces_enabled;
    arm_pending_s_ = std::max(0.0, arm_pending_s_ - dt_s);
    const bool may_wait = state_ == DeviceState::connected || state_ == DeviceState::calibrated ||
                          state_ == DeviceState::fading;
    if (inputs.arm && inputs.forces_enabled && may_wait) {
        stay_disarmed_ = false;
        arm_pending_s_ = kArmPatience_s;
    }
    if (inputs.disarm) { // wins over an arm() of the same cycle
        stay_disarmed_ = true;
        arm_pending_s_ = 0.0;
    }
    const bool wanted = inputs.forces_enabled && !stay_disarmed_;

    switch (state_) {
    case DeviceState::closed:
    case DeviceState::fault:
        tension_scale_ = 0.0;
        wrench_scale_ = 0.0;
        return outcome;
    case DeviceState::taut:
        return advance_taut(inputs, dt_s);
    case DeviceState::connected:
        outcome = advance_connected(inputs, wanted);
        break;
    case DeviceState::calibrated:
        outcome = advance_calibrated(inputs, wanted);
        break;
    case DeviceState::arming:
    case DeviceState::active:
        if (!wanted) {
            state_ = DeviceState::fading;
        } else if (!inputs.game_alive) {
            // A simulated device arms itself again; a real one waits for arm().
            stay_disarmed_ = !inputs.may_arm_itself;
            state_ = DeviceState::fading;
            outcome.game_stalled = true;
        }
        break;
    case DeviceState::fading:
        break;
    }

    if (state_ == DeviceState::arming) {
        double &ramp = ramps_wrench_ ? wrench_scale_ : tension_scale_;
        ramp = std::min(1.0, ramp + dt_s / arming_time_s_);
        if (ramp >= 1.0) {
            state_ = DeviceState::active;
        }
    } else if (state_ == DeviceState::fading) {
        tension_scale_ = std::max(0.0, tension_scale_ - dt_s / kFadeTime_s);
        if (!(tension_scale_ > 0.0)) {
            rest();
        }
    }
    return outcome;
}

bool DeviceStateMachine::at_rest() const noexcept {
    const bool wanted = forces_were_enabled_ && !stay_disarmed_;
    const bool full = tension_scale_ >= 1.0 && wrench_scale_ >= 1.0;
    return !(arm_pending_s_ > 0.0) && ((state_ == DeviceState::active && wanted && full) ||
                                       (state_ == DeviceState::connected && !wanted));
}

bool DeviceStateMachine::motors_on() const noexcept {
    switch (state_) {
    case DeviceState::arming:
    case DeviceState::active:
    case DeviceState::fading:
    case DeviceState::taut:
    case DeviceState::calibrated:
        return true;
    case DeviceState::closed:
    case DeviceState::connected:
    case DeviceState::fault:
        break;
    }
    return false;
}

} // namespace spidar
