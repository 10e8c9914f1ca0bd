// The shortest way out of two overlapping cores, by Jolt's expanding polytopes. Single precision:
// for recovery only.
#pragma once

#include "device/contact/shapes/gjk.h"

namespace spidar {

// Requires cores that meet. Returns a distance_m of at most 0 along a direction that always leads
// out. When the search fails, the result is the shortest way along an axis of either core.
[[nodiscard]] CoreDistance way_out(const CoreView &tool, const Placement &tool_at,
                                   const CoreView &shape) noexcept;

} // namespace spidar
