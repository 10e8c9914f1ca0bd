// Pose and motion of the grip in one cycle, from the strings. Device frame, SI units.
#pragma once

#include "core/base/status.h"
#include "core/base/types.h"
#include "core/geometry/grip_geometry.h"

namespace spidar {

struct GripState {
    GripPose pose;
    GripFrame frame;
    Twist twist; // filtered
    double residual_rms_m = 0.0;
    double conditioning = 0.0;
    // If < 0 or held_last_pose, this cycle gave no pose: the last one was extrapolated or kept.
    Status status = Status::held_last_pose;
};

} // namespace spidar
