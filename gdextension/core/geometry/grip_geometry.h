// The grip: two crossing poles hinged at P0, each with strings at both ends (in the paper two at
// each end), or one rigid body.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "core/base/sound_state.h"
#include "core/base/types.h"
#include "core/geometry/frame_geometry.h"

namespace spidar {

// Half length of a pole in the paper's device: 4 cm.
inline constexpr double kPaperPoleHalfLength_m = 0.04;

// Poles whose angle is within this of 0 or 180 degrees define no plane: the ends of the paper's
// poles are then at most 4 um apart, a sixth of an encoder count. Their rotation would be noise, so
// that frame_of() keeps the previous one.
inline constexpr double kParallelAngle_rad = 1e-4;

// String i is tied to P0 + sign * r[pole], where r[0] = r1 and r[1] = r2.
struct Attachment {
    int pole = 0;      // 0: r1, 1: r2
    double sign = 1.0; // +1 or -1: which end of the pole
};

// crossed: two hinged poles, 7 DOF. rigid: one body, 6 DOF, r1 orthogonal to r2, grasp angle 0.
enum class GripKind : std::uint8_t { crossed = 0, rigid = 1 };

struct GripGeometry {
    // crossed: d = |r1| = |r2|. rigid: the length that converts turns to meters, and the length of
    // the poles for drawing and touch; make_rigid_grip() sets it to the root mean square of the
    // joints' distances from P0.
    double pole_half_length_m = kPaperPoleHalfLength_m;
    // Paper: strings 1,2 -> P0+r1; 3,4 -> P0-r1; 5,7 -> P0+r2; 6,8 -> P0-r2.
    std::array<Attachment, kStringCount> attachments{
        {{0, 1.0}, {0, 1.0}, {0, -1.0}, {0, -1.0}, {1, 1.0}, {1, -1.0}, {1, 1.0}, {1, -1.0}}};
    GripKind kind = GripKind::crossed;
    // rigid: tie point of string i from P0, in the grip's frame (x along r2, y along r1; m).
    StringVectors joints_m{};
};

// Checks restored memory: see core/base/sound_state.h.
[[nodiscard]] constexpr bool is_sound(const GripGeometry &grip) noexcept {
    bool sound = is_one_of(grip.kind, GripKind::rigid);
    for (const Attachment &attachment : grip.attachments) {
        sound = sound && (attachment.pole == 0 || attachment.pole == 1);
    }
    return sound;
}

// Returns a rigid grip with its strings tied at joints_m (grip's frame, unit: m).
[[nodiscard]] GripGeometry make_rigid_grip(const StringVectors &joints_m) noexcept;

// Pose of the grip in R3 x S2 x S2, device frame. Orientation and angles derive from it.
struct GripPose {
    Vec3 position_m{0.0};                        // P0
    Vec3 r1_m{0.0, kPaperPoleHalfLength_m, 0.0}; // half pole 1, |r1| = d
    Vec3 r2_m{kPaperPoleHalfLength_m, 0.0, 0.0}; // half pole 2, |r2| = d
};

// Orientation and crossing angle of a pose: p = unit(r1+r2), m = unit(r2-r1), z = unit(m x p), x =
// (m+p)/sqrt2, y = (p-m)/sqrt2, R = [x y z] (I at rest); psi = 2 atan2(|r2-r1|, |r1+r2|);
// grasp_angle = pi/2 - psi.
struct GripFrame {
    Mat3 rotation{1.0};
    double crossing_angle_rad = 0.0; // psi, in [0, pi]
    double grasp_angle_rad = 0.0;    // 0 when open at rest, positive as the poles close
    bool rotation_held = false;      // poles parallel: rotation is previous_rotation
};

// The grip at the frame's center, upright and open.
[[nodiscard]] GripPose rest_pose(const GripGeometry &grip) noexcept;

// Inverse of frame_of(): the pose with this position, orthonormal rotation and grasp angle.
[[nodiscard]] GripPose make_pose(const GripGeometry &grip, const Vec3 &position_m,
                                 const Mat3 &rotation, double grasp_angle_rad) noexcept;

// Returns previous_rotation as the rotation when the poles are parallel (psi within
// kParallelAngle_rad of 0 or pi).
[[nodiscard]] GripFrame frame_of(const GripPose &pose, const Mat3 &previous_rotation) noexcept;

// Returns the vector from P0 to the tie point of the string, device frame (unit: m).
[[nodiscard]] Vec3 attachment_lever(const GripGeometry &grip, const GripPose &pose,
                                    std::size_t string) noexcept;

// Returns the tie point of the string, device frame (unit: m).
[[nodiscard]] Vec3 attachment_point(const GripGeometry &grip, const GripPose &pose,
                                    int string) noexcept;

// Inverse kinematics: returns the eight string lengths of a pose (unit: m), eq. (1)-(11), around
// the exit pulleys if there are any.
[[nodiscard]] StringArray string_lengths(const FrameGeometry &frame, const GripGeometry &grip,
                                         const GripPose &pose) noexcept;

// True when validate() returns an empty string. No allocation: for the servo loop.
[[nodiscard]] bool is_usable(const GripGeometry &grip, const FrameGeometry &frame) noexcept;

// Returns an empty string when usable, else one sentence with field, value, unit and remedy.
[[nodiscard]] std::string validate(const GripGeometry &grip, const FrameGeometry &frame);

} // namespace spidar
