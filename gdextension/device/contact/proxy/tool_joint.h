// What ties the held body to something else in the scene: a door's hinge, a drawer's slide, a ball
// in its socket. Device frame, SI units.
#pragma once

#include <array>
#include <cstdint>

#include "device/contact/shapes/placement.h"

namespace spidar {

// One of the six coordinates of a joint: position or angle of the frame on the held body relative
// to the frame on the other body, along or about the axes of the latter. Units: m, N/m, N s/m, m/s,
// N; or rad, N m/rad, N m s/rad, rad/s, N m.
struct JointAxis {
    // Limits of the coordinate. Equal limits lock the axis; lower above upper means no limit.
    double lower = 0.0;
    double upper = 0.0;
    double stiffness = 0.0; // of a spring toward `rest`
    double rest = 0.0;
    double damping = 0.0;
    // Speed of a motor.
    double motor_speed = 0.0;
    // Largest force or moment of the motor; 0: no motor.
    double motor_most = 0.0;

    [[nodiscard]] static JointAxis free() noexcept {
        JointAxis axis;
        axis.lower = 1.0;
        axis.upper = -1.0;
        return axis;
    }
    [[nodiscard]] bool is_locked() const noexcept { return lower == upper; }
    [[nodiscard]] bool is_limited() const noexcept { return lower < upper; }
};

struct ToolJoint {
    std::int32_t id = 0;    // the same in every scene
    Placement base;         // the joint's frame on the other body
    Vec3 velocity_m_s{0.0}; // of base.origin_m
    Vec3 angular_rad_s{0.0};
    Placement in_grip; // frame on the held body, in the grip's frame
    // Translations along x, y, z, then turns about them. Unless exactly one turn is unlocked, the
    // turns are the components of the rotation vector.
    std::array<JointAxis, 6> axes{};
};

inline constexpr int kMaxToolJoints = 2; // a door has two hinges

} // namespace spidar
