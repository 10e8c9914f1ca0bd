// One plug-in of a device: its handles, opened, asked what it is and told its limits.
#pragma once

#include <memory>
#include <string>

#include "device/hid/hid_bus.h"
#include "device/hid/protocol/hid_protocol.h"

namespace spidar {

// A handle each, because one handle must not be used by two threads at once.
struct HidSession {
    std::shared_ptr<HidHandle> reader;  // servo loop
    std::shared_ptr<HidHandle> writer;  // writer thread
    std::shared_ptr<HidHandle> control; // controlling thread: feature reports
    HidDeviceInfo device;
    HidCapabilities capabilities;
    HidLimits limits; // as the device keeps them
};

// `problem`: a sentence when the status is negative. On failure nothing stays open.
[[nodiscard]] Status open_session(HidBus &bus, const HidDeviceInfo &device, const HidLimits &limits,
                                  HidSession &session, std::string &problem);

} // namespace spidar
