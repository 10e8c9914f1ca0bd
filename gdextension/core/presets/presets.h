// Devices that exist: the paper's, and the SPIDAR-G6 family as its open driver describes it
// (Springhead, see THIRDPARTY.md; positions rounded to 10 um). Only geometries that can hold the
// grip at rest are listed; report_geometry() checks any other.
#pragma once

#include <array>
#include <cstdint>

#include "core/geometry/frame_geometry.h"
#include "core/geometry/grip_geometry.h"

namespace spidar {

enum class Preset : std::uint8_t {
    paper = 0,         // 7 DOF, 48 cm frame, crossed poles
    spidar_g6_x3r = 1, // 6 DOF, rigid grip, for the right hand
    spidar_g6_x3l = 2, // mirror image of x3r, for the left hand
    spidar_g6_x5r = 3, // 6 DOF, rigid grip, printed, one B5M board; for the right hand
    spidar_g6_x5l = 4, // mirror image of x5r, for the left hand
    spidar_g6_x4 = 5,  // 6 DOF, rigid grip, two B3M boards or one B5M
};
inline constexpr int kPresetCount = 6;

// What the serial motor boards (docs/reference/serial_boards.md) need to know of a device's motors.
struct BoardWiring {
    // Command units per newton of tension that the usual host of the device sends: its volts per
    // newton times 4096 / 3.3 V. 0: the device has no such boards.
    double units_per_newton = 0.0;
    std::array<std::int8_t, kStringCount> count_signs{1, 1, 1, 1, 1, 1, 1, 1};
    std::array<std::int8_t, kStringCount> current_signs{1, 1, 1, 1, 1, 1, 1, 1};
};

struct DevicePreset {
    const char *name = "";
    FrameGeometry frame;
    GripGeometry grip;
    double metres_per_count = 0.0;
    // The range of tensions of the device's usual driver.
    double min_tension_n = 0.0;
    double max_tension_n = 0.0;
    BoardWiring boards;
};

// For a value outside the enumeration it returns the paper's device.
[[nodiscard]] DevicePreset device_preset(Preset preset) noexcept;

} // namespace spidar
