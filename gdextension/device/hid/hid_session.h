// The connection to a device from one plug-in to its loss: handles, capabilities and limits.
#pragma once

#include <memory>
#include <string>

#include "device/hid/hid_bus.h"
#include "device/hid/protocol/hid_protocol.h"

namespace spidar {

// Each thread has its own handle, since two threads must not use one handle at the same time.
struct HidSession {
    std::shared_ptr<HidHandle> reader;  // servo loop
    std::shared_ptr<HidHandle> writer;  // writer thread
    std::shared_ptr<HidHandle> control; // controlling thread: feature reports
    HidDeviceInfo device;
    HidCapabilities capabilities;
    HidLimits limits; // as the device reports them back
};

// Opens the handles, reads the capabilities and sets the limits. On failure all handles are closed,
// and `problem` holds a sentence.
[[nodiscard]] Status open_session(HidBus &bus, const HidDeviceInfo &device, const HidLimits &limits,
                                  HidSession &session, std::string &problem);

} // namespace spidar
