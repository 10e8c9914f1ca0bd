// Pose of a shape in the device frame: a point x of the shape lies at origin_m + rotation * x.
#pragma once

#include "core/base/finite.h"
#include "core/base/types.h"

namespace spidar {

struct Placement {
    Vec3 origin_m{0.0};
    Mat3 rotation{1.0}; // orthonormal and right-handed
};

// Returns the placement `inner` inside `outer`: first `inner` is applied, then `outer`.
[[nodiscard]] inline Placement operator*(const Placement &outer, const Placement &inner) noexcept {
    return {outer.origin_m + outer.rotation * inner.origin_m, outer.rotation * inner.rotation};
}

[[nodiscard]] inline bool all_finite(const Placement &placement) noexcept {
    return all_finite(placement.origin_m) && all_finite(placement.rotation);
}

} // namespace spidar
