// The lines that show a shape to people: edges of boxes, hulls and triangles, circles of what is round. Not for the servo
// thread.
#pragma once

#include <cstddef>
#include <vector>

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

} // namespace spidar
