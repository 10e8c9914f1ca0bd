#include "godot/calibration_transport.h"

#include <vector>

#include "device/simulated_transport.h"

namespace spidar {

namespace {

const char *const kOwner = "SpidarGCalibrator";

std::string owned_already(const std::string &name) {
    return "The device belongs to \"" + DeviceClaim::owner_of(name) +
           "\" now: free it there, or choose another device_name or device_serial.";
}

std::unique_ptr<Transport> open_real(const CalibrationTarget &target, CalibrationOpened &opened,
                                     std::string &problem) {
    problem = validate(target.hid.filter);
    if (!problem.empty()) {
        return nullptr;
    }
    const auto bus = system_hid_bus();
    std::vector<HidDeviceInfo> found;
    problem = describe(find_devices(*bus, target.hid.filter, found));
    for (const HidDeviceInfo &device : found) {
        const std::string name = "hid:" + (device.serial.empty() ? device.path : device.serial);
        if (!opened.claim.take(name, kOwner)) {
            problem = owned_already(name);
            continue;
        }
        HidTransportSettings settings = target.hid;
        settings.filter.serial = device.serial;
        auto transport = std::make_unique<HidTransport>(bus, settings);
        if (usable(transport->open())) {
            opened.real = true;
            opened.counts_per_turn = transport->capabilities().counts_per_turn;
            return transport;
        }
        problem = transport->problem();
        opened.claim.release();
    }
    return nullptr;
}

} // namespace

std::unique_ptr<Transport> open_for_calibration(const CalibrationTarget &target,
                                                CalibrationOpened &opened, std::string &problem) {
    if (target.try_real) {
        if (auto transport = open_real(target, opened, problem)) {
            return transport;
        }
        if (!target.try_simulated) {
            return nullptr;
        }
        opened.fallback = problem;
    }
    if (!opened.claim.take(target.simulated_name, kOwner)) {
        problem = owned_already(target.simulated_name);
        return nullptr;
    }
    problem.clear();
    return std::make_unique<SimulatedTransport>(target.plant);
}

} // namespace spidar
