// Lines that draw a shape: edges of boxes, hulls and triangles, circles of round shapes. Not for
// the servo thread.
#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

#include <glm/geometric.hpp>

#include "device/contact/shapes/cooked_shape.h"

namespace spidar {

// Largest number of lines per shape; further lines, as of a large mesh, are omitted.
inline constexpr std::size_t kMostOutlineLines = 3000;

// Appends two points per line, in the shape's frame (unit: m). Of meshes, height maps and hulls,
// the faces near a ball are drawn; of a half space, a square grid near it; of a relief, nothing.
// Other shapes are drawn whole.
void add_outline(const CookedShape &shape, const Vec3 &ball_m, double ball_radius_m,
                 std::vector<Vec3> &lines);

// Like add_outline(), for a box about its center.
void add_box_outline(const Vec3 &lower_m, const Vec3 &upper_m, std::vector<Vec3> &lines);

// Returns a unit vector perpendicular to `direction`, which must not be zero.
[[nodiscard]] inline Vec3 any_across(const Vec3 &direction) noexcept {
    const bool is_along_x = std::abs(direction.x) >= 0.7 * glm::length(direction);
    return glm::normalize(
        glm::cross(direction, is_along_x ? Vec3(0.0, 1.0, 0.0) : Vec3(1.0, 0.0, 0.0)));
}

} // namespace spidar
