// The box in which the grip center can be: the box around the motors less a border on each side.
#pragma once

#include <algorithm>

#include "core/geometry/frame_geometry.h"

namespace spidar {

struct ReachBox {
    Vec3 low_m{0.0};
    Vec3 high_m{0.0};
};

// Returns the box, device frame (unit: m). Along an axis where the border is wider than half the
// box, low and high are both the middle.
[[nodiscard]] inline ReachBox reach_box(const FrameGeometry &frame, double border_m) noexcept {
    Vec3 low = frame.motors_m[0];
    Vec3 high = low;
    for (const Vec3 &motor : frame.motors_m) {
        for (int axis = 0; axis < 3; ++axis) {
            low[axis] = std::min(low[axis], motor[axis]);
            high[axis] = std::max(high[axis], motor[axis]);
        }
    }
    ReachBox box;
    for (int axis = 0; axis < 3; ++axis) {
        const double middle = 0.5 * (low[axis] + high[axis]);
        const double half = std::max(0.0, 0.5 * (high[axis] - low[axis]) - border_m);
        box.low_m[axis] = middle - half;
        box.high_m[axis] = middle + half;
    }
    return box;
}

} // namespace spidar
