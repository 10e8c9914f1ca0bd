// The states of a device, from the first reading to the last.
#pragma once

#include <cstddef>
#include <cstdint>

namespace spidar {

// CLOSED -> CONNECTED -> ARMING -> ACTIVE -> FADING -> CONNECTED. A device without a zero goes CONNECTED -> TAUT ->
// CALIBRATED -> ARMING; FADING leads it to CONNECTED too, with its zero known. FAULT is latched.
enum class DeviceState : std::uint8_t {
    closed = 0,    // no device
    connected = 1, // reading; motors at zero
    arming = 2,    // forces rise
    active = 3,
    fading = 4, // forces fall, then connected: motors off, whatever led to it
    fault = 5,  // motors off until clear_fault() and arm()
    taut = 6,   // zero_at_home(): strings drawn taut, zero taken, then checked by moving the grip
    calibrated = 7, // the zero is confirmed; pretension keeps the strings taut until arm()
};
inline constexpr std::size_t kDeviceStates = 8;
static_assert(kDeviceStates == static_cast<std::size_t>(DeviceState::calibrated) + 1);
[[nodiscard]] const char *describe(DeviceState state) noexcept;

} // namespace spidar
