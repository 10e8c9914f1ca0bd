#include "device/safety/device_state_machine.h"

#include <algorithm>

namespace spidar {

namespace {

// Time in which forces fall to zero on disarm: fast, but without a jolt.
constexpr double kFadeTime_s = 0.020;
// Time for which an arm() stays pending: longer than a fade and than a device's first report, short
// enough not to surprise.
constexpr double kArmPatience_s = 0.100;
// Time in which slack strings are drawn in at pretension.
constexpr double kTautTime_s = 0.5;

} // namespace

void DeviceStateMachine::configure(double arming_time_s) noexcept {
    *this = DeviceStateMachine();
    arming_time_s_ = arming_time_s;
}

bool DeviceStateMachine::open(bool zero_known) noexcept {
    if (state_ != DeviceState::closed || lost_) {
        return false;
    }
    state_ = DeviceState::connected;
    zero_known_ = zero_known;
    if (!opens_stopped_) {
        return false;
    }
    opens_stopped_ = false;
    return stop(StopReason::panic, Status::panic_stopped);
}

bool DeviceStateMachine::stop(StopReason reason, Status why, int string) noexcept {
    const StopAction action = stop_action(state_, reason);
    if (action == StopAction::nothing) {
        return false;
    }
    rearm_ = std::max(rearm_, rearm_after(reason, may_arm_itself_));
    arm_pending_s_ = 0.0;
    const DeviceState before = state_;
    switch (action) {
    case StopAction::unset:
    case StopAction::nothing:
    case StopAction::disarm:
        break;
    case StopAction::fade:
        state_ = DeviceState::fading;
        break;
    case StopAction::let_go:
        go_slack(DeviceState::connected);
        break;
    case StopAction::fault:
        fault_ = why;
        fault_string_ = string;
        go_slack(DeviceState::fault);
        break;
    case StopAction::close:
        if (!lost_) { // the first reason is kept
            fault_ = why;
            fault_string_ = -1;
        }
        lost_ = true;
        go_slack(DeviceState::closed);
        break;
    case StopAction::latch:
        opens_stopped_ = true;
        break;
    }
    return state_ != before;
}

void DeviceStateMachine::clear(bool answers) noexcept {
    opens_stopped_ = false;
    if (state_ == DeviceState::fault || (lost_ && answers)) {
        state_ = DeviceState::connected;
        fault_ = Status::ok;
        fault_string_ = -1;
        lost_ = false;
    }
}

void DeviceStateMachine::go_slack(DeviceState next) noexcept {
    state_ = next;
    tension_scale_ = 0.0;
    wrench_scale_ = 0.0;
    zero_taken_ = false;
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
        go_slack(DeviceState::connected);
    }
}

void DeviceStateMachine::arm(const Inputs &inputs, bool ramps_wrench, Outcome &outcome) noexcept {
    outcome.no_hand = !inputs.hand_present;
    if (inputs.hand_present && inputs.tracking && inputs.device_ready && inputs.may_pull()) {
        state_ = DeviceState::arming;
        wrench_scale_ = ramps_wrench ? 0.0 : 1.0;
        ramps_wrench_ = ramps_wrench;
        arm_pending_s_ = 0.0;
    }
}

void DeviceStateMachine::begin_taut() noexcept {
    state_ = DeviceState::taut;
    tension_scale_ = 0.0;
    zero_taken_ = false;
    zero_known_ = false;
    arm_pending_s_ = 0.0;
}

void DeviceStateMachine::advance_connected(const Inputs &inputs, bool wanted,
                                           Outcome &outcome) noexcept {
    tension_scale_ = 0.0;
    wrench_scale_ = 0.0;
    if (inputs.zero && inputs.may_pull() && !inputs.disarm) {
        begin_taut();
        return;
    }
    const bool asked = inputs.may_arm_itself || arm_pending_s_ > 0.0;
    if (!wanted || !asked) {
        return;
    }
    outcome.zero_needed = !zero_known_;
    if (zero_known_) {
        arm(inputs, false, outcome); // pretension and wrench rise together
    }
}

bool DeviceStateMachine::advance_taut(double dt_s) noexcept {
    wrench_scale_ = 0.0;
    if (zero_taken_) {
        return false;
    }
    tension_scale_ = std::min(1.0, tension_scale_ + dt_s / kTautTime_s);
    zero_taken_ = tension_scale_ >= 1.0;
    return zero_taken_;
}

void DeviceStateMachine::advance_calibrated(const Inputs &inputs, bool wanted,
                                            Outcome &outcome) noexcept {
    wrench_scale_ = 0.0;
    if (inputs.zero) {
        begin_taut();
    } else if (wanted && arm_pending_s_ > 0.0) {
        arm(inputs, true, outcome); // from pretension: only the wrench rises
    }
}

DeviceStateMachine::Outcome DeviceStateMachine::advance(const Inputs &inputs,
                                                        double dt_s) noexcept {
    Outcome outcome;
    may_arm_itself_ = inputs.may_arm_itself;
    if (inputs.forces_enabled && !forces_were_enabled_ && rearm_ == Rearm::by_toggle) {
        rearm_ = Rearm::by_itself;
    }
    forces_were_enabled_ = inputs.forces_enabled;
    arm_pending_s_ = std::max(0.0, arm_pending_s_ - dt_s);
    const bool may_wait = state_ == DeviceState::connected || state_ == DeviceState::calibrated ||
                          state_ == DeviceState::fading;
    if (inputs.arm && inputs.forces_enabled && may_wait) {
        rearm_ = Rearm::by_itself;
        arm_pending_s_ = kArmPatience_s;
    }
    outcome.too_warm = inputs.too_warm && may_wait && (inputs.arm || inputs.zero);
    // Requests of this cycle. disarm() overrides an arm() of the same cycle.
    if (inputs.disarm) {
        stop(StopReason::disarm_asked);
    }
    if (!inputs.forces_enabled) {
        stop(StopReason::forces_off);
    }
    if (inputs.too_warm) {
        stop(StopReason::overheated);
    }
    outcome.game_stalled = !inputs.game_alive && stop(StopReason::game_silent);
    const bool wanted = inputs.forces_enabled && rearm_ == Rearm::by_itself;

    switch (state_) {
    case DeviceState::closed:
    case DeviceState::fault:
        tension_scale_ = 0.0;
        wrench_scale_ = 0.0;
        return outcome;
    case DeviceState::taut:
        outcome.take_zero = advance_taut(dt_s);
        return outcome;
    case DeviceState::connected:
        advance_connected(inputs, wanted, outcome);
        break;
    case DeviceState::calibrated:
        advance_calibrated(inputs, wanted, outcome);
        break;
    case DeviceState::arming:
    case DeviceState::active:
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
            go_slack(DeviceState::connected);
        }
    }
    return outcome;
}

bool DeviceStateMachine::at_rest() const noexcept {
    const bool wanted = forces_were_enabled_ && rearm_ == Rearm::by_itself;
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
