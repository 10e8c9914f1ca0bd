// Devices that exist, ready to use: the paper's, and the SPIDAR-G6 family as its open driver states it (Springhead,
// see THIRDPARTY.md; positions rounded to 10 um). Only geometries that can hold the grip at rest are here;
// geometry_report.h says of any other whether it can.
#pragma once

#include <array>
#include <cstdint>

#include "core/geometry/frame_geometry.h"
#include "core/geometry/grip_geometry.h"

namespace spidar {

enum class Preset : std::uint8_t {
    paper = 0,         // 7 DOF, 48 cm frame, crossed poles
    spidar_g6_x3r = 1, // 6 DOF, rigid grip, for the right hand
    spidar_g6_x3l = 2, // its mirror image, for the left
    spidar_g6_x5r = 3, // 6 DOF, rigid grip, printed, one B5M board; for the right hand
    spidar_g6_x5l = 4, // its mirror image, for the left
    spidar_g6_x4 = 5,  // 6 DOF, rigid grip, two B3M boards or one B5M
};
inline constexpr int kPresetCount = 6;

// What a device's serial motor boards (docs/reference/serial_boards.md) must be told of its motors.
struct BoardWiring {
    // What the usual host sends: it thinks in volts. 0: this device has no such boards.
    double units_per_newton = 0.0;
    std::array<std::int8_t, kStringCount> count_signs{1, 1, 1, 1, 1, 1, 1, 1};
    std::array<std::int8_t, kStringCount> current_signs{1, 1, 1, 1, 1, 1, 1, 1};
};

struct DevicePreset {
    const char *name = "";
    FrameGeometry frame;
    GripGeometry grip;
    double metres_per_count = 0.0;
    double min_tension_n = 0.0; // what the driver keeps the strings between
    double max_tension_n = 0.0;
    BoardWiring boards;
};

// A value outside the enumeration gives the paper's device.
[[nodiscard]] DevicePreset device_preset(Preset preset) noexcept;

} // namespace spidar
