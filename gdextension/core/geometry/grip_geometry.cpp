#include "core/geometry/grip_geometry.h"

#include <cmath>

#include <glm/geometric.hpp>

#include "core/base/describe_value.h"
#include "core/geometry/string_exit.h"

namespace spidar {

namespace {

constexpr double kHalfPi = 1.5707963267948966;
constexpr double kPi = 3.1415926535897932;
constexpr double kInvSqrt2 = 0.70710678118654752;
// Shortest pole that validate() accepts: a shorter one is a unit error.
constexpr double kMinPoleHalfLength_m = 1e-3;
// Joints count as collinear when their largest triangle is smaller than this share of the longest
// side squared.
constexpr double kMinTriangle = 1e-3;

// Half the longest side of the box around the motors (unit: m).
double room_of(const FrameGeometry &frame) noexcept {
    const MotorBox box = box_around_motors(frame);
    const Vec3 size = box.high_m - box.low_m;
    return 0.5 * std::fmax(size.x, std::fmax(size.y, size.z));
}

bool joint_fits(const GripGeometry &grip, const FrameGeometry &frame, std::size_t i) noexcept {
    return glm::length(grip.joints_m[i]) < room_of(frame); // false for NaN
}

bool joints_span(const StringVectors &joints_m) noexcept {
    double longest = 0.0;
    double largest = 0.0;
    for (const Vec3 &a : joints_m) {
        for (const Vec3 &b : joints_m) {
            longest = std::fmax(longest, glm::distance(a, b));
            largest = std::fmax(largest, glm::length(glm::cross(a - joints_m[0], b - joints_m[0])));
        }
    }
    return longest > 0.0 && largest > kMinTriangle * longest * longest;
}

} // namespace

GripPose rest_pose(const GripGeometry &grip) noexcept {
    const double d = grip.pole_half_length_m;
    return {Vec3(0.0), Vec3(0.0, d, 0.0), Vec3(d, 0.0, 0.0)};
}

GripPose make_pose(const GripGeometry &grip, const Vec3 &position_m, const Mat3 &rotation,
                   double grasp_angle_rad) noexcept {
    // r1 and r2 open symmetrically about the diagonal p of the grip's x and y axes. With psi / 2 =
    // pi/4 - grasp/2, pole 1 stands at pi/2 - grasp/2 and pole 2 at grasp/2: exact at rest.
    const double d = grip.pole_half_length_m;
    const double c = d * std::cos(0.5 * grasp_angle_rad);
    const double s = d * std::sin(0.5 * grasp_angle_rad);
    return {position_m, rotation * Vec3(s, c, 0.0), rotation * Vec3(c, s, 0.0)};
}

GripFrame frame_of(const GripPose &pose, const Mat3 &previous_rotation) noexcept {
    const Vec3 sum = pose.r1_m + pose.r2_m;
    const Vec3 difference = pose.r2_m - pose.r1_m;
    const double sum_length = glm::length(sum);
    const double difference_length = glm::length(difference);

    GripFrame frame;
    frame.crossing_angle_rad = 2.0 * std::atan2(difference_length, sum_length);
    frame.grasp_angle_rad = kHalfPi - frame.crossing_angle_rad;
    const bool crossed = frame.crossing_angle_rad > kParallelAngle_rad &&
                         frame.crossing_angle_rad < kPi - kParallelAngle_rad;
    if (!crossed) {
        frame.rotation = previous_rotation;
        frame.rotation_held = true;
        return frame;
    }
    Vec3 p = sum / sum_length;
    Vec3 m = difference / difference_length;
    // p and m are orthogonal up to rounding, which is larger in the shorter of the two sums: that
    // one is corrected.
    if (difference_length < sum_length) {
        m = glm::normalize(m - p * glm::dot(p, m));
    } else {
        p = glm::normalize(p - m * glm::dot(p, m));
    }
    frame.rotation = Mat3((m + p) * kInvSqrt2, (p - m) * kInvSqrt2, glm::cross(m, p));
    return frame;
}

GripGeometry make_rigid_grip(const StringVectors &joints_m) noexcept {
    GripGeometry grip;
    grip.kind = GripKind::rigid;
    grip.joints_m = joints_m;
    double sum = 0.0;
    for (const Vec3 &joint : joints_m) {
        sum += glm::dot(joint, joint);
    }
    grip.pole_half_length_m = std::sqrt(sum / kStringCount);
    return grip;
}

Vec3 attachment_lever(const GripGeometry &grip, const GripPose &pose, std::size_t string) noexcept {
    if (grip.kind == GripKind::rigid) {
        const Vec3 &joint = grip.joints_m[string];
        const double per_d = 1.0 / grip.pole_half_length_m;
        const Vec3 x = per_d * pose.r2_m;
        const Vec3 y = per_d * pose.r1_m;
        return joint.x * x + joint.y * y + joint.z * glm::cross(x, y);
    }
    const Attachment &attachment = grip.attachments[string];
    return attachment.sign * (attachment.pole == 0 ? pose.r1_m : pose.r2_m);
}

Vec3 attachment_point(const GripGeometry &grip, const GripPose &pose, int string) noexcept {
    return pose.position_m + attachment_lever(grip, pose, static_cast<std::size_t>(string));
}

StringArray string_lengths(const FrameGeometry &frame, const GripGeometry &grip,
                           const GripPose &pose) noexcept {
    StringArray lengths{};
    for (std::size_t i = 0; i < kStringCount; ++i) {
        const Vec3 end = attachment_point(grip, pose, static_cast<int>(i));
        lengths[i] = string_path(frame, i, end).length_m;
    }
    return lengths;
}

bool is_usable(const GripGeometry &grip, const FrameGeometry &frame) noexcept {
    if (!(grip.pole_half_length_m >= kMinPoleHalfLength_m) ||
        !(grip.pole_half_length_m < room_of(frame))) {
        return false;
    }
    for (std::size_t i = 0; i < kStringCount; ++i) {
        const Attachment &attachment = grip.attachments[i];
        const bool pole_ok = attachment.pole == 0 || attachment.pole == 1;
        const bool sign_ok = attachment.sign == 1.0 || attachment.sign == -1.0;
        const bool tied =
            grip.kind == GripKind::rigid ? joint_fits(grip, frame, i) : pole_ok && sign_ok;
        if (!tied) {
            return false;
        }
    }
    return grip.kind == GripKind::crossed || joints_span(grip.joints_m);
}

std::string validate(const GripGeometry &grip, const FrameGeometry &frame) {
    const double d = grip.pole_half_length_m;
    if (!(d >= kMinPoleHalfLength_m)) {
        return range_sentence("pole_half_length_m", d, "m",
                              "give at least " + with_unit(kMinPoleHalfLength_m, "m") +
                                  ", the paper's grip has " +
                                  with_unit(kPaperPoleHalfLength_m, "m") + ".");
    }
    for (std::size_t i = 0; i < kStringCount; ++i) {
        const Attachment &attachment = grip.attachments[i];
        if (grip.kind == GripKind::rigid) {
            if (!joint_fits(grip, frame, i)) {
                return element_name("joints_m", i) + " lies " +
                       with_unit(glm::length(grip.joints_m[i]), "m") +
                       " from the grip's center; give a point of the grip in meters, nearer than "
                       "half the frame.";
            }
            continue;
        }
        if (attachment.pole != 0 && attachment.pole != 1) {
            return element_name("attachments", i) + ".pole is " + std::to_string(attachment.pole) +
                   " (index); use 0 for pole 1 or 1 for pole 2.";
        }
        if (attachment.sign != 1.0 && attachment.sign != -1.0) {
            return range_sentence(element_name("attachments", i) + ".sign", attachment.sign,
                                  "(end)", "use +1 or -1 for the two ends of the pole.");
        }
    }
    if (grip.kind == GripKind::rigid && !joints_span(grip.joints_m)) {
        return "joints_m lie on one line; tie the strings to at least three points that are not on "
               "one line, or no string holds the rotation about that line.";
    }
    if (!is_usable(grip, frame)) {
        return "pole_half_length_m is " + with_unit(d, "m") +
               ", longer than the frame has room for; give the half length in meters, smaller than "
               "half the frame.";
    }
    return {};
}

} // namespace spidar
