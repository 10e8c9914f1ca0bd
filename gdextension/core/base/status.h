// The status type of core and device. Values >= 0 mean that the result is usable.
#pragma once

#include <cstdint>

namespace spidar {

enum class Status : std::int32_t {
    ok = 0,
    // 1 to 8: the result is usable; the code names a weakness.
    ambiguous_pose = 1,    // another pose fits as well; the last or the upright pose was taken
    near_singular = 2,     // the lengths barely determine one direction
    held_last_pose = 3,    // the sample was refused; the last good pose is used
    wrench_limited = 4,    // strings at a bound: the achieved wrench differs from the request
    weakly_observed = 7,   // calibration: some combination of unknowns is hardly determined
    grasp_unavailable = 8, // a grasp torque was requested of a rigid grip
    // -1 to -12: the input gives no result. The function that returns the code says what it does
    // instead.
    not_finite = -1,          // NaN or infinity in an input
    invalid_geometry = -2,    // frame or grip impossible (zero, negative, not finite)
    invalid_calibration = -3, // string or motor calibration out of range
    invalid_settings = -4,    // solver or loop settings out of range
    impossible_lengths = -5,  // no pose has these string lengths
    outside_frame = -6,       // the pose would lie at or beyond a z face of the frame
    rank_deficient = -7,   // the lengths do not determine the pose (e.g. Rz +-90 deg at psi 90 deg)
    not_converged = -8,    // iteration bound reached; the last good value is kept
    count_jump = -9,       // an encoder moved faster than a string can
    invalid_request = -10, // wrench or contact data is malformed
    too_few_samples = -11, // calibration: not enough usable measurements
    invalid_shape = -12,   // a shape of the scene or the tool is empty or impossible
    // -20 to -35: errors of the device or of the servo loop.
    not_open = -20,
    open_failed = -21,
    device_in_use = -22, // another node or another program has the device
    read_timeout = -23,
    read_failed = -24,
    write_failed = -25,
    over_speed = -26,
    string_fault = -29, // the eight lengths contradict each other: slack, slipped, stuck, broken
    overheated = -30,   // a motor's thermal budget is spent
    unstable = -31,     // the rendered forces shake the grip
    device_restarted = -32, // the device's clock or counts restarted: the zero is lost
    zero_needed = -33,      // zero_at_home() is needed before forces
    panic_stopped = -34,
    loop_stalled = -35, // the servo thread does not run
    // -40 to -49: faults that a real device reports, and reasons why none can be opened.
    device_not_zeroed = -40, // the counts have no reference: zero the device at the home pose
    device_emergency_stop = -41,
    device_watchdog = -42, // the device missed commands and switched its motors off
    device_no_power = -43, // the motors have no supply
    device_encoder_fault = -44,
    device_over_temperature = -45,
    no_device = -46,         // no device matches vendor, product, serial and name
    no_permission = -47,     // found, but this user may not open it (udev rule missing)
    protocol_mismatch = -48, // the device uses another protocol version, or is no SPIDAR-G
    hid_unavailable = -49,   // the system's HID library did not start
};

[[nodiscard]] constexpr bool usable(Status status) noexcept {
    return static_cast<std::int32_t>(status) >= 0;
}

// Returns one plain English sentence; never null.
[[nodiscard]] const char *describe(Status status) noexcept;

} // namespace spidar
