#include "device/servo_step.h"

#include <algorithm>

#include "device/rotor_compensation.h"
#include "device/tension_diagnosis.h"

namespace spidar {

namespace {

// Longer steps than this are a suspended computer, not a servo cycle.
constexpr double kLongestStep_s = 0.05;
// Shorter ones than any servo has would make speeds without bound out of one encoder count.
constexpr double kShortestStep_s = 1e-6;
// The wrench falls to zero in this time when reports fail to come, and returns in that.
constexpr double kLinkFade_s = 0.020;
constexpr double kLinkRecovery_s = 0.050;

} // namespace

Status ServoStep::configure(const ServoSettings &settings) noexcept {
    if (!validate(settings.frame).empty() || !validate(settings.grip, settings.frame).empty()) {
        return Status::invalid_geometry;
    }
    if (!validate(settings.strings).empty() || !validate(settings.motors).empty()) {
        return Status::invalid_calibration;
    }
    if (!validate(settings).empty()) {
        return Status::invalid_settings;
    }
    ServoStep fresh;
    const Status tracked = fresh.tracker_.configure(settings);
    if (!usable(tracked)) {
        return tracked;
    }
    const TensionSettings tension = solver_settings(settings);
    StringArray limits_n{};
    limits_n.fill(tension.max_tension_n);
    const Status solvable = fresh.solver_.configure(tension);
    if (!usable(solvable)) {
        return solvable;
    }
    const SafetySettings &safety = settings.safety;
    fresh.settings_ = settings;
    fresh.nominal_dt_s_ = 1.0 / settings.rate_hz;
    fresh.guard_.configure(settings.strings, safety.max_count_speed_m_s, safety.max_bad_samples,
                           fresh.nominal_dt_s_);
    fresh.grasp_.configure(settings.grasp);
    fresh.renderer_.configure(settings);
    fresh.max_tension_n_ = tension.max_tension_n;
    fresh.machine_.configure(safety.arming_time_s);
    fresh.gate_.configure(limits_n, safety.tension_slew_n_per_ms);
    fresh.snapshot_.grip = fresh.tracker_.grip();
    *this = fresh;
    return Status::ok;
}

void ServoStep::acknowledge(const HapticCommand &command) noexcept {
    take_edges(command);
    renderer_.acknowledge(command);
}

ServoStep::Edges ServoStep::take_edges(const HapticCommand &command) noexcept {
    Edges edges;
    edges.arm = command.arm_count != arm_count_;
    edges.disarm = command.disarm_count != disarm_count_;
    edges.clear_fault = command.clear_fault_count != clear_fault_count_;
    arm_count_ = command.arm_count;
    disarm_count_ = command.disarm_count;
    clear_fault_count_ = command.clear_fault_count;
    return edges;
}

void ServoStep::solve_pose(const CountArray &counts, bool unchanged, double dt_s) noexcept {
    const GripTracker::Update update = tracker_.update(counts, unchanged, dt_s);
    ServoCounters &counters = snapshot_.counters;
    counters.kinematics_skipped += update.skipped ? 1U : 0U;
    counters.cold_starts += update.cold_start ? 1U : 0U;
    if (update.moved) {
        matrix_valid_ = false;
    }
    if (usable(update.status)) {
        tracking_ = true;
        unsolved_in_row_ = 0;
        snapshot_.counts = counts;
        snapshot_.lengths_m = tracker_.lengths_m();
        return;
    }
    tracking_ = false;
    ++counters.bad_samples;
    ++unsolved_in_row_;
    tracker_.hold(update.status, dt_s, unsolved_in_row_ >= settings_.safety.max_bad_samples);
    // Without forces a grip that cannot be located harms nobody: it is reported, and arming waits for it.
    if (unsolved_in_row_ >= settings_.safety.max_bad_samples && machine_.motors_on()) {
        machine_.raise(update.status, -1);
    }
}

void ServoStep::observe(Status read_status, const DeviceReading &reading, double dt_s) noexcept {
    const SafetySettings &safety = settings_.safety;
    ServoCounters &counters = snapshot_.counters;
    if (!usable(read_status) && read_status != Status::read_timeout) {
        tracking_ = false;
        machine_.lose(read_status);
        tracker_.hold(read_status, dt_s, true);
        guard_.wait(dt_s);
        return;
    }
    machine_.open();
    if (read_status == Status::read_timeout) {
        ++counters.read_timeouts;
        guard_.wait(dt_s);
        since_report_s_ += dt_s;
        // Half a step of slack: sums of time steps carry rounding.
        const double slack_s = 0.5 * nominal_dt_s_;
        const bool stale = since_report_s_ + slack_s >= safety.read_timeout_fade_s;
        tracking_ = tracking_ && !stale;
        tracker_.hold(stale ? Status::read_timeout : Status::held_last_pose, dt_s, stale);
        link_scale_ = stale ? std::max(0.0, link_scale_ - dt_s / kLinkFade_s) : link_scale_;
        if (answered_ && since_report_s_ + slack_s >= safety.read_timeout_fault_s) {
            machine_.raise(Status::read_timeout, -1);
        }
        return;
    }
    answered_ = true;
    since_report_s_ = 0.0;
    link_scale_ = std::min(1.0, link_scale_ + dt_s / kLinkRecovery_s);
    snapshot_.buttons = reading.buttons;
    switch (guard_.check(reading.counts, dt_s)) {
    case SampleGuard::Verdict::good:
        solve_pose(reading.counts, false, dt_s);
        break;
    case SampleGuard::Verdict::unchanged:
        solve_pose(reading.counts, true, dt_s);
        break;
    case SampleGuard::Verdict::bad:
        ++counters.bad_samples;
        tracker_.hold(Status::held_last_pose, dt_s, false);
        break;
    case SampleGuard::Verdict::jumped:
        ++counters.bad_samples;
        tracking_ = false;
        tracker_.hold(Status::count_jump, dt_s, true);
        machine_.raise(Status::count_jump, guard_.bad_string());
        break;
    }
    if (machine_.motors_on() && tracker_.fastest_point_m_s() > safety.max_grip_speed_m_s) {
        machine_.raise(Status::over_speed, -1);
    }
}

void ServoStep::add_rotor_compensation(StringArray &tensions_n) const noexcept {
    const RenderSettings &render = settings_.render;
    if (render.compensated_friction_n == 0.0 && render.compensated_viscous_n_s_m == 0.0) {
        return;
    }
    const double ramp = machine_.scale();
    const StringArray extra_n = rotor_compensation(render, matrix_, tracker_.grip().twist);
    for (std::size_t i = 0; i < tensions_n.size(); ++i) {
        tensions_n[i] = std::clamp(tensions_n[i] + ramp * extra_n[i], 0.0, max_tension_n_);
    }
}

DriveCommand ServoStep::drive(double dt_s) noexcept {
    const Wrench asked =
        renderer_.render(tracker_.grip(), tracker_.moved(), tracking_, dt_s);
    const double factor = limit_factor(asked, settings_.safety);
    if (factor < 1.0 && !limiting_) {
        ++snapshot_.counters.clamped_requests;
    }
    limiting_ = factor < 1.0;
    const double ramp = machine_.scale();
    const double request_scale = factor * link_scale_;
    // A factor of 0 means a sum that is not finite: 0 times it would still be NaN.
    const Wrench full = request_scale > 0.0 ? request_scale * asked : Wrench();

    const bool on = machine_.motors_on() && tracker_.has_pose();
    renderer_.given(on ? request_scale * ramp : 0.0, on ? ramp * full : Wrench(), dt_s);
    if (!on) {
        gate_.shut();
        motors_were_on_ = false;
        snapshot_.tensions_n = {};
        snapshot_.requested = Wrench();
        snapshot_.achieved = Wrench();
        snapshot_.at_min_mask = 0;
        snapshot_.at_max_mask = 0;
        snapshot_.tension_status = Status::ok;
        return {};
    }
    if (!motors_were_on_) {
        solver_.reset();
        motors_were_on_ = true;
    }
    if (!matrix_valid_) {
        matrix_ = wrench_matrix(settings_.frame, settings_.grip, tracker_.grip().pose);
        matrix_valid_ = true;
    }
    // The ramp scales the tensions, not the request: pretension and wrench rise together, and A (ramp tau) is
    // ramp times the wrench, exactly.
    const TensionResult result = solver_.update(matrix_, to_paper(full));
    StringArray wanted_n{};
    for (std::size_t i = 0; i < wanted_n.size(); ++i) {
        wanted_n[i] = ramp * result.tensions_n[i];
    }
    add_rotor_compensation(wanted_n);
    const SafetyGate::Output gate = gate_.pass(wanted_n, dt_s);
    if (gate.slewed && ramp >= 1.0) {
        solver_.set_last_tensions(gate.tensions_n);
    }
    snapshot_.counters.slewed_ticks += gate.slewed ? 1U : 0U;
    snapshot_.counters.gate_clamps += gate.clamped ? 1U : 0U;
    snapshot_.counters.tension_skipped += result.skipped ? 1U : 0U;
    snapshot_.counters.saturated_ticks += result.status == Status::wrench_limited ? 1U : 0U;
    snapshot_.tensions_n = gate.tensions_n;
    snapshot_.requested = ramp * full;
    snapshot_.achieved = from_paper(apply(matrix_, gate.tensions_n));
    snapshot_.at_min_mask = result.at_min_mask;
    snapshot_.at_max_mask = result.at_max_mask;
    snapshot_.tension_status = result.status;

    DriveCommand command;
    command.motors_on = true;
    command.currents_a = currents_from_tensions(settings_.motors, gate.tensions_n).current_a;
    for (std::size_t i = 0; i < wanted_n.size(); ++i) {
        command.tensions_n[i] = gate.tensions_n[i] / settings_.motors.tension_gain[i];
    }
    return command;
}

void ServoStep::publish_state() noexcept {
    snapshot_.state = machine_.state();
    snapshot_.fault = machine_.fault();
    snapshot_.fault_string = static_cast<std::int8_t>(machine_.fault_string());
    snapshot_.force_scale = machine_.scale();
    snapshot_.grip = tracker_.grip();
    snapshot_.grasp = grasp_.phase();
    renderer_.report(snapshot_);
}

DriveCommand ServoStep::step(Status read_status, const DeviceReading &reading,
                             const HapticCommand &command, double dt_s,
                             bool may_arm_itself) noexcept {
    if (!(dt_s >= kShortestStep_s && dt_s <= kLongestStep_s)) {
        dt_s = nominal_dt_s_;
        ++snapshot_.counters.bad_time_steps;
    }
    ++snapshot_.counters.ticks;
    snapshot_.time_s += dt_s;

    const Edges edges = take_edges(command);
    const bool answers = usable(read_status);
    if (edges.clear_fault && machine_.fault() != Status::ok) {
        machine_.clear(answers);
        guard_.reset();
        tracker_.restart();
        since_report_s_ = 0.0;
        unsolved_in_row_ = 0;
    }
    renderer_.take(command, snapshot_.time_s, dt_s, snapshot_.counters);
    observe(read_status, reading, dt_s);
    if (tracking_) {
        grasp_.update(tracker_.grip().frame.grasp_angle_rad, dt_s);
    }
    machine_.advance({command.forces_enabled, edges.arm, edges.disarm, tracking_, may_arm_itself},
                     dt_s);
    const DriveCommand output = drive(dt_s);
    publish_state();
    return output;
}

void ServoStep::report_write(Status write_status) noexcept {
    if (usable(write_status)) {
        return;
    }
    ++snapshot_.counters.write_failures;
    machine_.lose(write_status);
    gate_.shut();
    motors_were_on_ = false;
    tracking_ = false;
    snapshot_.tensions_n = {};
    snapshot_.requested = Wrench();
    snapshot_.achieved = Wrench();
    publish_state();
}

} // namespace spidar
