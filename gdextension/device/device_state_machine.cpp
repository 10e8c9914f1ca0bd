#include "device/device_state_machine.h"

#include <algorithm>

namespace spidar {

namespace {

// Forces fall to zero in this time on disarm: fast, but no blow to the hand.
constexpr double kFadeTime_s = 0.020;
// Longer than a fade and than the first report of a device takes; short enough never to surprise.
constexpr double kArmPatience_s = 0.100;

} // namespace

void DeviceStateMachine::configure(double arming_time_s) noexcept {
    *this = DeviceStateMachine();
    arming_time_s_ = arming_time_s;
}

void DeviceStateMachine::open() noexcept {
    if (state_ == DeviceState::closed && !lost_) {
        state_ = DeviceState::connected;
    }
}

void DeviceStateMachine::disarm() noexcept {
    scale_ = 0.0;
    arm_pending_s_ = 0.0;
    stay_disarmed_ = true;
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

void DeviceStateMachine::clear(bool answers) noexcept {
    if (state_ == DeviceState::fault || (lost_ && answers)) {
        state_ = DeviceState::connected;
        fault_ = Status::ok;
        fault_string_ = -1;
        lost_ = false;
    }
}

void DeviceStateMachine::advance(const Inputs &inputs, double dt_s) noexcept {
    if (inputs.forces_enabled && !forces_were_enabled_) {
        stay_disarmed_ = false;
    }
    forces_were_enabled_ = inputs.forces_enabled;
    arm_pending_s_ = std::max(0.0, arm_pending_s_ - dt_s);
    const bool may_wait = state_ == DeviceState::connected || state_ == DeviceState::fading;
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
        scale_ = 0.0;
        return;
    case DeviceState::connected:
        scale_ = 0.0;
        if (!(wanted && inputs.tracking && (inputs.may_arm_itself || arm_pending_s_ > 0.0))) {
            return;
        }
        state_ = DeviceState::arming;
        arm_pending_s_ = 0.0;
        break;
    case DeviceState::arming:
    case DeviceState::active:
        if (!wanted) {
            state_ = DeviceState::fading;
        }
        break;
    case DeviceState::fading:
        break;
    }

    if (state_ == DeviceState::arming) {
        scale_ = std::min(1.0, scale_ + dt_s / arming_time_s_);
        if (scale_ >= 1.0) {
            state_ = DeviceState::active;
        }
    } else if (state_ == DeviceState::fading) {
        scale_ = std::max(0.0, scale_ - dt_s / kFadeTime_s);
        if (!(scale_ > 0.0)) {
            state_ = DeviceState::connected;
        }
    }
}

bool DeviceStateMachine::motors_on() const noexcept {
    return state_ == DeviceState::arming || state_ == DeviceState::active ||
           state_ == DeviceState::fading;
}

} // namespace spidar
