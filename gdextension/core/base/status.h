// One status type for the core and the device. Values >= 0: the result is usable.
#pragma once

#include <cstdint>

namespace spidar {

enum class Status : std::int32_t {
    ok = 0,
    // Usable, with a remark.
    ambiguous_pose = 1,  // another pose fits the lengths as well; memory or the upright prior chose
    near_singular = 2,   // usable, but the lengths barely determine one direction
    held_last_pose = 3,  // this sample was refused; the last good pose stands
    wrench_limited = 4,  // strings at a bound: the wrench given differs from the one asked for
    weakly_observed = 7, // calibration: the motion leaves some combination of values open
    grasp_unavailable = 8, // a grasp torque was asked of a rigid grip, which cannot give one
    // Bad input: nothing moved, state unchanged.
    not_finite = -1,          // NaN or infinity in an input
    invalid_geometry = -2,    // frame or grip impossible (zero, negative, not finite)
    invalid_calibration = -3, // string or motor calibration out of range
    invalid_settings = -4,    // solver or loop settings out of range
    impossible_lengths = -5,  // no pose has these string lengths
    outside_frame = -6,       // the pose would lie at or beyond the z faces of the frame
    rank_deficient = -7,      // lengths do not determine the pose (Rz +-90 deg at psi 90 deg)
    not_converged = -8,       // iteration bound reached; the last good value stands
    count_jump = -9,          // an encoder moved faster than a string can
    invalid_request = -10,    // wrench or contact data malformed
    too_few_samples = -11,    // calibration: not enough usable measurements
    invalid_shape = -12,      // a shape of the scene or the tool is empty or impossible
    // Device.
    not_open = -20,
    open_failed = -21,
    device_in_use = -22, // another node of this process owns the device
    read_timeout = -23,
    read_failed = -24,
    write_failed = -25,
    over_speed = -26,
    string_fault = -29, // the eight lengths contradict each other: slack, slipped, stuck, broken
    overheated = -30,   // a motor's thermal budget is spent
    unstable = -31,     // the rendered forces shake the grip
    device_restarted = -32, // the device's clock or counts began anew: the zero is lost
    zero_needed = -33,      // zero_at_home() is needed before forces
    panic_stopped = -34,
    loop_stalled = -35, // the servo thread stands still
    // What a real device says of itself, or what keeps one from being opened.
    device_not_zeroed = -40, // its counts have no reference: zero it at the home pose
    device_emergency_stop = -41,
    device_watchdog = -42, // it missed the host's commands and switched its motors off
    device_no_power = -43, // the motors' supply is absent
    device_encoder_fault = -44,
    device_over_temperature = -45,
    no_device = -46,         // nothing matches vendor, product, serial and name
    no_permission = -47,     // found, but this user may not open it: the udev rule is missing
    protocol_mismatch = -48, // it speaks another version, or is no SPIDAR-G
    hid_unavailable = -49,   // the system's HID library did not start
};

[[nodiscard]] constexpr bool usable(Status status) noexcept {
    return static_cast<std::int32_t>(status) >= 0;
}

// One plain English sentence; never null.
[[nodiscard]] const char *describe(Status status) noexcept;

} // namespace spidar
