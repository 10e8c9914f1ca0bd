#include "godot/settings/plugged_in_devices.h"

#include <chrono>

#include "device/hid/hid_device_filter.h"
#include "device/serial/serial_port.h"

namespace spidar {

const std::vector<HidDeviceInfo> &plugged_in_devices() {
    using Clock = std::chrono::steady_clock;
    constexpr auto kGood = std::chrono::seconds(1);
    static std::vector<HidDeviceInfo> devices;
    static Clock::time_point asked;
    static bool ever = false;
    if (!ever || Clock::now() - asked > kGood) {
        // A failure to list devices is reported when a device is opened.
        (void)find_devices(*system_hid_bus(), HidDeviceFilter(), devices);
        asked = Clock::now();
        ever = true;
    }
    return devices;
}

std::string names_of_serial_ports() {
    std::string names;
    for (const SerialPortInfo &port : list_serial_ports()) {
        names += (names.empty() ? "" : ",") + port.path;
    }
    return names;
}

} // namespace spidar
