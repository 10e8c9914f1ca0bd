// The states CLOSED -> CONNECTED -> ARMING -> ACTIVE -> FADING -> CONNECTED and the latched FAULT,
// with the ramps that scale tensions and wrench. A device without a zero first goes CONNECTED ->
// TAUT -> CALIBRATED: the strings are drawn taut, the zero is taken and checked, and the strings
// stay taut until arm(). motor_rule.h alone decides what ends a state in which motors pull.
#pragma once

#include "core/base/sound_state.h"
#include "core/base/status.h"
#include "device/contract/device_state.h"
#include "device/safety/motor_rule.h"

namespace spidar {

class DeviceStateMachine {
public:
    struct Inputs {
        bool forces_enabled = false;
        bool arm = false; // arm, disarm and zero are edges
        bool disarm = false;
        bool zero = false;
        bool tracking = false;       // the newest sample gave a pose
        bool may_arm_itself = false; // simulated device
        bool game_alive = true;
        bool hand_present = true;
        bool device_ready = true; // the device has power and no fault of its own
        bool too_warm = false;    // a motor's thermal budget is spent
        // False if one of these three inputs would end a state in which motors pull.
        [[nodiscard]] bool may_pull() const noexcept {
            return forces_enabled && game_alive && !too_warm;
        }
    };
    // Requests to the caller and events of one cycle.
    struct Outcome {
        // The strings are taut: the present counts are those of the home pose.
        bool take_zero = false;
        bool zero_needed = false; // the device would arm, but has no zero
        bool no_hand = false;     // arm() was requested without a hand
        bool too_warm = false;    // arm() or a zero was requested while a motor is too warm
        bool game_stalled = false;
    };

    // Resets to CLOSED without fault or pending edges.
    void configure(double arming_time_s) noexcept;

    // The device answers: CLOSED becomes CONNECTED, unless the device was lost. Returns true when
    // the device was stopped while closed: it opens in FAULT.
    bool open(bool zero_known) noexcept;
    // Applies motor_rule.h. why, string (0-7 or -1): cause of a fault. A further fault in FAULT, or
    // a further loss of the device, does not change it. Returns true when the state changed. After
    // device_lost the state is CLOSED until clear() is called while the device answers.
    bool stop(StopReason reason, Status why = Status::ok, int string = -1) noexcept;
    // True when there is a fault, or a panic stop of a closed device.
    [[nodiscard]] bool needs_clearing() const noexcept {
        return fault_ != Status::ok || opens_stopped_;
    }
    // Leaves FAULT, or CLOSED after device_lost. answers: the device was read in this cycle.
    void clear(bool answers) noexcept;
    // Sets whether the zero of the counts is known.
    void set_zero_known(bool known) noexcept { zero_known_ = known; }
    // The check in TAUT found the zero correct.
    void confirm_zero() noexcept;
    // The check in TAUT found the zero wrong.
    void refuse_zero() noexcept;

    // Takes one cycle: edges and ramps.
    Outcome advance(const Inputs &inputs, double dt_s) noexcept;

    [[nodiscard]] DeviceState state() const noexcept { return state_; }
    [[nodiscard]] Status fault() const noexcept { return fault_; }
    [[nodiscard]] int fault_string() const noexcept { return fault_string_; }
    // Scale of the tensions, 0..1.
    [[nodiscard]] double tension_scale() const noexcept { return tension_scale_; }
    // Scale of the wrench, 0..1.
    [[nodiscard]] double wrench_scale() const noexcept { return wrench_scale_; }
    [[nodiscard]] double scale() const noexcept { return tension_scale_ * wrench_scale_; }
    [[nodiscard]] bool motors_on() const noexcept;
    [[nodiscard]] bool zero_known() const noexcept { return zero_known_; }
    // True only in ACTIVE and CONNECTED, and only if another advance() with the same inputs and no
    // edge would change nothing.
    [[nodiscard]] bool at_rest() const noexcept;
    // True in TAUT once the zero was taken: the grip's motion is being checked.
    [[nodiscard]] bool checking_zero() const noexcept {
        return state_ == DeviceState::taut && zero_taken_;
    }
    // Checks restored memory: see core/base/sound_state.h.
    [[nodiscard]] bool is_sound() const noexcept {
        return is_one_of(state_, DeviceState::calibrated) && is_one_of(rearm_, Rearm::by_arm) &&
               is_string_or_none(fault_string_) &&
               are_flags(lost_, zero_known_, zero_taken_, ramps_wrench_, forces_were_enabled_,
                         may_arm_itself_, opens_stopped_);
    }

private:
    // Enters `next`, in which no motor pulls.
    void go_slack(DeviceState next) noexcept;
    // Arms, unless a condition is missing.
    void arm(const Inputs &inputs, bool ramps_wrench, Outcome &outcome) noexcept;
    void begin_taut() noexcept;
    void advance_connected(const Inputs &inputs, bool wanted, Outcome &outcome) noexcept;
    // Returns true when the strings are taut and the zero must be taken.
    bool advance_taut(double dt_s) noexcept;
    void advance_calibrated(const Inputs &inputs, bool wanted, Outcome &outcome) noexcept;

    DeviceState state_ = DeviceState::closed;
    Status fault_ = Status::ok;
    int fault_string_ = -1;
    double tension_scale_ = 0.0;
    double wrench_scale_ = 0.0;
    double arming_time_s_ = 1.0;
    bool lost_ = false;
    bool zero_known_ = false;
    bool zero_taken_ = false;
    bool ramps_wrench_ = false; // arming from CALIBRATED: tensions are up already
    bool forces_were_enabled_ = false;
    bool may_arm_itself_ = false; // of the last inputs
    bool opens_stopped_ = false;  // panic_stop() while closed
    // What a device that arms itself waits for.
    Rearm rearm_ = Rearm::by_itself;
    // Remaining time for which an arm() that could not act yet (fading, no pose) stays valid.
    double arm_pending_s_ = 0.0;
};

} // namespace spidar
