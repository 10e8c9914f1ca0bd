#include "device/step/tension_drive.h"

#include <algorithm>

#include "device/contract/dof_lanes.h"
#include "device/rendering/rotor_compensation.h"
#include "device/step/tension_diagnosis.h"

namespace spidar {

namespace {

void clear_reports(ServoSnapshot &snapshot) noexcept {
    snapshot.tensions_n = {};
    snapshot.requested = Wrench();
    snapshot.achieved = Wrench();
    snapshot.at_min_mask = 0;
    snapshot.at_max_mask = 0;
    snapshot.tension_status = Status::ok;
}

} // namespace

Status TensionDrive::configure(const ServoSettings &settings) noexcept {
    *this = TensionDrive();
    frame_ = settings.frame;
    grip_ = settings.grip;
    render_ = settings.render;
    motors_ = motor_scale(settings.motors);
    tension_gain_ = settings.motors.tension_gain;
    pretension_n_ = settings.tension.reference_tension_n;
    broken_mask_ = settings.tension.broken_mask;
    const TensionSettings tension = solver_settings(settings);
    max_tension_n_ = tension.max_tension_n;
    StringArray limits_n{};
    limits_n.fill(max_tension_n_);
    gate_.configure(limits_n, settings.safety.tension_slew_n_per_ms);
    return solver_.configure(tension);
}

void TensionDrive::add_rotor_compensation(const Twist &twist, double ramp,
                                          StringArray &tensions_n) const noexcept {
    if (render_.compensated_friction_n == 0.0 && render_.compensated_viscous_n_s_m == 0.0) {
        return;
    }
    const StringArray extra_n = rotor_compensation(render_, matrix_, twist);
    for (std::size_t i = 0; i < tensions_n.size(); ++i) {
        if (!is_broken(i)) {
            tensions_n[i] = std::clamp(tensions_n[i] + ramp * extra_n[i], 0.0, max_tension_n_);
        }
    }
}

DriveCommand TensionDrive::pull(const GripState &grip, const Wrench &wrench, double ramp,
                                double dt_s, ServoSnapshot &snapshot, EventLog &events) noexcept {
    if (!solver_warm_) {
        solver_.reset();
        solver_warm_ = true;
    }
    if (!matrix_valid_) {
        set_wrench_matrix(matrix_, frame_, grip_, grip.pose);
        matrix_valid_ = true;
    }
    const TensionResult result = solver_.update(matrix_, to_paper(wrench));
    StringArray wanted_n{};
    for (std::size_t i = 0; i < wanted_n.size(); ++i) {
        wanted_n[i] = ramp * result.tensions_n[i];
    }
    add_rotor_compensation(grip.twist, ramp, wanted_n);
    const SafetyGate::Output gate = gate_.pass(wanted_n, dt_s);
    if (gate.slewed && ramp >= 1.0) {
        solver_.set_last_tensions(gate.tensions_n);
    }
    // Stretch follows the last tensions: they must be equal bit for bit, or the next lengths
    // differ.
    at_rest_ =
        result.skipped && !gate.slewed && !gate.clamped && gate.tensions_n == snapshot.tensions_n;
    saturated_ = result.status == Status::wrench_limited;
    ServoCounters &counters = snapshot.counters;
    counters.tension_skipped += result.skipped ? 1U : 0U;
    counters.slewed_ticks += gate.slewed ? 1U : 0U;
    counters.saturated_ticks += saturated_ ? 1U : 0U;
    if (gate.clamped) {
        ++counters.gate_clamps;
        events.tell(DeviceEventKind::impossible_tension);
    }
    snapshot.tensions_n = gate.tensions_n;
    snapshot.requested = ramp * wrench;
    snapshot.achieved = from_paper(spidar::apply(matrix_, gate.tensions_n));
    snapshot.at_min_mask = result.at_min_mask;
    snapshot.at_max_mask = result.at_max_mask;
    snapshot.tension_status = result.status;
    return command_for(gate.tensions_n);
}

DriveCommand TensionDrive::hold_pretension(double part, double dt_s,
                                           ServoSnapshot &snapshot) noexcept {
    clear_reports(snapshot);
    solver_warm_ = false;
    at_rest_ = false;
    StringArray wanted_n{};
    for (std::size_t i = 0; i < wanted_n.size(); ++i) {
        wanted_n[i] = is_broken(i) ? 0.0 : part * pretension_n_;
    }
    snapshot.tensions_n = gate_.pass(wanted_n, dt_s).tensions_n;
    return command_for(snapshot.tensions_n);
}

DriveCommand TensionDrive::let_go(ServoSnapshot &snapshot) noexcept {
    gate_.shut();
    solver_warm_ = false;
    at_rest_ = snapshot.tensions_n == StringArray{}; // equal to the last cycle's
    clear_reports(snapshot);
    return {};
}

DriveCommand TensionDrive::command_for(const StringArray &tensions_n) const noexcept {
    DriveCommand command;
    command.motors_on = true;
    command.currents_a = currents_from_tensions(motors_, tensions_n);
    for (std::size_t i = 0; i < tensions_n.size(); ++i) {
        command.tensions_n[i] = tensions_n[i] / tension_gain_[i];
    }
    return command;
}

} // namespace spidar
