// Turns the requested wrench into tensions and currents: solver, ramp, compensation, safety gate.
#pragma once

#include "core/base/sound_state.h"
#include "core/calibration/motor_calibration.h"
#include "core/geometry/frame_geometry.h"
#include "core/tension/tension_solver.h"
#include "device/contract/device_event.h"
#include "device/contract/servo_snapshot.h"
#include "device/contract/transport.h"
#include "device/safety/safety_gate.h"
#include "device/settings/servo_settings.h"

namespace spidar {

class TensionDrive {
public:
    // Requires settings that validate() accepts.
    Status configure(const ServoSettings &settings) noexcept;
    // The pose has changed: the wrench matrix is computed again.
    void forget_pose() noexcept { matrix_valid_ = false; }
    // Makes the next pull() solve even when nothing has changed. The result is the same.
    void forget_settled() noexcept { solver_.forget_settled(); }

    // Renders a wrench. The ramp (0..1) scales the tensions, so that pretension and wrench rise
    // together: A (ramp tau) = ramp A tau. Call one of pull(), hold_pretension() and let_go() per
    // cycle. Each sets the fields of `snapshot` on tensions, requested and achieved wrench.
    DriveCommand pull(const GripState &grip, const Wrench &wrench, double ramp, double dt_s,
                      ServoSnapshot &snapshot, EventLog &events) noexcept;
    // Sets every string that is not broken to this part (0..1) of the pretension. Needs no pose.
    DriveCommand hold_pretension(double part, double dt_s, ServoSnapshot &snapshot) noexcept;
    // Switches the motors off in this cycle, without a ramp.
    DriveCommand let_go(ServoSnapshot &snapshot) noexcept;

    // True when the tensions equal those of the last cycle bit for bit and the gate changed none.
    [[nodiscard]] bool at_rest() const noexcept { return at_rest_; }
    // True when strings at a bound changed the wrench of the last pull().
    [[nodiscard]] bool saturated() const noexcept { return saturated_; }
    // Checks restored memory: see core/base/sound_state.h.
    [[nodiscard]] bool is_sound() const noexcept {
        return are_flags(render_.caps_from_latency, matrix_valid_, solver_warm_, at_rest_,
                         saturated_) &&
               spidar::is_sound(grip_) && solver_.is_sound();
    }

private:
    [[nodiscard]] bool is_broken(std::size_t string) const noexcept {
        return ((broken_mask_ >> string) & 1U) != 0;
    }
    void add_rotor_compensation(const Twist &twist, double ramp,
                                StringArray &tensions_n) const noexcept;
    [[nodiscard]] DriveCommand command_for(const StringArray &tensions_n) const noexcept;

    FrameGeometry frame_;
    GripGeometry grip_;
    RenderSettings render_;
    MotorScale motors_;
    StringArray tension_gain_{};
    double pretension_n_ = 0.0;
    std::uint8_t broken_mask_ = 0;
    double max_tension_n_ = 0.0;
    TensionSolver solver_;
    SafetyGate gate_;
    WrenchMatrix matrix_{};
    bool matrix_valid_ = false; // matrix_ belongs to the present pose
    bool solver_warm_ = false;  // pull() was called in the last cycle
    bool at_rest_ = false;
    bool saturated_ = false;
};

} // namespace spidar
