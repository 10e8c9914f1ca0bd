// Opens the device of a calibration, chosen by SpidarGConfig.transport. Called in the rig's thread,
// so it uses no object of the engine.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "device/contract/device_claims.h"
#include "device/contract/transport.h"
#include "device/hid/hid_transport.h"
#include "device/serial/serial_transport.h"
#include "device/simulation/simulated_plant.h"

namespace spidar {

struct CalibrationTarget {
    // Which devices to try, by SpidarGConfig.transport.
    bool try_hid = true;       // Automatic and Device
    bool try_serial = false;   // Serial
    bool try_simulated = true; // Automatic and Simulated
    HidTransportSettings hid;
    SerialTransportSettings serial;
    PlantSettings plant;
    std::string simulated_name; // SpidarGConfig.device_name
};

// Facts about the opened device. The rig's thread writes them before its state becomes open.
struct CalibrationOpened {
    DeviceClaim claim;
    bool real = false;
    // The counts have a new origin after each loss of the device.
    bool counts_restart = false;
    // Encoder counts per turn of the motor, as a USB device reports; 0: not reported.
    std::uint32_t counts_per_turn = 0;
    std::string fallback; // why the simulated device is used instead
    // Problems of serial boards with which the device still works.
    std::string remarks;
};

// Returns a transport, or null with the reason in `problem`. A real device is open already; the
// caller opens the simulated one.
[[nodiscard]] std::unique_ptr<Transport> open_for_calibration(const CalibrationTarget &target,
                                                              CalibrationOpened &opened,
                                                              std::string &problem);

} // namespace spidar
