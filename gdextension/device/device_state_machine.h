// CLOSED -> CONNECTED -> ARMING -> ACTIVE -> FADING -> CONNECTED, and the latched FAULT; with the ramp that scales
// every tension.
#pragma once

#include "device/servo_snapshot.h"

namespace spidar {

class DeviceStateMachine {
public:
    struct Inputs {
        bool forces_enabled = false;
        bool arm = false; // edges
        bool disarm = false;
        bool tracking = false;       // the newest sample gave a pose
        bool may_arm_itself = false; // simulated device
    };

    // Closed, no fault, no edge pending.
    void configure(double arming_time_s) noexcept;

    // The device answers: closed -> connected, unless it was lost.
    void open() noexcept;
    // The device is gone: closed, until clear() while it answers again.
    void lose(Status why) noexcept;
    // Motors off, latched. The first fault stands. string: 0-7 or -1.
    void raise(Status why, int string) noexcept;
    // Leaves fault, or closed after lose(). `answers`: the device was read in this cycle.
    void clear(bool answers) noexcept;

    // One tick of edges and of the ramp.
    void advance(const Inputs &inputs, double dt_s) noexcept;

    [[nodiscard]] DeviceState state() const noexcept { return state_; }
    [[nodiscard]] Status fault() const noexcept { return fault_; }
    [[nodiscard]] int fault_string() const noexcept { return fault_string_; }
    [[nodiscard]] double scale() const noexcept { return scale_; }
    [[nodiscard]] bool motors_on() const noexcept;

private:
    void disarm() noexcept;

    DeviceState state_ = DeviceState::closed;
    Status fault_ = Status::ok;
    int fault_string_ = -1;
    double scale_ = 0.0;
    double arming_time_s_ = 1.0;
    bool lost_ = false;
    bool forces_were_enabled_ = false;
    // After disarm() or a fault even a simulated device waits for arm() or for forces_enabled to be toggled.
    bool stay_disarmed_ = false;
    // An arm() that could not act at once (fading, no pose yet) stands for this long.
    double arm_pending_s_ = 0.0;
};

} // namespace spidar
