// Computes points or triangles for shapes that are cooked as a hull or a mesh.
#pragma once

#include <vector>

#include "core/base/types.h"
#include "device/contact/shapes/cooked_shape.h"

namespace spidar {

// Returns points on a sphere (half_height 0), or on a capsule along Y whose straight part is twice
// half_height long. Their hull lies at most 1 % of the radius inside the surface.
[[nodiscard]] std::vector<Vec3> round_points(double radius, double half_height);
// Returns points on the two rims of a cylinder along Y.
[[nodiscard]] std::vector<Vec3> rim_points(double radius, double half_height);

// Returns the farthest points in 1024 evenly spread directions. Their hull is close to that of all
// points, but may lack flat corners.
[[nodiscard]] std::vector<Vec3> outermost_points(const std::vector<Vec3> &points_m);

// Returns a two-sided mesh for a hull whose points lie in one plane. It has no triangles when the
// points lie on a line.
[[nodiscard]] ShapeDescription flat_mesh(const std::vector<Vec3> &points_m);

} // namespace spidar
