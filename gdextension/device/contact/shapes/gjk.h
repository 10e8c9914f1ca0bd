// Distance between two convex cores by Gilbert, Johnson and Keerthi (1988) in double precision. In
// single precision, as in Jolt, a core 1 mm from a floor of 40 m counts as touching
// (docs/why/accuracy_and_speed.md).
#pragma once

#include "device/contact/shapes/convex_core.h"
#include "device/contact/shapes/placement.h"

namespace spidar {

struct CoreDistance {
    // The distance exceeds limit_m; the fields below are not set.
    bool beyond = false;
    // The cores meet: there is no normal and no distance.
    bool overlap = false;
    double distance_m = 0.0;
    // Point on the tool's core. All vectors are in the shape's frame.
    Vec3 on_tool_m{0.0};
    Vec3 on_shape_m{0.0};
    Vec3 normal{0.0}; // unit vector from the shape to the tool
};

// tool_at: placement in the shape's frame. axis: direction from shape to tool in which the search
// starts (zero: from origin to origin); receives the direction found.
[[nodiscard]] CoreDistance core_distance(const CoreView &tool, const Placement &tool_at,
                                         const CoreView &shape, double limit_m,
                                         Vec3 &axis) noexcept;

} // namespace spidar
