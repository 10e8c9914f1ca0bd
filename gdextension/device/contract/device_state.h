// The states of a device, from the first reading to the last.
#pragma once

#include <cstdint>

namespace spidar {

// Simulated device: CLOSED -> CONNECTED -> ARMING -> ACTIVE -> FADING -> CONNECTED.
// Real device: CLOSED -> CONNECTED -> TAUT -> CALIBRATED -> ARMING -> ACTIVE -> FADING -> CALIBRATED.
// FAULT is latched.
enum class DeviceState : std::uint8_t {
    closed = 0,    // no device
    connected = 1, // reading; motors at zero
    arming = 2,    // forces rise
    active = 3,
    fading = 4, // forces fall, then connected
    fault = 5,  // motors off until clear_fault() and arm()
    taut = 6,   // zero_at_home(): strings drawn taut, zero taken, then checked by moving the grip
    calibrated = 7, // zero known; pretension keeps the strings taut, so that it stays known
};
[[nodiscard]] const char *describe(DeviceState state) noexcept;

} // namespace spidar
