// The part of a servo step that watches and decides: states, zero, faults and their events.
#include "device/step/servo_step.h"

#include <algorithm>

namespace spidar {

namespace {

DeviceEventKind kind_of(Status fault) noexcept {
    switch (fault) {
    case Status::read_timeout:
        return DeviceEventKind::reports_stopped;
    case Status::count_jump:
        return DeviceEventKind::count_jump;
    case Status::over_speed:
        return DeviceEventKind::over_speed;
    case Status::string_fault:
        return DeviceEventKind::string_fault;
    case Status::overheated:
        return DeviceEventKind::overheated;
    case Status::unstable:
        return DeviceEventKind::unstable;
    case Status::device_restarted:
    case Status::device_not_zeroed:
        return DeviceEventKind::device_restarted;
    case Status::panic_stopped:
        return DeviceEventKind::panic_stopped;
    case Status::loop_stalled:
        return DeviceEventKind::loop_stalled;
    case Status::open_failed:
    case Status::not_open:
        return DeviceEventKind::open_failed;
    case Status::read_failed:
    case Status::write_failed:
        return DeviceEventKind::device_lost;
    case Status::device_emergency_stop:
    case Status::device_watchdog:
    case Status::device_no_power:
    case Status::device_encoder_fault:
    case Status::device_over_temperature:
        return DeviceEventKind::device_stopped;
    default:
        return DeviceEventKind::pose_lost; // what the kinematics may say
    }
}

} // namespace

void ServoStep::raise(Status why, int string) noexcept {
    if (machine_.state() != DeviceState::fault && machine_.state() != DeviceState::closed) {
        events_.tell(kind_of(why), string);
    }
    machine_.raise(why, string);
}

void ServoStep::lose(Status why) noexcept {
    if (told_state_ != DeviceState::closed) {
        events_.tell(kind_of(why));
    }
    machine_.lose(why);
    order_.reset();
    // Counts may begin anew where they like. A device that kept its zero says so in its next reading.
    device_zeroed_ = false;
    machine_.set_zero_known(false);
}

void ServoStep::clear_fault(bool answers) noexcept {
    machine_.clear(answers);
    guard_.reset();
    tracker_.restart();
    monitor_.restart();
    order_.reset();
    since_report_s_ = 0.0;
    unsolved_in_row_ = 0;
}

// The computer slept, or its clock is wrong: nothing that evolves in time is worth keeping.
void ServoStep::jump_clock(double asked_dt_s) noexcept {
    events_.tell(DeviceEventKind::clock_jumped, -1, asked_dt_s);
    guard_.reset();
    tracker_.restart();
    machine_.stand_down();
}

bool ServoStep::accept_report(const DeviceReading &reading) noexcept {
    const std::uint64_t now_us = reading.device_time_us;
    if (now_us + kClockBack_us < device_time_us_) {
        device_time_us_ = now_us;
        order_.reset();
        guard_.reset();
        raise(Status::device_restarted, -1);
        machine_.set_zero_known(false);
    }
    if (!order_.accept(reading.sequence)) {
        ++snapshot_.counters.old_reports;
        events_.tell(DeviceEventKind::report_out_of_order);
        return false;
    }
    device_time_us_ = std::max(device_time_us_, now_us);
    if (reading.zeroed != device_zeroed_) {
        device_zeroed_ = reading.zeroed;
        machine_.set_zero_known(reading.zeroed);
        tracker_.set_zero(settings_.strings.zero_count);
        guard_.reset();
        if (!reading.zeroed && machine_.motors_on()) {
            raise(Status::device_not_zeroed, -1);
        }
    }
    if (reading.device_status != Status::ok && machine_.motors_on()) {
        raise(reading.device_status, -1);
    }
    if (order_.missed() > 0) {
        snapshot_.counters.reports_missed += static_cast<std::uint64_t>(order_.missed());
        events_.tell(DeviceEventKind::reports_missed, -1, order_.missed());
    }
    return true;
}

void ServoStep::watch(double dt_s) noexcept {
    const double strongest_n =
        *std::max_element(snapshot_.tensions_n.begin(), snapshot_.tensions_n.end());
    const SafetyMonitor::Sample sample{tracker_.grip(),
                                       snapshot_.counts,
                                       snapshot_.lengths_m,
                                       tracker_.fastest_point_m_s(),
                                       strongest_n,
                                       fresh_,
                                       moved_,
                                       machine_.motors_on(),
                                       rendering_,
                                       renderer_.contact_push()};
    const SafetyMonitor::Verdict verdict = monitor_.watch(sample, events_, dt_s);
    switch (verdict.action) {
    case SafetyMonitor::Action::none:
        break;
    case SafetyMonitor::Action::stand_down:
        if (machine_.state() == DeviceState::active || machine_.state() == DeviceState::arming) {
            events_.tell(kind_of(verdict.status), verdict.string);
        }
        machine_.stand_down();
        break;
    case SafetyMonitor::Action::motors_off:
        raise(verdict.status, verdict.string);
        break;
    }
}

void ServoStep::check_zero(double dt_s) noexcept {
    if (!machine_.checking_zero() || !fresh_) {
        return;
    }
    const double parity_m = monitor_.strings().parity_m();
    switch (zero_check_.update(tracker_.grip().pose, parity_m, dt_s)) {
    case ZeroCheck::Verdict::pending:
        break;
    case ZeroCheck::Verdict::confirmed:
        events_.tell(DeviceEventKind::zero_confirmed, -1, zero_check_.worst_m());
        machine_.confirm_zero();
        break;
    case ZeroCheck::Verdict::refused:
        events_.tell(DeviceEventKind::zero_refused, monitor_.strings().string(),
                     zero_check_.worst_m());
        machine_.refuse_zero();
        break;
    }
}

void ServoStep::take_zero(const CountArray &counts) noexcept {
    tracker_.set_zero(counts);
    monitor_.restart();
    guard_.reset();
    zero_check_.begin();
    unsolved_in_row_ = 0;
    events_.tell(DeviceEventKind::zero_taken);
}

void ServoStep::advance_state(const HapticCommand &command, const Edges &edges,
                              const DeviceReading &reading, double dt_s) noexcept {
    since_beat_s_ = edges.heartbeat ? 0.0 : std::min(1e6, since_beat_s_ + dt_s);
    forces_enabled_ = command.forces_enabled;
    DeviceStateMachine::Inputs inputs;
    inputs.forces_enabled = command.forces_enabled;
    inputs.arm = edges.arm;
    inputs.disarm = edges.disarm;
    inputs.zero = edges.zero;
    inputs.tracking = tracking_;
    inputs.may_arm_itself = simulated_;
    inputs.game_alive = since_beat_s_ < settings_.safety.game_timeout_s;
    inputs.hand_present = simulated_ || monitor_.hand_present();
    inputs.device_ready = reading.device_status == Status::ok;
    const DeviceStateMachine::Outcome outcome = machine_.advance(inputs, dt_s);
    if (outcome.take_zero) {
        take_zero(reading.counts);
    }
    if (outcome.zero_needed) {
        events_.tell(DeviceEventKind::zero_needed);
    }
    if (outcome.no_hand) {
        events_.tell(DeviceEventKind::no_hand);
    }
    if (outcome.game_stalled) {
        events_.tell(DeviceEventKind::game_stalled, -1, since_beat_s_);
    }
    tell_state();
}

void ServoStep::tell_state() noexcept {
    const DeviceState now = machine_.state();
    if (now == told_state_) {
        return;
    }
    if (told_state_ == DeviceState::closed) {
        events_.tell(DeviceEventKind::device_connected);
    }
    if (now == DeviceState::active) {
        events_.tell(DeviceEventKind::armed);
    } else if (told_state_ == DeviceState::active) {
        events_.tell(DeviceEventKind::disarmed);
    }
    told_state_ = now;
}

// No pose is needed: every string at pretension.
DriveCommand ServoStep::hold_pretension(double dt_s) noexcept {
    clear_reports();
    motors_were_on_ = false;
    StringArray wanted_n{};
    wanted_n.fill(machine_.tension_scale() * settings_.tension.reference_tension_n);
    snapshot_.tensions_n = gate_.pass(wanted_n, dt_s).tensions_n;
    monitor_.spend(snapshot_.tensions_n, dt_s);
    return command_for(snapshot_.tensions_n);
}

DriveCommand ServoStep::command_for(const StringArray &tensions_n) const noexcept {
    DriveCommand command;
    command.motors_on = true;
    command.currents_a = currents_from_tensions(motors_, tensions_n).current_a;
    for (std::size_t i = 0; i < tensions_n.size(); ++i) {
        command.tensions_n[i] = tensions_n[i] / settings_.motors.tension_gain[i];
    }
    return command;
}

void ServoStep::clear_reports() noexcept {
    snapshot_.tensions_n = {};
    snapshot_.requested = Wrench();
    snapshot_.achieved = Wrench();
    snapshot_.at_min_mask = 0;
    snapshot_.at_max_mask = 0;
    snapshot_.tension_status = Status::ok;
}

void ServoStep::clear_outputs() noexcept {
    gate_.shut();
    motors_were_on_ = false;
    clear_reports();
    monitor_.spend({}, nominal_dt_s_); // motors cool
}

} // namespace spidar
