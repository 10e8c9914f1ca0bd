// The shortest way out when two cores overlap, by Jolt's expanding polytopes: float32, for recovery only.
#pragma once

#include "device/contact/shapes/gjk.h"

namespace spidar {

// Both cores are known to meet; distance_m is 0 or less. It always leads out; where the search fails it is the
// shortest along an axis of either.
[[nodiscard]] CoreDistance way_out(const CoreView &tool, const Placement &tool_at,
                                   const CoreView &shape) noexcept;

} // namespace spidar
