// How the grip moves from cycle to cycle: what tracking measures, and what requests are rendered against.
#pragma once

#include "device/contract/grip_state.h"

namespace spidar {

// A small move of the grip: dP0, turn, d(grasp_angle).
struct Displacement {
    Vec3 linear_m{0.0};
    Vec3 angular_rad{0.0};
    double grasp_rad = 0.0;
};

// The fingers of a rigid grip, which no string measures (device/tracking/fingers.h). given: they are told by something else.
struct FingerMotion {
    bool given = false;
    double angle_rad = 0.0; // as a grasp angle: 0 open
    double rate_rad_s = 0.0;
};

// One cycle's input of the renderer: the pose as measured, where it will be relative to that, and how fast.
struct GripMotion {
    GripState grip;
    Displacement ahead; // filtered and predicted pose, relative to grip.pose
    Twist velocity;     // filtered
    // How far ahead a steady motion is seen: what moves beside the grip, such as a wall, is to be looked at then.
    double lead_s = 0.0;
};

} // namespace spidar
