// Which device a calibration opens, by the same choice as the SpidarG node. Called in the rig's own thread, so it takes
// plain values and touches nothing of the engine.
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
    bool try_hid = true;       // Automatic and Device
    bool try_serial = false;   // Serial
    bool try_simulated = true; // Automatic and Simulated
    HidTransportSettings hid;
    SerialTransportSettings serial;
    PlantSettings plant;
    std::string simulated_name; // SpidarGConfig.device_name
};

// What was opened. Written before the rig's state becomes open.
struct CalibrationOpened {
    DeviceClaim claim;
    bool real = false;
    bool counts_restart = false;       // from elsewhere, whenever the device was lost
    std::uint32_t counts_per_turn = 0; // real: as the device says; 0: it does not
    std::string fallback;              // why the simulated device stands in
    std::string remarks;               // serial boards: what works, but not as it should
};

// Null: none could be opened; `problem` says why.
[[nodiscard]] std::unique_ptr<Transport> open_for_calibration(const CalibrationTarget &target,
                                                              CalibrationOpened &opened,
                                                              std::string &problem);

} // namespace spidar
