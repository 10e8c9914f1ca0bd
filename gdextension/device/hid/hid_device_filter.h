// Selects HID devices among those that are plugged in.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "device/hid/hid_bus.h"

namespace spidar {

// 0 or an empty string matches any device. The vendor-defined usage page is always required where
// the system reports it.
struct HidDeviceFilter {
    std::uint16_t vendor_id = 0;
    std::uint16_t product_id = 0;
    std::string serial; // as name_of() returns it
    // The product string must begin with this.
    std::string product = "SPIDAR-G";
    // System path; distinguishes devices without a serial number.
    std::string path;
};

[[nodiscard]] bool matches(const HidDeviceFilter &filter, const HidDeviceInfo &device);

// Returns the serial number, or the path when there is none.
[[nodiscard]] const std::string &name_of(const HidDeviceInfo &device) noexcept;

// Returns the name for the device's claim and stored motor heat. Empty without a device.
[[nodiscard]] std::string claim_name(const HidDeviceInfo &device);

// Finds the matching devices, ordered by serial number, each path once. Returns no_device when
// there is none.
[[nodiscard]] Status find_devices(HidBus &bus, const HidDeviceFilter &filter,
                                  std::vector<HidDeviceInfo> &found);

// Returns an empty string when usable, else one sentence with field, value and remedy.
[[nodiscard]] std::string validate(const HidDeviceFilter &filter);

} // namespace spidar
