// Distance of two convex cores by Gilbert, Johnson and Keerthi (1988), in double precision. In float32, as in Jolt,
// a core 1 mm from a floor of 40 m counts as touching it: docs/why/accuracy_and_speed.md.
#pragma once

#include "device/contact/shapes/convex_core.h"
#include "device/contact/shapes/placement.h"

namespace spidar {

struct CoreDistance {
    bool beyond = false;  // farther apart than the limit; nothing else is set
    bool overlap = false; // the cores meet: no normal, no distance
    double distance_m = 0.0;
    Vec3 on_tool_m{0.0}; // on the tool's core; all in the shape's frame
    Vec3 on_shape_m{0.0};
    Vec3 normal{0.0}; // unit, from the shape to the tool
};

// tool_at: in the shape's frame. axis: where to begin, from shape to tool, and what was found; zero: from the origins.
[[nodiscard]] CoreDistance core_distance(const CoreView &tool, const Placement &tool_at,
                                         const CoreView &shape, double limit_m,
                                         Vec3 &axis) noexcept;

} // namespace spidar
