#include "core/base/status.h"

namespace spidar {

const char *describe(Status status) noexcept {
    switch (status) {
    case Status::ok:
        return "All is well.";
    case Status::ambiguous_pose:
        return "Another pose also fits the string lengths; the remembered or upright pose was "
               "used.";
    case Status::near_singular:
        return "The string lengths barely determine one direction at this pose; move the grip "
               "toward the center.";
    case Status::held_last_pose:
        return "This sample was rejected; the last good pose is kept.";
    case Status::wrench_limited:
        return "Strings are at a tension bound; the achieved wrench differs from the requested "
               "wrench.";
    case Status::weakly_observed:
        return "The motion does not determine every combination of the calibration's parameters; "
               "move and turn the grip more widely.";
    case Status::grasp_unavailable:
        return "The grip is rigid and has no hinge; the requested grasp torque was ignored.";
    case Status::not_finite:
        return "An input is NaN or infinite; nothing was changed.";
    case Status::invalid_geometry:
        return "The frame or grip geometry is impossible; get_problem(), or validate() in C++, "
               "names the field and the remedy.";
    case Status::invalid_calibration:
        return "The string or motor calibration is out of range; get_problem(), or validate() in "
               "C++, names the field and the remedy.";
    case Status::invalid_settings:
        return "A setting is out of range; get_problem(), or validate() in C++, names the field "
               "and the remedy.";
    case Status::impossible_lengths:
        return "No grip pose has these string lengths; check the strings and the calibration.";
    case Status::outside_frame:
        return "The string lengths put the grip at or beyond a face of the frame that is "
               "perpendicular to z; move the grip back inside the frame.";
    case Status::rank_deficient:
        return "The string lengths do not determine the pose here; turn the grip back toward its "
               "rest orientation.";
    case Status::not_converged:
        return "The solver reached its iteration bound; the last good value is kept.";
    case Status::count_jump:
        return "An encoder count changed faster than a string can move; check the encoder's cable.";
    case Status::invalid_request:
        return "The wrench or contact data is malformed; the request was ignored.";
    case Status::too_few_samples:
        return "There are not enough usable measurements to calibrate from; record more.";
    case Status::invalid_shape:
        return "The shape is empty or impossible; the accompanying message names the field.";
    case Status::not_open:
        return "The device is not open; open it first.";
    case Status::open_failed:
        return "The device could not be opened; check the cable and the access rights.";
    case Status::device_in_use:
        return "Another node of this process owns the device; free that node or choose another "
               "device.";
    case Status::read_timeout:
        return "The device sent no report in time; check its cable and its power.";
    case Status::read_failed:
        return "Reading the device failed; check the cable.";
    case Status::write_failed:
        return "Writing to the device failed; check the cable.";
    case Status::over_speed:
        return "The grip moved faster than the safety limit; the motors are off.";
    case Status::string_fault:
        return "The string lengths contradict each other; check for a slack, slipped or broken "
               "string and zero the device again.";
    case Status::overheated:
        return "A motor's thermal budget is spent; let the motors cool and request less force.";
    case Status::unstable:
        return "The rendered forces shake the grip; lower the stiffness or damping.";
    case Status::device_restarted:
        return "The device restarted, so its counts lost their zero; hold the grip at home and "
               "zero it.";
    case Status::zero_needed:
        return "The device has no zero; hold the grip at home and zero it.";
    case Status::panic_stopped:
        return "The device was stopped by panic_stop(); clear the fault, then arm again.";
    case Status::loop_stalled:
        return "The servo thread stopped running, so the motors were switched off; check the "
               "device, clear the fault, then arm again.";
    case Status::device_not_zeroed:
        return "The device does not know its zero; hold the grip at its home pose and zero it.";
    case Status::device_emergency_stop:
        return "The device's emergency stop is pressed; release it, clear the fault, then arm.";
    case Status::device_watchdog:
        return "The device missed commands and switched its motors off; clear the fault, then arm.";
    case Status::device_no_power:
        return "The device's motors have no power; check its supply and emergency stop.";
    case Status::device_encoder_fault:
        return "The device reports a faulty encoder; check the strings and its wiring.";
    case Status::device_over_temperature:
        return "The device is too hot; let its motors cool.";
    case Status::no_device:
        return "No such device is plugged in; check the cable, the power and the device names in "
               "the settings.";
    case Status::no_permission:
        return "This user has no permission to open the device; install "
               "addons/spidar_g/udev/70-spidar-g.rules, then plug it in again.";
    case Status::protocol_mismatch:
        return "The device uses another protocol version or is not a SPIDAR-G; check its firmware.";
    case Status::hid_unavailable:
        return "The system's HID access did not start; only the simulated device can be used.";
    }
    return "Unknown status value.";
}

} // namespace spidar
