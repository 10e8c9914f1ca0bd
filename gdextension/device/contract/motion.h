// Motion of the grip from cycle to cycle: measured by tracking, input of rendering.
#pragma once

#include "device/contract/grip_state.h"

namespace spidar {

// A small displacement of the grip: dP0 and turn in the device frame, d(grasp_angle).
struct Displacement {
    Vec3 linear_m{0.0};
    Vec3 angular_rad{0.0};
    double grasp_rad = 0.0;
};

// The fingers of a rigid grip, which no string measures (device/tracking/fingers.h).
struct FingerMotion {
    // True for a rigid grip: angle and rate below are used.
    bool given = false;
    double angle_rad = 0.0; // as a grasp angle: 0 when open
    double rate_rad_s = 0.0;
};

// Input of the renderer for one cycle.
struct GripMotion {
    GripState grip;
    Displacement ahead; // filtered and predicted pose, relative to grip.pose
    Twist velocity;     // filtered
    // Time by which the prediction leads a steady motion (unit: s). Objects that move, such as a
    // wall, must be extrapolated by the same time.
    double lead_s = 0.0;
};

} // namespace spidar
