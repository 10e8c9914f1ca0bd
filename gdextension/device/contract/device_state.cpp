#include "device/contract/device_state.h"

namespace spidar {

const char *describe(DeviceState state) noexcept {
    switch (state) {
    case DeviceState::closed:
        return "Closed: no device is open.";
    case DeviceState::connected:
        return "Connected: the grip is read, the motors are off.";
    case DeviceState::arming:
        return "Arming: the forces are rising.";
    case DeviceState::active:
        return "Active: forces are rendered.";
    case DeviceState::fading:
        return "Fading: the forces are falling to zero.";
    case DeviceState::fault:
        return "Fault: the motors are off until clear_fault() and arm().";
    case DeviceState::taut:
        return "Taut: the zero is being set; move the grip to check it.";
    case DeviceState::calibrated:
        return "Calibrated: the zero is known, the strings are held taut.";
    }
    return "Unknown device state.";
}

} // namespace spidar
