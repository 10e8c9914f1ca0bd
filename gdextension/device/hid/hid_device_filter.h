// Which of the plugged-in HID devices are meant.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "device/hid/hid_bus.h"

namespace spidar {

// 0 or empty: any. All devices must have the vendor-defined usage page, where the system tells it.
struct HidDeviceFilter {
    std::uint16_t vendor_id = 0;
    std::uint16_t product_id = 0;
    std::string serial;               // name_of() the device
    std::string product = "SPIDAR-G"; // the product string begins with this
    std::string path;                 // of the system: tells devices without a serial number apart
};

[[nodiscard]] bool matches(const HidDeviceFilter &filter, const HidDeviceInfo &device);

// Its serial number, or its path where it has none.
[[nodiscard]] const std::string &name_of(const HidDeviceInfo &device) noexcept;

// Under which name a device is claimed and its motors' heat is kept. Empty of no device.
[[nodiscard]] std::string claim_name(const HidDeviceInfo &device);

// Those that match, in the order of their serial numbers, each path once. no_device when there is none.
[[nodiscard]] Status find_devices(HidBus &bus, const HidDeviceFilter &filter,
                                  std::vector<HidDeviceInfo> &found);

// Empty when usable; else one sentence naming the field, the value and the remedy.
[[nodiscard]] std::string validate(const HidDeviceFilter &filter);

} // namespace spidar
