// Shapes that our cooking has no kind for, as points or triangles.
#pragma once

#include <vector>

#include "core/base/types.h"
#include "device/contact/shapes/cooked_shape.h"

namespace spidar {

// Points round a sphere (half_height 0) or capsule, along Y, within 0.5 % of its radius; hull of them.
[[nodiscard]] std::vector<Vec3> round_points(double radius, double half_height);
// The same of a cylinder: its two rims.
[[nodiscard]] std::vector<Vec3> rim_points(double radius, double half_height);

// The points that stand out farthest in evenly spread directions: their hull is within 0.2 % of the size of the hull of all.
[[nodiscard]] std::vector<Vec3> outermost_points(const std::vector<Vec3> &points_m);

// A hull whose points lie in one plane, as a mesh with two sides. No triangles: the points lie on a line.
[[nodiscard]] ShapeDescription flat_mesh(const std::vector<Vec3> &points_m);

} // namespace spidar
