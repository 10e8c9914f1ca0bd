// Convex hulls and what is left of them when every face moves inwards, by Jolt's builder. Not for the servo thread.
#pragma once

#include <span>

#include "device/contact/shapes/convex_core.h"

namespace spidar {

// False: the points span no volume. Otherwise core holds corners and faces.
[[nodiscard]] bool build_hull(std::span<const Vec3> points, ConvexCore &core);

// The hull with every face moved inwards by at most skin_m; what was taken is written to skin_m: a thin hull gives half
// of the way from its middle to its nearest face. False: rounding left no volume.
[[nodiscard]] bool shrink_hull(const ConvexCore &hull, double &skin_m, ConvexCore &core);

} // namespace spidar
