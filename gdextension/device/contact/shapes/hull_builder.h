// Builds convex hulls, also with all faces moved inward, by Jolt's builder. Not for the servo
// thread.
#pragma once

#include <span>

#include "device/contact/shapes/convex_core.h"

namespace spidar {

// Builds corners and faces of `core`. Returns false when that fails, as for points in one plane.
[[nodiscard]] bool build_hull(std::span<const Vec3> points, ConvexCore &core);

// Builds `core` as the hull with every face moved inward by skin_m, but by at most half the
// distance from the hull's center to its nearest face; skin_m receives the distance used. Returns
// false when that fails, as when rounding leaves no volume.
[[nodiscard]] bool shrink_hull(const ConvexCore &hull, double &skin_m, ConvexCore &core);

} // namespace spidar
