// The whole step skipped: while nothing moves, nothing new is asked and all that evolves in time has come to its end, the
// last answer is the answer, to the bit. What has an age grows older all the same, and heat flows.
#include "device/step/servo_step.h"

#include <algorithm>

namespace spidar {

// After a whole step with the same counts as before.
bool ServoStep::comes_to_rest(const Edges &edges) const noexcept {
    const bool edge = edges.arm || edges.disarm || edges.clear_fault || edges.zero || edges.stop;
    return !edge && events_.silent() && tracking_ && settled_ && link_scale_ >= 1.0 &&
           machine_.at_rest() && tracker_.at_rest() && grasp_.settled() && monitor_.at_rest() &&
           renderer_.at_rest();
}

bool ServoStep::may_rest(Status read_status, const DeviceReading &reading,
                         const HapticCommand &command, double dt_s,
                         bool may_arm_itself) const noexcept {
    const bool same_reading = read_status == Status::ok && reading.counts == snapshot_.counts &&
                              reading.zeroed == device_zeroed_ &&
                              reading.device_status == Status::ok &&
                              reading.device_time_us + kClockBack_us >= device_time_us_ &&
                              order_.follows(reading.sequence);
    const bool same_command =
        command.forces_enabled == forces_enabled_ && command.arm_count == arm_count_ &&
        command.disarm_count == disarm_count_ && command.clear_fault_count == clear_fault_count_ &&
        command.zero_count == zero_count_ && command.stop_count == stop_count_ &&
        command.limits_sequence == limits_sequence_ && renderer_.has_seen(command);
    const bool beats = command.heartbeat == 0 || command.heartbeat != heartbeat_;
    const bool alive =
        beats || !last_drive_.motors_on || since_beat_s_ + dt_s < settings_.safety.game_timeout_s;
    return same_reading && same_command && alive && may_arm_itself == simulated_ &&
           dt_s >= kShortestStep_s && dt_s <= kLongestStep_s && renderer_.steady(dt_s) &&
           monitor_.heat().spent() < ThermalBudget::kDerateFrom;
}

void ServoStep::rest(const DeviceReading &reading, const HapticCommand &command,
                     double dt_s) noexcept {
    ServoCounters &counters = snapshot_.counters;
    const bool on = last_drive_.motors_on;
    ++counters.ticks;
    ++counters.steps_skipped;
    ++counters.kinematics_skipped;
    counters.tension_skipped += on ? 1U : 0U;
    counters.saturated_ticks += on && saturated_ ? 1U : 0U;
    snapshot_.time_s += dt_s;
    events_.begin_cycle(snapshot_.time_s);
    const bool beats = command.heartbeat == 0 || command.heartbeat != heartbeat_;
    heartbeat_ = command.heartbeat;
    since_beat_s_ = beats ? 0.0 : std::min(1e6, since_beat_s_ + dt_s);
    order_.accept(reading.sequence);
    device_time_us_ = std::max(device_time_us_, reading.device_time_us);
    snapshot_.buttons = reading.buttons;
    renderer_.wait(dt_s);
    monitor_.wait(dt_s);
    monitor_.spend(snapshot_.tensions_n, on ? dt_s : nominal_dt_s_);
    snapshot_.thermal_share = monitor_.heat().spent();
}

} // namespace spidar
