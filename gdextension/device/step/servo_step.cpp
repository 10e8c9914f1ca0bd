#include "device/step/servo_step.h"

#include <algorithm>

#include "device/contract/dof_lanes.h"

namespace spidar {

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
    Parts &parts = fresh.parts_;
    for (const Status status : {parts.tracker.configure(settings), parts.drive.configure(settings),
                                parts.monitor.configure(settings)}) {
        if (!usable(status)) {
            return status;
        }
    }
    const SafetySettings &safety = settings.safety;
    fresh.settings_ = settings;
    fresh.nominal_dt_s_ = 1.0 / settings.rate_hz;
    parts.link.configure(safety, fresh.nominal_dt_s_);
    parts.guard.configure(settings.strings, safety.max_count_speed_m_s, safety.max_bad_samples,
                          fresh.nominal_dt_s_);
    parts.grasp.configure(settings.grasp);
    parts.fingers.configure(settings.fingers, settings.grip.kind);
    parts.renderer.touch().use(parts_.renderer.touch().memory());
    parts.renderer.configure(settings);
    parts.machine.configure(safety.arming_time_s);
    fresh.game_.configure(safety.game_timeout_s);
    fresh.snapshot_.grip = parts.tracker.grip();
    *this = fresh;
    return Status::ok;
}

void ServoStep::acknowledge(const HapticCommand &command) noexcept {
    game_.acknowledge(command);
    parts_.renderer.acknowledge(command);
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
    parts_.renderer.retune(settings_);
}

void ServoStep::solve_pose(const CountArray &counts, bool unchanged, double dt_s) noexcept {
    if (!parts_.machine.zero_known() && !parts_.machine.checking_zero()) {
        tracking_ = false; // lengths without a zero have no meaning
        hold_pose(Status::zero_needed, dt_s, true);
        return;
    }
    const ReportClock &clock = parts_.link.clock();
    const GripTracker::Update update = parts_.tracker.update(
        counts, unchanged, snapshot_.tensions_n, {clock.since_used_s(), clock.age_s()});
    ServoCounters &counters = snapshot_.counters;
    counters.kinematics_skipped += update.skipped ? 1U : 0U;
    counters.cold_starts += update.cold_start ? 1U : 0U;
    if (update.moved) {
        parts_.drive.forget_pose();
    }
    if (usable(update.status)) {
        parts_.link.used();
        fresh_ = true;
        moved_ = update.moved;
        tracking_ = true;
        unsolved_in_row_ = 0;
        snapshot_.counts = counts;
        snapshot_.lengths_m = parts_.tracker.lengths_m();
        return;
    }
    tracking_ = false;
    ++counters.bad_samples;
    ++unsolved_in_row_;
    hold_pose(update.status, dt_s, unsolved_in_row_ >= settings_.safety.max_bad_samples);
    // Without forces a grip that cannot be located harms nobody: it is reported, and arming waits
    // for it.
    if (unsolved_in_row_ >= settings_.safety.max_bad_samples && parts_.machine.motors_on()) {
        raise(update.status, -1);
    }
}

void ServoStep::hold_pose(Status why, double dt_s, bool stale) noexcept {
    if (parts_.tracker.hold(why, dt_s, stale)) {
        parts_.drive.forget_pose();
    }
}

void ServoStep::observe(Status read_status, const DeviceReading &reading, double dt_s) noexcept {
    ServoCounters &counters = snapshot_.counters;
    parts_.link.advance(dt_s);
    if (!usable(read_status) && read_status != Status::read_timeout) {
        tracking_ = false;
        lose(read_status);
        hold_pose(read_status, dt_s, true);
        parts_.guard.advance_without_reading(dt_s);
        return;
    }
    if (parts_.machine.open(reading.zeroed)) {
        parts_.events.tell(DeviceEventKind::panic_stopped);
    }
    if (read_status == Status::read_timeout || !accept_report(reading)) {
        counters.read_timeouts += read_status == Status::read_timeout ? 1U : 0U;
        parts_.guard.advance_without_reading(dt_s);
        parts_.link.absent(dt_s);
        const bool stale = parts_.link.stale();
        tracking_ = tracking_ && !stale;
        hold_pose(stale ? Status::read_timeout : Status::held_last_pose, dt_s, stale);
        if (stale && parts_.machine.motors_on()) {
            parts_.events.tell(DeviceEventKind::reports_late, -1, parts_.link.since_report_s());
        }
        if (parts_.link.lost()) {
            raise(Status::read_timeout, -1);
        }
        return;
    }
    parts_.link.arrived(dt_s);
    snapshot_.buttons = reading.buttons;
    parts_.fingers.take(reading);
    switch (parts_.guard.check(reading.counts, std::max(dt_s, parts_.link.clock().apart_s()))) {
    case SampleGuard::Verdict::good:
        solve_pose(reading.counts, false, dt_s);
        break;
    case SampleGuard::Verdict::unchanged:
        solve_pose(reading.counts, true, dt_s);
        break;
    case SampleGuard::Verdict::bad:
        ++counters.bad_samples;
        parts_.events.tell(DeviceEventKind::sample_refused, parts_.guard.bad_string());
        hold_pose(Status::held_last_pose, dt_s, false);
        break;
    case SampleGuard::Verdict::jumped:
        ++counters.bad_samples;
        tracking_ = false;
        hold_pose(Status::count_jump, dt_s, true);
        raise(Status::count_jump, parts_.guard.bad_string());
        break;
    }
}

