// Opens one of the plugged-in devices that nobody in this process owns.
#pragma once

#include <memory>
#include <string>

#include "device/contract/device_claims.h"
#include "device/hid/hid_transport.h"

namespace spidar {

// Opens the first device that matches settings.filter, is free and can be opened; `claim` then owns
// it in the name of `owner`. Returns null with `status` and `problem` otherwise. For
// invalid_settings, `problem` begins with the name of a filter field.
[[nodiscard]] std::unique_ptr<HidTransport> open_free_device(const std::shared_ptr<HidBus> &bus,
                                                             HidTransportSettings settings,
                                                             const std::string &owner,
                                                             DeviceClaim &claim, Status &status,
                                                             std::string &problem);

} // namespace spidar
