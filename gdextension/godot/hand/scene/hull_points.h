// Shapes without a cooked kind of their own, as points or triangles.
#pragma once

#include <vector>

#include "core/base/types.h"
#include "device/contact/shapes/cooked_shape.h"

namespace spidar {

// Points around a sphere (half_height 0) or a capsule along Y; hull within 0.5 % of the radius.
[[nodiscard]] std::vector<Vec3> round_points(double radius, double half_height);
// Returns points on the two rims of a cylinder along Y.
[[nodiscard]] std::vector<Vec3> rim_points(double radius, double half_height);

// Returns the outermost points in evenly spread directions. Their hull is within 0.2 % of the size
// of the hull of all points.
[[nodiscard]] std::vector<Vec3> outermost_points(const std::vector<Vec3> &points_m);

// Returns a two-sided mesh for a hull whose points lie in one plane. It has no triangles when the
// points lie on a line.
[[nodiscard]] ShapeDescription flat_mesh(const std::vector<Vec3> &points_m);

} // namespace spidar
