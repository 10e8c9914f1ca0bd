// Selects and opens the device of a calibration, by the same rules as the SpidarG node. Called in
// the rig's thread: takes plain values and uses nothing of the engine.
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
    bool try_hid = true;       // for Automatic and Device
    bool try_serial = false;   // for Serial
    bool try_simulated = true; // for Automatic and Simulated
    HidTransportSettings hid;
    SerialTransportSettings serial;
    PlantSettings plant;
    std::string simulated_name; // SpidarGConfig.device_name
};

// The opened device. Written before the rig's state becomes open.
struct CalibrationOpened {
    DeviceClaim claim;
    bool real = false;
    // The counts have a new origin after each loss of the device.
    bool counts_restart = false;
    // As a real device reports; 0: it does not.
    std::uint32_t counts_per_turn = 0;
    std::string fallback; // why the simulated device is used instead
    // Problems of serial boards that do not prevent operation.
    std::string remarks;
};

// Returns null when no device could be opened, with the reason in `problem`.
[[nodiscard]] std::unique_ptr<Transport> open_for_calibration(const CalibrationTarget &target,
                                                              CalibrationOpened &opened,
                                                              std::string &problem);

} // namespace spidar
