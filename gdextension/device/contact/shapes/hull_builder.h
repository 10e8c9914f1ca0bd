// Convex hulls, also with all faces moved inwards, by Jolt's builder. Not for the servo thread.
#pragma once

#include <span>

#include "device/contact/shapes/convex_core.h"

namespace spidar {

// Builds corners and faces of `core`. Returns false when the points span no volume.
[[nodiscard]] bool build_hull(std::span<const Vec3> points, ConvexCore &core);

// Builds `core` as the hull with every face moved inwards by skin_m. A thin hull allows less,
// namely half the distance from its center to its nearest face; skin_m receives the distance used.
// Returns false when rounding left no volume.
[[nodiscard]] bool shrink_hull(const ConvexCore &hull, double &skin_m, ConvexCore &core);

} // namespace spidar
