// The devices that could be chosen now.
#pragma once

#include <string>
#include <vector>

#include "device/hid/hid_bus.h"

namespace spidar {

// All devices with the usage page and the product name of a SPIDAR-G, at most a second old: asking the system takes many
// milliseconds. For the main thread.
[[nodiscard]] const std::vector<HidDeviceInfo> &plugged_in_devices();

// The paths of all serial ports, by comma, those of USB bridges first: what the inspector suggests.
[[nodiscard]] std::string names_of_serial_ports();

} // namespace spidar
