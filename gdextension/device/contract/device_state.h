// The states of a device.
#pragma once

#include <cstddef>
#include <cstdint>

namespace spidar {

// CLOSED -> CONNECTED -> ARMING -> ACTIVE -> FADING -> CONNECTED. A device without a zero goes
// CONNECTED -> TAUT -> CALIBRATED -> ARMING; after FADING it is CONNECTED with its zero known.
// FAULT is latched.
enum class DeviceState : std::uint8_t {
    closed = 0,    // no device
    connected = 1, // the device is open; motors off
    arming = 2,    // forces rise
    active = 3,
    // Forces fall, then the device is connected with its motors off.
    fading = 4,
    fault = 5, // motors off until clear_fault() and arm()
    // zero_at_home() runs: strings are drawn taut, zeroed, then checked by moving the grip.
    taut = 6,
    // The zero is confirmed; pretension keeps the strings taut until arm().
    calibrated = 7,
};
inline constexpr std::size_t kDeviceStates = 8;
static_assert(kDeviceStates == static_cast<std::size_t>(DeviceState::calibrated) + 1);
[[nodiscard]] const char *describe(DeviceState state) noexcept;

} // namespace spidar