DriveCommand ServoStep::drive(double dt_s) noexcept {
    const bool trusted = tracking_ && parts_.monitor.velocity_trusted();
    const Wrench rendered = parts_.renderer.render(parts_.tracker.grip(), parts_.tracker.moved(),
                                                   parts_.fingers.motion(), trusted, dt_s);
    Wrench asked = rendered + parts_.monitor.wall(parts_.tracker.grip());
    // A rigid grip has no hinge: its grasp torque is removed from the request and reported.
    const bool no_grasp = settings_.grip.kind == GripKind::rigid && asked.grasp_torque_nm != 0.0;
    if (no_grasp) {
        asked.grasp_torque_nm = 0.0;
    }
    const double factor = limit_factor(asked, settings_.safety);
    if (factor < 1.0 && !limiting_) {
        ++snapshot_.counters.clamped_requests;
        parts_.events.tell(DeviceEventKind::request_limited);
    }
    limiting_ = factor < 1.0;
    rendering_ = to_paper(asked) != PaperWrench{};
    const double ramp = parts_.machine.tension_scale();
    const double left = parts_.monitor.wrench_scale();
    snapshot_.counters.faded_ticks += left < 1.0 && parts_.machine.motors_on() ? 1U : 0U;
    const double request_scale =
        factor * parts_.link.scale() * left * parts_.machine.wrench_scale();
    // A factor of 0 stands for a sum that is not finite, since 0 times it would be NaN.
    const Wrench full = request_scale > 0.0 ? request_scale * asked : Wrench();

    const bool taut = parts_.machine.state() == DeviceState::taut;
    const bool on = parts_.machine.motors_on() && parts_.tracker.has_pose();
    parts_.renderer.given(on && !taut ? request_scale * ramp : 0.0, dt_s);
    if (!taut && !on) {
        return let_go();
    }
    DriveCommand command;
    if (taut) {
        command = parts_.drive.hold_pretension(ramp, dt_s, snapshot_);
    } else {
        command =
            parts_.drive.pull(parts_.tracker.grip(), full, ramp, dt_s, snapshot_, parts_.events);
        parts_.renderer.achieved(snapshot_.achieved);
        if (no_grasp && usable(snapshot_.tension_status)) {
            snapshot_.tension_status = Status::grasp_unavailable;
        }
    }
    parts_.monitor.spend(snapshot_.tensions_n, dt_s);
    return command;
}

DriveCommand ServoStep::let_go() noexcept {
    parts_.monitor.spend({}, nominal_dt_s_); // motors cool
    return parts_.drive.let_go(snapshot_);
}

GripState ServoStep::grip_with_fingers() const noexcept {
    GripState grip = parts_.tracker.grip();
    const FingerMotion &fingers = parts_.fingers.motion();
    if (fingers.given) {
        grip.frame.grasp_angle_rad = fingers.angle_rad;
        grip.twist.grasp_rate_rad_s = fingers.rate_rad_s;
    }
    return grip;
}

void ServoStep::publish_state() noexcept {
    snapshot_.state = parts_.machine.state();
    snapshot_.fault = parts_.machine.fault();
    snapshot_.fault_string = static_cast<std::int8_t>(parts_.machine.fault_string());
    snapshot_.force_scale = parts_.machine.scale();
    snapshot_.tension_scale = parts_.machine.tension_scale();
    snapshot_.zero_known = parts_.machine.zero_known();
    snapshot_.safety_scale = parts_.monitor.wrench_scale();
    snapshot_.thermal_share = parts_.monitor.heat().spent();
    snapshot_.parity_error_m = parts_.monitor.strings().parity_m();
    snapshot_.grip = grip_with_fingers();
    snapshot_.grasp = parts_.grasp.phase();
    parts_.renderer.report(snapshot_);
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
    parts_.events.begin_cycle(snapshot_.time_s);

    const Edges edges = game_.take_edges(command);
    if (edges.clear_fault && parts_.machine.needs_clearing()) {
        clear_fault(usable(read_status));
    }
    if (edges.stop) {
        // A stop without a reason is a panic: FAULT always needs a reason, or nobody could clear
        // it.
        raise(usable(command.stop_reason) ? Status::panic_stopped : command.stop_reason, -1);
    }
    if (jumped) {
        jump_clock(asked_dt_s);
    }
    const std::uint64_t refused = snapshot_.counters.rejected_requests;
    take_limits(command);
    parts_.renderer.take(command, snapshot_.time_s, dt_s, snapshot_.counters);
    if (snapshot_.counters.rejected_requests != refused) {
        parts_.events.tell(DeviceEventKind::request_refused);
    }
    parts_.fingers.take(command);
    observe(read_status, reading, dt_s);
    parts_.fingers.advance(dt_s);
    watch(dt_s);
    check_zero(dt_s);
    if (tracking_) {
        parts_.grasp.update(grip_with_fingers().frame.grasp_angle_rad, dt_s);
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
    let_go();
    publish_state();
}

} // namespace spidar
