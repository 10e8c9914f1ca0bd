// The grip as the strings show it in one cycle: where it is and how it moves. Device frame, SI.
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
    Status status = Status::held_last_pose; // < 0 or held_last_pose: the pose is an old one
};

} // namespace spidar
