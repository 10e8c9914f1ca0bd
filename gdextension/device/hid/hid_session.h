// One plug-in of a device: its handles, its capabilities and its limits.
#pragma once

#include <memory>
#include <string>

#include "device/hid/hid_bus.h"
#include "device/hid/protocol/hid_protocol.h"

namespace spidar {

// There is one handle per thread, since two threads must not use the same handle at once.
struct HidSession {
    std::shared_ptr<HidHandle> reader;  // servo loop
    std::shared_ptr<HidHandle> writer;  // writer thread
    std::shared_ptr<HidHandle> control; // controlling thread: feature reports
    HidDeviceInfo device;
    HidCapabilities capabilities;
    HidLimits limits; // as the device reports them back
};

// Opens handles, reads capabilities, sets limits. Failure leaves nothing open; see `problem`.
[[nodiscard]] Status open_session(HidBus &bus, const HidDeviceInfo &device, const HidLimits &limits,
                                  HidSession &session, std::string &problem);

} // namespace spidar
