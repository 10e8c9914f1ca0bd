#include "device/step/servo_step.h"

#include <algorithm>

#include "device/contract/dof_lanes.h"
#include "device/rendering/rotor_compensation.h"
#include "device/step/tension_diagnosis.h"

namespace spidar {

namespace {

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
    const Status watched = fresh.monitor_.configure(settings);
    if (!usable(watched)) {
        return watched;
    }
    const SafetySettings &safety = settings.safety;
    fresh.settings_ = settings;
    fresh.nominal_dt_s_ = 1.0 / settings.rate_hz;
    fresh.guard_.configure(settings.strings, safety.max_count_speed_m_s, safety.max_bad_samples,
                           fresh.nominal_dt_s_);
    fresh.grasp_.configure(settings.grasp);
    fresh.renderer_.configure(settings);
    fresh.motors_ = motor_scale(settings.motors);
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
    limits_sequence_ = command.limits_sequence;
    resting_ = false;
}

void ServoStep::take_limits(const HapticCommand &command) noexcept {
    if (command.limits_sequence == limits_sequence_) {
        return;
    }
    limits_sequence_ = command.limits_sequence;
    if (!usable(validate_limits(command.limits))) {
        ++snapshot_.counters.rejected_requests;
        return;
    }
    const LiveLimits &limits = command.limits;
    settings_.safety.max_force_n = limits.max_force_n;
    settings_.safety.max_moment_nm = limits.max_moment_nm;
    settings_.safety.max_grasp_torque_nm = limits.max_grasp_torque_nm;
    settings_.render.max_stiffness_n_m = limits.max_stiffness_n_m;
    settings_.render.max_turn_stiffness_nm_rad = limits.max_turn_stiffness_nm_rad;
    settings_.render.max_grasp_stiffness_nm_rad = limits.max_grasp_stiffness_nm_rad;
    renderer_.retune(settings_);
}

ServoStep::Edges ServoStep::take_edges(const HapticCommand &command) noexcept {
    Edges edges;
    edges.arm = command.arm_count != arm_count_;
    edges.disarm = command.disarm_count != disarm_count_;
    edges.clear_fault = command.clear_fault_count != clear_fault_count_;
    edges.zero = command.zero_count != zero_count_;
    edges.heartbeat = command.heartbeat != heartbeat_ || command.heartbeat == 0;
    edges.stop = command.stop_count != stop_count_;
    stop_count_ = command.stop_count;
    zero_count_ = command.zero_count;
    heartbeat_ = command.heartbeat;
    arm_count_ = command.arm_count;
    disarm_count_ = command.disarm_count;
    clear_fault_count_ = command.clear_fault_count;
    return edges;
}

void ServoStep::solve_pose(const CountArray &counts, bool unchanged, double dt_s) noexcept {
    if (!machine_.zero_known() && !machine_.checking_zero()) {
        tracking_ = false; // lengths without a zero mean nothing
        tracker_.hold(Status::zero_needed, dt_s, true);
        return;
    }
    const GripTracker::Update update =
        tracker_.update(counts, unchanged, snapshot_.tensions_n, dt_s);
    ServoCounters &counters = snapshot_.counters;
    counters.kinematics_skipped += update.skipped ? 1U : 0U;
    counters.cold_starts += update.cold_start ? 1U : 0U;
    if (update.moved) {
        matrix_valid_ = false;
    }
    if (usable(update.status)) {
        fresh_ = true;
        moved_ = update.moved;
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
        raise(update.status, -1);
    }
}

void ServoStep::observe(Status read_status, const DeviceReading &reading, double dt_s) noexcept {
    const SafetySettings &safety = settings_.safety;
    ServoCounters &counters = snapshot_.counters;
    if (!usable(read_status) && read_status != Status::read_timeout) {
        tracking_ = false;
        lose(read_status);
        tracker_.hold(read_status, dt_s, true);
        guard_.wait(dt_s);
        return;
    }
    machine_.open(reading.zeroed);
    if (read_status == Status::read_timeout || !accept_report(reading)) {
        counters.read_timeouts += read_status == Status::read_timeout ? 1U : 0U;
        guard_.wait(dt_s);
        since_report_s_ += dt_s;
        // Half a step of slack: sums of time steps carry rounding.
        const double slack_s = 0.5 * nominal_dt_s_;
        const bool stale = since_report_s_ + slack_s >= safety.read_timeout_fade_s;
        tracking_ = tracking_ && !stale;
        tracker_.hold(stale ? Status::read_timeout : Status::held_last_pose, dt_s, stale);
        link_scale_ = stale ? std::max(0.0, link_scale_ - dt_s / kLinkFade_s) : link_scale_;
        if (stale && machine_.motors_on()) {
            events_.tell(DeviceEventKind::reports_late, -1, since_report_s_);
        }
        if (answered_ && since_report_s_ + slack_s >= safety.read_timeout_fault_s) {
            raise(Status::read_timeout, -1);
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
        events_.tell(DeviceEventKind::sample_refused, guard_.bad_string());
        tracker_.hold(Status::held_last_pose, dt_s, false);
        break;
    case SampleGuard::Verdict::jumped:
        ++counters.bad_samples;
        tracking_ = false;
        tracker_.hold(Status::count_jump, dt_s, true);
        raise(Status::count_jump, guard_.bad_string());
        break;
    }
}

void ServoStep::add_rotor_compensation(StringArray &tensions_n) const noexcept {
    const RenderSettings &render = settings_.render;
    if (render.compensated_friction_n == 0.0 && render.compensated_viscous_n_s_m == 0.0) {
        return;
    }
    const double ramp = machine_.tension_scale();
    const StringArray extra_n = rotor_compensation(render, matrix_, tracker_.grip().twist);
    for (std::size_t i = 0; i < tensions_n.size(); ++i) {
        tensions_n[i] = std::clamp(tensions_n[i] + ramp * extra_n[i], 0.0, max_tension_n_);
    }
}

DriveCommand ServoStep::drive(double dt_s) noexcept {
    const bool trusted = tracking_ && monitor_.velocity_trusted();
    const Wrench rendered = renderer_.render(tracker_.grip(), tracker_.moved(), trusted, dt_s);
    Wrench asked = rendered + monitor_.wall(tracker_.grip());
    // A rigid grip has no hinge to turn: what was asked of it is left out, and said.
    const bool no_grasp = settings_.grip.kind == GripKind::rigid && asked.grasp_torque_nm != 0.0;
    if (no_grasp) {
        asked.grasp_torque_nm = 0.0;
    }
    const double factor = limit_factor(asked, settings_.safety);
    if (factor < 1.0 && !limiting_) {
        ++snapshot_.counters.clamped_requests;
        events_.tell(DeviceEventKind::request_limited);
    }
    limiting_ = factor < 1.0;
    rendering_ = to_paper(asked) != PaperWrench{};
    const double ramp = machine_.tension_scale();
    const double left = monitor_.wrench_scale();
    snapshot_.counters.faded_ticks += left < 1.0 && machine_.motors_on() ? 1U : 0U;
    const double request_scale = factor * link_scale_ * left * machine_.wrench_scale();
    // A factor of 0 means a sum that is not finite: 0 times it would still be NaN.
    const Wrench full = request_scale > 0.0 ? request_scale * asked : Wrench();

    const bool taut = machine_.state() == DeviceState::taut;
    const bool on = machine_.motors_on() && tracker_.has_pose();
    const bool gives = on && !taut;
    renderer_.given(gives ? request_scale * ramp : 0.0, dt_s);
    if (taut) {
        return hold_pretension(dt_s);
    }
    if (!on) {
        settled_ = snapshot_.tensions_n == StringArray{}; // as in the cycle before
        clear_outputs();
        return {};
    }
    if (!motors_were_on_) {
        solver_.reset();
        motors_were_on_ = true;
    }
    if (!matrix_valid_) {
        set_wrench_matrix(matrix_, settings_.frame, settings_.grip, tracker_.grip().pose);
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
    // Stretch follows the tensions of the cycle before: they must be the same to the bit, or the next lengths are not.
    settled_ =
        result.skipped && !gate.slewed && !gate.clamped && gate.tensions_n == snapshot_.tensions_n;
    snapshot_.counters.slewed_ticks += gate.slewed ? 1U : 0U;
    if (gate.clamped) {
        ++snapshot_.counters.gate_clamps;
        events_.tell(DeviceEventKind::impossible_tension);
    }
    monitor_.spend(gate.tensions_n, dt_s);
    snapshot_.counters.tension_skipped += result.skipped ? 1U : 0U;
    saturated_ = result.status == Status::wrench_limited;
    snapshot_.counters.saturated_ticks += saturated_ ? 1U : 0U;
    snapshot_.tensions_n = gate.tensions_n;
    snapshot_.requested = ramp * full;
    snapshot_.achieved = from_paper(spidar::apply(matrix_, gate.tensions_n));
    renderer_.achieved(snapshot_.achieved);
    snapshot_.at_min_mask = result.at_min_mask;
    snapshot_.at_max_mask = result.at_max_mask;
    snapshot_.tension_status =
        no_grasp && usable(result.status) ? Status::grasp_unavailable : result.status;

    return command_for(gate.tensions_n);
}

void ServoStep::publish_state() noexcept {
    snapshot_.state = machine_.state();
    snapshot_.fault = machine_.fault();
    snapshot_.fault_string = static_cast<std::int8_t>(machine_.fault_string());
    snapshot_.force_scale = machine_.scale();
    snapshot_.tension_scale = machine_.tension_scale();
    snapshot_.zero_known = machine_.zero_known();
    snapshot_.safety_scale = monitor_.wrench_scale();
    snapshot_.thermal_share = monitor_.heat().spent();
    snapshot_.parity_error_m = monitor_.strings().parity_m();
    snapshot_.grip = tracker_.grip();
    snapshot_.grasp = grasp_.phase();
    renderer_.report(snapshot_);
}

DriveCommand ServoStep::step(Status read_status, const DeviceReading &reading,
                             const HapticCommand &command, double dt_s,
                             bool may_arm_itself) noexcept {
    if (resting_ && may_rest(read_status, reading, command, dt_s, may_arm_itself)) {
        rest(reading, command, dt_s);
        return last_drive_;
    }
    resting_ = false;
    simulated_ = may_arm_itself;
    fresh_ = false;
    moved_ = false;
    const bool jumped = !(dt_s >= 0.0 && dt_s <= kLongestStep_s);
    const double asked_dt_s = dt_s;
    if (jumped || !(dt_s >= kShortestStep_s)) {
        dt_s = nominal_dt_s_;
        ++snapshot_.counters.bad_time_steps;
    }
    ++snapshot_.counters.ticks;
    snapshot_.time_s += dt_s;
    events_.begin_cycle(snapshot_.time_s);

    const Edges edges = take_edges(command);
    if (edges.clear_fault && machine_.fault() != Status::ok) {
        clear_fault(usable(read_status));
    }
    if (edges.stop) {
        raise(command.stop_reason, -1);
    }
    if (jumped) {
        jump_clock(asked_dt_s);
    }
    const std::uint64_t refused = snapshot_.counters.rejected_requests;
    take_limits(command);
    renderer_.take(command, snapshot_.time_s, dt_s, snapshot_.counters);
    if (snapshot_.counters.rejected_requests != refused) {
        events_.tell(DeviceEventKind::request_refused);
    }
    observe(read_status, reading, dt_s);
    watch(dt_s);
    check_zero(dt_s);
    if (tracking_) {
        grasp_.update(tracker_.grip().frame.grasp_angle_rad, dt_s);
    }
    advance_state(command, edges, reading, dt_s);
    DriveCommand output = drive(dt_s);
    output.clear_faults = edges.clear_fault && !output.motors_on;
    publish_state();
    if (fresh_ && !moved_ && comes_to_rest(edges)) {
        resting_ = true;
        last_drive_ = output;
    }
    return output;
}

void ServoStep::report_write(Status write_status) noexcept {
    if (usable(write_status)) {
        return;
    }
    ++snapshot_.counters.write_failures;
    resting_ = false;
    lose(write_status);
    tracking_ = false;
    clear_outputs();
    publish_state();
}

} // namespace spidar
