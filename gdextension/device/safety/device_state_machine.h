// CLOSED -> CONNECTED -> ARMING -> ACTIVE -> FADING -> CONNECTED and the latched FAULT; with the ramps that scale
// tensions and wrench. A device without a zero goes CONNECTED -> TAUT -> CALIBRATED first: the strings are drawn
// taut, the zero is taken and checked, and they are held taut until arm(). What ends a state that pulls is decided in
// motor_rule.h alone.
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
        bool arm = false; // edges
        bool disarm = false;
        bool zero = false;
        bool tracking = false;       // the newest sample gave a pose
        bool may_arm_itself = false; // simulated device
        bool game_alive = true;
        bool hand_present = true;
        bool device_ready = true; // it has power and no fault of its own
        bool too_warm = false;    // a motor's thermal budget is spent
        // Nothing stands that would end a state which pulls.
        [[nodiscard]] bool may_pull() const noexcept {
            return forces_enabled && game_alive && !too_warm;
        }
    };
    // What a cycle asks of its caller, and what there is to tell.
    struct Outcome {
        bool take_zero =
            false; // the strings are taut: the counts of now are those of the home pose
        bool zero_needed = false; // arm() or forces without a zero
        bool no_hand = false;     // arm() without a hand
        bool too_warm = false;    // arm() or a zero while a motor is too warm
        bool game_stalled = false;
    };

    // Closed, no fault, no edge pending.
    void configure(double arming_time_s) noexcept;

    // The device answers: closed -> connected, unless it was lost. True: it was stopped while closed, and opens in FAULT.
    bool open(bool zero_known) noexcept;
    // Does what motor_rule.h says. `why` and string (0-7 or -1) are those of a fault, of which the first one stands.
    // True: the state changed. After device_lost the state is closed until clear() while the device answers again.
    bool stop(StopReason reason, Status why = Status::ok, int string = -1) noexcept;
    // There is a fault to clear, or a panic stop of a closed device.
    [[nodiscard]] bool needs_clearing() const noexcept {
        return fault_ != Status::ok || opens_stopped_;
    }
    // Leaves fault, or closed after device_lost. `answers`: the device was read in this cycle.
    void clear(bool answers) noexcept;
    // What the device says of its counts: they have a zero, or they began anew.
    void set_zero_known(bool known) noexcept { zero_known_ = known; }
    // The verdict of the check in TAUT.
    void confirm_zero() noexcept;
    void refuse_zero() noexcept;

    // One tick of edges and of the ramps.
    Outcome advance(const Inputs &inputs, double dt_s) noexcept;

    [[nodiscard]] DeviceState state() const noexcept { return state_; }
    [[nodiscard]] Status fault() const noexcept { return fault_; }
    [[nodiscard]] int fault_string() const noexcept { return fault_string_; }
    // Of the tensions and of the wrench, 0..1 each.
    [[nodiscard]] double tension_scale() const noexcept { return tension_scale_; }
    [[nodiscard]] double wrench_scale() const noexcept { return wrench_scale_; }
    [[nodiscard]] double scale() const noexcept { return tension_scale_ * wrench_scale_; }
    [[nodiscard]] bool motors_on() const noexcept;
    [[nodiscard]] bool zero_known() const noexcept { return zero_known_; }
    // The next advance() without an edge, and with forces enabled or not as now, changes nothing.
    [[nodiscard]] bool at_rest() const noexcept;
    // TAUT, zero taken: the motion of the grip is being checked.
    [[nodiscard]] bool checking_zero() const noexcept {
        return state_ == DeviceState::taut && zero_taken_;
    }
    // core/base/sound_state.h
    [[nodiscard]] bool is_sound() const noexcept {
        return is_one_of(state_, DeviceState::calibrated) && is_one_of(rearm_, Rearm::by_arm) &&
               is_string_or_none(fault_string_) &&
               are_flags(lost_, zero_known_, zero_taken_, ramps_wrench_, forces_were_enabled_,
                         may_arm_itself_, opens_stopped_);
    }

private:
    // Into a state in which nothing pulls.
    void go_slack(DeviceState next) noexcept;
    // Arms, unless somebody or something is missing.
    void arm(const Inputs &inputs, bool ramps_wrench, Outcome &outcome) noexcept;
    void begin_taut() noexcept;
    void advance_connected(const Inputs &inputs, bool wanted, Outcome &outcome) noexcept;
    // True: the strings are taut now, and the zero is to be taken.
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
    bool ramps_wrench_ = false; // arming from CALIBRATED: the tensions are up already
    bool forces_were_enabled_ = false;
    bool may_arm_itself_ = false; // as in the last inputs
    bool opens_stopped_ = false;  // panic_stop() while closed
    // What a device that arms itself waits for.
    Rearm rearm_ = Rearm::by_itself;
    // An arm() that could not act at once (fading, no pose yet) stands for this long.
    double arm_pending_s_ = 0.0;
};

} // namespace spidar
