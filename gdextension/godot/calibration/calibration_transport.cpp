#include "godot/calibration/calibration_transport.h"

#include "device/hid/open_free_device.h"
#include "device/serial/open_serial_device.h"
#include "device/simulation/simulated_transport.h"
#include "godot/settings/spidar_g_config.h"

namespace spidar {

namespace {

const char *const kOwner = "SpidarGCalibrator";

std::unique_ptr<Transport> open_hid(const CalibrationTarget &target, CalibrationOpened &opened,
                                    std::string &problem) {
    Status status = Status::ok;
    auto transport =
        open_free_device(system_hid_bus(), target.hid, kOwner, opened.claim, status, problem);
    if (status == Status::invalid_settings) {
        problem = "SpidarGConfig." + problem;
    }
    opened.real = transport != nullptr;
    opened.counts_per_turn = transport ? transport->capabilities().counts_per_turn : 0;
    return transport;
}

std::unique_ptr<Transport> open_serial(const CalibrationTarget &target, CalibrationOpened &opened,
                                       std::string &problem) {
    Status status = Status::ok;
    auto transport = open_serial_device(target.serial, kOwner, opened.claim, status, problem);
    problem = SpidarGConfig::told_of(problem);
    opened.real = transport != nullptr;
    opened.counts_restart = true; // the boards report 16 bits of a count that starts at power-up
    opened.remarks = transport ? transport->remarks() : std::string();
    return transport;
}

} // namespace

std::unique_ptr<Transport> open_for_calibration(const CalibrationTarget &target,
                                                CalibrationOpened &opened, std::string &problem) {
    if (target.try_serial) {
        return open_serial(target, opened, problem);
    }
    if (target.try_hid) {
        if (auto transport = open_hid(target, opened, problem)) {
            return transport;
        }
        if (!target.try_simulated) {
            return nullptr;
        }
        opened.fallback = problem;
    }
    if (!opened.claim.take(target.simulated_name, kOwner)) {
        problem = "The device belongs to \"" + DeviceClaim::owner_of(target.simulated_name) +
                  "\": free it there, or choose another device_name.";
        return nullptr;
    }
    problem.clear();
    return std::make_unique<SimulatedTransport>(target.plant);
}

} // namespace spidar
