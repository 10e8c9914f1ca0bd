// Safety part of a servo step: device states, zero, faults and their events.
#include "device/step/servo_step.h"

#include <algorithm>
#include <bit>

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
        return DeviceEventKind::pose_lost; // the other results of the kinematics
    }
}

// Returns the first string (0-7) of a mask, or -1 when it is empty.
int first_string(std::uint8_t mask) noexcept {
    return mask != 0 ? std::countr_zero(mask) : -1;
}

} // namespace

void ServoStep::stop(StopReason reason, Status why, int string) noexcept {
    if (parts_.machine.stop(reason, why, string)) {
        parts_.events.tell(kind_of(why), string);
    }
}

void ServoStep::raise(Status why, int string) noexcept {
    stop(why == Status::panic_stopped ? StopReason::panic : StopReason::fault, why, string);
}

void ServoStep::lose(Status why) noexcept {
    if (told_state_ != DeviceState::closed) {
        parts_.events.tell(kind_of(why));
    }
    parts_.machine.stop(StopReason::device_lost, why);
    parts_.link.expect_anew();
    // Counts may have a new origin. A device that kept its zero reports so in its next reading.
    device_zeroed_ = false;
    parts_.machine.set_zero_known(false);
}

void ServoStep::clear_fault(bool answers) noexcept {
    parts_.machine.clear(answers);
    parts_.guard.reset();
    parts_.tracker.restart();
    parts_.monitor.restart();
    parts_.link.forgive();
    unsolved_in_row_ = 0;
}

// The computer slept, or its clock is wrong: all state that evolves in time is discarded.
void ServoStep::jump_clock(double asked_dt_s) noexcept {
    parts_.events.tell(DeviceEventKind::clock_jumped, -1, asked_dt_s);
    parts_.guard.reset();
    parts_.tracker.restart();
    parts_.machine.stop(StopReason::clock_jumped);
}

bool ServoStep::accept_report(const DeviceReading &reading) noexcept {
    if (parts_.link.restarted(reading)) {
        parts_.guard.reset();
        raise(Status::device_restarted, -1);
        parts_.machine.set_zero_known(false);
    }
    if (!parts_.link.accept(reading)) {
        ++snapshot_.counters.old_reports;
        parts_.events.tell(DeviceEventKind::report_out_of_order);
        return false;
    }
    if (reading.zeroed != device_zeroed_) {
        device_zeroed_ = reading.zeroed;
        parts_.machine.set_zero_known(reading.zeroed);
        parts_.tracker.set_zero(settings_.strings.zero_count);
        parts_.guard.reset();
        if (!reading.zeroed && parts_.machine.motors_on()) {
            raise(Status::device_not_zeroed, -1);
        }
    }
    if (reading.device_status != Status::ok && parts_.machine.motors_on()) {
        raise(reading.device_status, first_string(reading.fault_strings));
    }
    if (parts_.link.missed() > 0) {
        snapshot_.counters.reports_missed += static_cast<std::uint64_t>(parts_.link.missed());
        parts_.events.tell(DeviceEventKind::reports_missed, -1, parts_.link.missed());
    }
    return true;
}

void ServoStep::watch(double dt_s) noexcept {
    const double strongest_n =
        *std::max_element(snapshot_.tensions_n.begin(), snapshot_.tensions_n.end());
    const SafetyMonitor::Sample sample{parts_.tracker.grip(),
                                       snapshot_.counts,
                                       snapshot_.lengths_m,
                                       parts_.tracker.fastest_point_m_s(),
                                       strongest_n,
                                       fresh_,
                                       moved_,
                                       parts_.machine.motors_on(),
                                       rendering_,
                                       parts_.renderer.contact_push()};
    const SafetyMonitor::Verdict verdict = parts_.monitor.watch(sample, parts_.events, dt_s);
    if (verdict.status != Status::ok) {
        stop(verdict.reason, verdict.status, verdict.string);
    }
}

void ServoStep::check_zero(double dt_s) noexcept {
    if (!parts_.machine.checking_zero()) {
        parts_.zero_check.end();
    }
    if (!parts_.machine.checking_zero() || !fresh_) {
        return;
    }
    const double parity_m = parts_.monitor.strings().parity_m();
    switch (parts_.zero_check.update(parts_.tracker.grip().pose, parity_m, dt_s)) {
    case ZeroCheck::Verdict::pending:
        break;
    case ZeroCheck::Verdict::confirmed:
        parts_.events.tell(DeviceEventKind::zero_confirmed, -1, parts_.zero_check.worst_m());
        parts_.machine.confirm_zero();
        break;
    case ZeroCheck::Verdict::refused:
        parts_.events.tell(DeviceEventKind::zero_refused, parts_.monitor.strings().string(),
                           parts_.zero_check.worst_m());
        parts_.machine.refuse_zero();
        break;
    }
}

void ServoStep::take_zero(const CountArray &counts) noexcept {
    parts_.tracker.set_zero(counts);
    parts_.monitor.restart();
    parts_.guard.reset();
    parts_.zero_check.begin();
    unsolved_in_row_ = 0;
    parts_.events.tell(DeviceEventKind::zero_taken);
}

void ServoStep::advance_state(const HapticCommand &command, const Edges &edges,
                              const DeviceReading &reading, double dt_s) noexcept {
    game_.listen(command, dt_s);
    forces_enabled_ = command.forces_enabled;
    DeviceStateMachine::Inputs inputs;
    inputs.forces_enabled = command.forces_enabled;
    inputs.arm = edges.arm;
    inputs.disarm = edges.disarm;
    inputs.zero = edges.zero;
    inputs.tracking = tracking_;
    inputs.may_arm_itself = simulated_;
    inputs.game_alive = game_.alive();
    inputs.hand_present = simulated_ || parts_.monitor.hand_present();
    inputs.device_ready = reading.device_status == Status::ok;
    inputs.too_warm = parts_.monitor.heat().is_spent();
    const DeviceStateMachine::Outcome outcome = parts_.machine.advance(inputs, dt_s);
    if (outcome.take_zero) {
        take_zero(reading.counts);
    }
    if (outcome.zero_needed) {
        parts_.events.tell(DeviceEventKind::zero_needed);
    }
    if (outcome.no_hand) {
        parts_.events.tell(DeviceEventKind::no_hand);
    }
    if (outcome.too_warm) {
        parts_.events.tell(DeviceEventKind::overheated, parts_.monitor.heat().warmest_string());
    }
    if (outcome.game_stalled) {
        parts_.events.tell(DeviceEventKind::game_stalled, -1, game_.silent_s());
    }
    tell_state();
}

void ServoStep::tell_state() noexcept {
    const DeviceState now = parts_.machine.state();
    if (now == told_state_) {
        return;
    }
    if (told_state_ == DeviceState::closed) {
        parts_.events.tell(DeviceEventKind::device_connected);
    }
    if (now == DeviceState::active) {
        parts_.events.tell(DeviceEventKind::armed);
    } else if (told_state_ == DeviceState::active) {
        parts_.events.tell(DeviceEventKind::disarmed);
    }
    told_state_ = now;
}

} // namespace spidar
