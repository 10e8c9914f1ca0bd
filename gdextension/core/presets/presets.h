// Devices that exist, ready to use: the paper's, and the SPIDAR-G6 family as its open driver states it (Springhead,
// see THIRDPARTY.md; positions rounded to 10 um). Only geometries that can hold the grip at rest are here;
// geometry_report.h says of any other whether it can.
#pragma once

#include <cstdint>

#include "core/geometry/frame_geometry.h"
#include "core/geometry/grip_geometry.h"

namespace spidar {

enum class Preset : std::uint8_t {
    paper = 0,         // 7 DOF, 48 cm frame, crossed poles
    spidar_g6_x3r = 1, // 6 DOF, rigid grip, for the right hand
    spidar_g6_x3l = 2, // its mirror image, for the left
};
inline constexpr int kPresetCount = 3;

struct DevicePreset {
    const char *name = "";
    FrameGeometry frame;
    GripGeometry grip;
    double metres_per_count = 0.0;
    double min_tension_n = 0.0; // what the driver keeps the strings between
    double max_tension_n = 0.0;
};

// A value outside the enumeration gives the paper's device.
[[nodiscard]] DevicePreset device_preset(Preset preset) noexcept;

} // namespace spidar
