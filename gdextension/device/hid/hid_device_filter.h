// Selects HID devices among those that are plugged in.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "device/hid/hid_bus.h"

namespace spidar {

// A field that is 0 or empty accepts every device. matches() always rejects a reported usage page
// other than 0xFF00, and the ids 04D8:003F, which many unrelated boards share.
struct HidDeviceFilter {
    std::uint16_t vendor_id = 0;
    std::uint16_t product_id = 0;
    std::string serial; // must equal name_of() of the device
    // The beginning of the product string.
    std::string product = "SPIDAR-G";
    // System path. It selects one of several devices that have no serial number.
    std::string path;
};

[[nodiscard]] bool matches(const HidDeviceFilter &filter, const HidDeviceInfo &device);

// Returns the serial number, or the path of a device without one.
[[nodiscard]] const std::string &name_of(const HidDeviceInfo &device) noexcept;

// Returns the name under which the device is claimed and its motor heat is stored. Empty without
// serial number and path.
[[nodiscard]] std::string claim_name(const HidDeviceInfo &device);

// Finds the matching devices, ordered by serial number, each path once. Returns ok, no_device when
// there is none, or an error of HidBus::enumerate().
[[nodiscard]] Status find_devices(HidBus &bus, const HidDeviceFilter &filter,
                                  std::vector<HidDeviceInfo> &found);

// Returns an empty string, or one sentence with a remedy if product and serial are both empty.
[[nodiscard]] std::string validate(const HidDeviceFilter &filter);

} // namespace spidar
