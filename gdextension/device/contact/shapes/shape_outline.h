// The lines that show a shape to people: edges of boxes, hulls and triangles, circles of what is round. Not for the servo
// thread.
#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

#include <glm/geometric.hpp>

#include "device/contact/shapes/cooked_shape.h"

namespace spidar {

// Lines of one shape: of a mesh with more of them near, the rest is left out.
inline constexpr std::size_t kMostOutlineLines = 3000;

// Adds two points for each line, in the shape's frame (m). Of meshes, height maps and hulls the faces near a ball come, of a
// half space a square grid over it; anything else comes whole.
void add_outline(const CookedShape &shape, const Vec3 &ball_m, double ball_radius_m,
                 std::vector<Vec3> &lines);

// As add_outline, of a box about its own middle.
void add_box_outline(const Vec3 &lower_m, const Vec3 &upper_m, std::vector<Vec3> &lines);

// Some unit direction at right angles to this one, to draw round it. direction: not zero, of any length.
[[nodiscard]] inline Vec3 any_across(const Vec3 &direction) noexcept {
    const bool is_along_x = std::abs(direction.x) >= 0.7 * glm::length(direction);
    return glm::normalize(
        glm::cross(direction, is_along_x ? Vec3(0.0, 1.0, 0.0) : Vec3(1.0, 0.0, 0.0)));
}

} // namespace spidar
