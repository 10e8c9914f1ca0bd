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
    request_clamped = 5, // a finite request was brought down to its limit, direction kept
    request_expired = 6, // the game stopped asking; the request faded out
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
    // Device.
    not_open = -20,
    open_failed = -21,
    device_in_use = -22, // another node of this process owns the device
    read_timeout = -23,
    read_failed = -24,
    write_failed = -25,
    over_speed = -26,
    fault_latched = -27, // clear_fault() and arm() are needed
    not_armed = -28,
};

[[nodiscard]] constexpr bool usable(Status status) noexcept {
    return static_cast<std::int32_t>(status) >= 0;
}

// One plain English sentence; never null.
[[nodiscard]] const char *describe(Status status) noexcept;

} // namespace spidar
