// The devices that can be chosen now.
#pragma once

#include <string>
#include <vector>

#include "device/hid/hid_bus.h"

namespace spidar {

// Returns all devices with the usage page and product name of a SPIDAR-G. The list is at most a
// second old, since listing takes many milliseconds. For the main thread.
[[nodiscard]] const std::vector<HidDeviceInfo> &plugged_in_devices();

// Returns the paths of all serial ports, separated by commas, those of USB bridges first:
// suggestions of the inspector.
[[nodiscard]] std::string names_of_serial_ports();

} // namespace spidar
