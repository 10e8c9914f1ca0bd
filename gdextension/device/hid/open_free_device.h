// Opens one of the plugged-in devices that nobody in this process owns.
#pragma once

#include <memory>
#include <string>

#include "device/contract/device_claims.h"
#include "device/hid/hid_transport.h"

namespace spidar {

// The first that matches settings.filter, is free and opens; `claim` then owns it in the name of `owner`. Null: `status`
// and `problem` say why; invalid_settings: a field of the filter, which `problem` begins with.
[[nodiscard]] std::unique_ptr<HidTransport> open_free_device(const std::shared_ptr<HidBus> &bus,
                                                             HidTransportSettings settings,
                                                             const std::string &owner,
                                                             DeviceClaim &claim, Status &status,
                                                             std::string &problem);

} // namespace spidar
