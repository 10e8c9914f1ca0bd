// Lists the plugged-in devices, for SpidarG.list_devices() and for suggestions in the inspector.
#pragma once

#include <string>
#include <vector>

#include "device/hid/hid_bus.h"

namespace spidar {

// Returns the HID devices that match a default HidDeviceFilter. The list may be up to a second old,
// since listing takes many milliseconds. Call it from the main thread only.
[[nodiscard]] const std::vector<HidDeviceInfo> &plugged_in_devices();

// Returns the paths of list_serial_ports(), separated by commas.
[[nodiscard]] std::string names_of_serial_ports();

} // namespace spidar
