// The shortest way to separate two overlapping cores, by Jolt's expanding-polytope algorithm.
// Single precision: for recovery only.
#pragma once

#include "device/contact/shapes/gjk.h"

namespace spidar {

// Requires cores that meet. Returns a distance_m of at most 0: a move of the tool by -distance_m
// along `normal` separates the cores. If the search fails, this is the shortest way along an axis
// of either core.
[[nodiscard]] CoreDistance way_out(const CoreView &tool, const Placement &tool_at,
                                   const CoreView &shape) noexcept;

} // namespace spidar
