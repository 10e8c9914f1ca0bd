// The wavy field that meshes are measured on, as exact heights and as triangles, and a way over it.
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

#include <glm/geometric.hpp>

#include "device/contact/shapes/cooked_shape.h"
#include "device/contact/shapes/placement.h"

namespace spidar::bench {

inline constexpr double kFieldSize_m = 0.5;
inline constexpr double kFieldHeight_m = 0.01; // amplitude
inline constexpr double kWaveX_m = 0.31;
inline constexpr double kWaveZ_m = 0.37;
inline constexpr double kCircle_m = 0.15; // radius of the way
inline constexpr double kPeriod_s = 1e-3;

inline double field_height(double x, double z) {
    return kFieldHeight_m * std::sin(2.0 * std::numbers::pi * x / kWaveX_m) *
           std::cos(2.0 * std::numbers::pi * z / kWaveZ_m);
}

inline ShapeDescription field(int cells) {
    ShapeDescription shape;
    shape.kind = ShapeKind::mesh;
    const int side = cells + 1;
    for (int i = 0; i < side * side; ++i) {
        const double x = (i % side - 0.5 * cells) * kFieldSize_m / cells;
        const double z = (i / side - 0.5 * cells) * kFieldSize_m / cells;
        shape.points_m.emplace_back(x, field_height(x, z), z);
    }
    for (int i = 0; i < side * side; ++i) {
        if (i % side == cells || i / side == cells) {
            continue;
        }
        const auto here = static_cast<std::uint32_t>(i);
        const auto below = here + static_cast<std::uint32_t>(side);
        for (const std::uint32_t index : {here, below, here + 1, here + 1, below, below + 1}) {
            shape.indices.push_back(index);
        }
    }
    return shape;
}

// On a circle over the field, flat on it: the middle of a tool this far above the surface (unit: m).
inline Placement on_field(double speed_m_s, double time_s, double above_m) {
    const double angle = speed_m_s * time_s / kCircle_m;
    const double x = kCircle_m * std::cos(angle);
    const double z = kCircle_m * std::sin(angle);
    constexpr double kStep_m = 1e-6;
    const Vec3 up = glm::normalize(
        Vec3(field_height(x - kStep_m, z) - field_height(x + kStep_m, z), 2.0 * kStep_m,
             field_height(x, z - kStep_m) - field_height(x, z + kStep_m)));
    const Vec3 side = glm::normalize(glm::cross(up, Vec3(0.0, 0.0, 1.0)));
    return {Vec3(x, field_height(x, z), z) + above_m * up, Mat3(side, up, glm::cross(side, up))};
}

} // namespace spidar::bench
