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
    // < 0 or held_last_pose: the pose is from an earlier cycle.
    Status status = Status::held_last_pose;
};

} // namespace spidar
