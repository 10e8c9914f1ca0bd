// Opens one of the plugged-in devices that nobody in this process has claimed.
#pragma once

#include <memory>
#include <string>

#include "device/contract/device_claims.h"
#include "device/hid/hid_transport.h"

namespace spidar {

// Opens the first device that matches settings.filter, is not claimed and can be opened; `claim`
// then holds it in the name of `owner`. On failure returns null with `status` and `problem`. For
// invalid_settings, `problem` begins with the name of a SpidarGConfig property.
[[nodiscard]] std::unique_ptr<HidTransport> open_free_device(const std::shared_ptr<HidBus> &bus,
                                                             HidTransportSettings settings,
                                                             const std::string &owner,
                                                             DeviceClaim &claim, Status &status,
                                                             std::string &problem);

} // namespace spidar
