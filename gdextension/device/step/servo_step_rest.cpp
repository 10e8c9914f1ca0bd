// Skipping of a whole step: while all parts are at rest (contract/rest.h) and nothing new arrives,
// the last answer holds bit for bit. Ages and the motors' heat still advance.
#include "device/step/servo_step.h"

namespace spidar {

// Requires a whole step with the same counts before.
bool ServoStep::comes_to_rest(const Edges &edges) const noexcept {
    return edges == Edges() && tracking_ && all_at_rest(parts_);
}

bool ServoStep::may_rest(Status read_status, const DeviceReading &reading,
                         const HapticCommand &command, double dt_s,
                         bool may_arm_itself) const noexcept {
    const bool same_reading = read_status == Status::ok && reading.counts == snapshot_.counts &&
                              reading.zeroed == device_zeroed_ &&
                              reading.device_status == Status::ok && parts_.link.follows(reading);
    const bool same_command =
        command.forces_enabled == forces_enabled_ && command.limits_sequence == limits_sequence_ &&
        game_.edges_of(command) == Edges() && parts_.renderer.has_seen(command) &&
        parts_.fingers.has_seen(reading, command);
    const bool alive = !last_drive_.motors_on || game_.lives_through(command, dt_s);
    return same_reading && same_command && alive && may_arm_itself == simulated_ &&
           dt_s >= kShortestStep_s && dt_s <= kLongestStep_s &&
           parts_.renderer.rests_through(dt_s) && parts_.monitor.rests_through(dt_s);
}

void ServoStep::rest(const DeviceReading &reading, const HapticCommand &command,
                     double dt_s) noexcept {
    ServoCounters &counters = snapshot_.counters;
    const bool on = last_drive_.motors_on;
    ++counters.ticks;
    ++counters.steps_skipped;
    ++counters.kinematics_skipped;
    counters.tension_skipped += on ? 1U : 0U;
    counters.saturated_ticks += on && parts_.drive.saturated() ? 1U : 0U;
    snapshot_.time_s += dt_s;
    parts_.events.begin_cycle(snapshot_.time_s);
    // Inputs that may change at rest.
    game_.listen(command, dt_s);
    parts_.link.advance(dt_s);
    (void)parts_.link.accept(reading);
    parts_.link.used();
    snapshot_.buttons = reading.buttons;
    // Values that age at rest.
    parts_.renderer.advance_at_rest(dt_s);
    parts_.monitor.advance_at_rest(dt_s);
    parts_.monitor.spend(snapshot_.tensions_n, on ? dt_s : nominal_dt_s_);
    snapshot_.thermal_share = parts_.monitor.heat().spent();
}

} // namespace spidar
