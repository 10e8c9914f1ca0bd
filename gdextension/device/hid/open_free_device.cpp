#include "device/hid/open_free_device.h"

#include <vector>

namespace spidar {

std::unique_ptr<HidTransport> open_free_device(const std::shared_ptr<HidBus> &bus,
                                               HidTransportSettings settings,
                                               const std::string &owner, DeviceClaim &claim,
                                               Status &status, std::string &problem) {
    problem = validate(settings.filter);
    if (!problem.empty()) {
        status = Status::invalid_settings;
        return nullptr;
    }
    std::vector<HidDeviceInfo> found;
    status = find_devices(*bus, settings.filter, found);
    problem = describe(status);
    for (const HidDeviceInfo &device : found) {
        const std::string name = claim_name(device);
        if (!claim.take(name, owner)) {
            status = Status::device_in_use;
            problem = "Device \"" + device.product + "\" (serial \"" + device.serial +
                      "\") belongs to \"" + DeviceClaim::owner_of(name) +
                      "\": free it there, or set device_serial to the serial number "
                      "of another device.";
            continue;
        }
        settings.filter.serial = device.serial;
        settings.filter.path = device.path; // this device among all that match
        auto transport = std::make_unique<HidTransport>(bus, settings);
        status = transport->open(); // now, so that a failure can be reported or replaced
        if (usable(status)) {
            return transport;
        }
        problem = transport->problem();
        claim.release();
    }
    return nullptr;
}

} // namespace spidar
