#include "device/tracking/grip_tracker.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "core/geometry/rotation_log.h"
#include "device/contract/grip_points.h"

namespace spidar {

namespace {

// Speed that counts as zero (m/s, rad/s), far below an encoder count per second.
constexpr double kRest = 1e-10;
// Cut-off of the carrier, relative to that of the twist. Higher values pass the noise of counts,
// lower ones lag when the hand turns back.
constexpr double kCarrierCutoff = 2.5;
constexpr double kHalfPi = 0.5 * std::numbers::pi;

void approach(Twist &twist, const Twist &raw, double share) noexcept {
    twist.linear_m_s += share * (raw.linear_m_s - twist.linear_m_s);
    twist.angular_rad_s += share * (raw.angular_rad_s - twist.angular_rad_s);
    twist.grasp_rate_rad_s += share * (raw.grasp_rate_rad_s - twist.grasp_rate_rad_s);
}

Displacement between(const GripPose &from_pose, const GripFrame &from, const GripPose &to_pose,
                     const GripFrame &to) noexcept {
    return {to_pose.position_m - from_pose.position_m,
            rotation_log(to.rotation * glm::transpose(from.rotation)),
            to.grasp_angle_rad - from.grasp_angle_rad};
}

} // namespace

Status GripTracker::configure(const ServoSettings &settings) noexcept {
    ForwardKinematics kinematics;
    const Status status = kinematics.configure(settings.frame, settings.grip);
    if (!usable(status)) {
        return status;
    }
    *this = GripTracker();
    kinematics_ = kinematics;
    geometry_ = settings.grip;
    lengths_of_.configure(settings.strings, settings.corrections);
    twist_filter_ = OnePole(settings.velocity_cutoff_hz);
    carrier_filter_ = OnePole(kCarrierCutoff * settings.velocity_cutoff_hz);
    grip_.pose = rest_pose(settings.grip);
    grip_.frame = frame_of(grip_.pose, Mat3(1.0));
    measured_ = grip_.pose;
    measured_frame_ = grip_.frame;
    return Status::ok;
}

void GripTracker::restart() noexcept {
    kinematics_.reset();
    has_pose_ = false;
    solved_ = false;
    moved_ = Displacement();
    carried_ = false;
    grip_.twist = Twist();
    carrier_ = Twist();
    grip_.status = Status::held_last_pose;
}

void GripTracker::set_zero(const CountArray &counts) noexcept {
    lengths_of_.set_zero(counts);
    restart();
}

void GripTracker::filter_twist(const Twist &raw, double dt_s) noexcept {
    approach(grip_.twist, raw, twist_filter_.share(dt_s));
    approach(carrier_, raw, carrier_filter_.share(dt_s));
}

// The pose did not change: the twist falls to exactly zero.
void GripTracker::come_to_rest(double dt_s) noexcept {
    if (at_rest()) {
        return;
    }
    filter_twist(Twist(), dt_s);
    const Twist &twist = grip_.twist;
    const auto rests = [](const Vec3 &v) {
        return std::abs(v.x) <= kRest && std::abs(v.y) <= kRest && std::abs(v.z) <= kRest;
    };
    if (rests(twist.linear_m_s) && rests(twist.angular_rad_s) &&
        std::abs(twist.grasp_rate_rad_s) <= kRest) {
        grip_.twist = Twist();
        carrier_ = Twist();
        carrier_ = Twist();
    }
}

bool GripTracker::at_rest() const noexcept {
    const Twist &twist = grip_.twist;
    return twist.linear_m_s == Vec3(0.0) && twist.angular_rad_s == Vec3(0.0) &&
           twist.grasp_rate_rad_s == 0.0 && kinematics_.settled();
}

void GripTracker::carry_on(double time_s) noexcept {
    const Twist &twist = carrier_;
    GripFrame &frame = grip_.frame;
    const Vec3 position_m = grip_.pose.position_m + time_s * twist.linear_m_s;
    frame.rotation = rotation_exp(time_s * twist.angular_rad_s) * frame.rotation;
    if (geometry_.kind == GripKind::crossed) { // not beyond parallel poles
        frame.grasp_angle_rad =
            std::clamp(frame.grasp_angle_rad + time_s * twist.grasp_rate_rad_s, -kHalfPi, kHalfPi);
        frame.crossing_angle_rad = kHalfPi - frame.grasp_angle_rad;
    }
    grip_.pose = make_pose(geometry_, position_m, frame.rotation, frame.grasp_angle_rad);
    carried_ = true;
}

void GripTracker::place(double age_s) noexcept {
    grip_.pose = measured_;
    grip_.frame = measured_frame_;
    carried_ = false;
    if (age_s > 0.0 && !at_rest()) {
        carry_on(age_s);
    }
}

GripTracker::Update GripTracker::update(const CountArray &counts, bool unchanged,
                                        const StringArray &tensions_n, const Made &made) noexcept {
    Update result;
    moved_ = Displacement();
    const bool stretches = lengths_of_.follow(tensions_n, made.after_s);
    const bool was_carried = carried_;
    const GripPose pose_before = grip_.pose;
    const GripFrame frame_before = grip_.frame;
    if (unchanged && solved_ && !stretches && kinematics_.settled()) {
        result.skipped = true;
        grip_.status = solved_status_;
        come_to_rest(made.after_s);
        place(made.age_s);
        result.moved = was_carried || carried_;
        if (result.moved) {
            moved_ = between(pose_before, frame_before, grip_.pose, grip_.frame);
        }
        return result;
    }
    const StringArray lengths_m = lengths_of_.lengths(counts);
    const KinematicsResult solution = kinematics_.update(lengths_m);
    result.status = solution.status;
    result.cold_start = solution.cold_start;
    grip_.residual_rms_m = solution.residual_rms_m;
    grip_.conditioning = solution.conditioning;
    if (!usable(solution.status) || solution.status == Status::held_last_pose) {
        solved_ = false;
        result.status = usable(solution.status) ? Status::impossible_lengths : solution.status;
        return result;
    }
    lengths_m_ = lengths_m;
    const double elapsed_s = made.after_s;
    const GripFrame frame = frame_of(solution.pose, measured_frame_.rotation);
    const bool found_anew = !has_pose_ || solution.cold_start;
    if (!has_pose_) {
        grip_.twist = Twist();
        carrier_ = Twist();
    } else if (!solution.cold_start) { // the difference to a pose from a search is not a velocity
        const Displacement step = between(measured_, measured_frame_, solution.pose, frame);
        filter_twist(
            {step.linear_m / elapsed_s, step.angular_rad / elapsed_s, step.grasp_rad / elapsed_s},
            elapsed_s);
        moved_ = step;
    }
    measured_ = solution.pose;
    measured_frame_ = frame;
    place(made.age_s);
    if (found_anew) {
        moved_ = Displacement();
    } else if (was_carried || carried_) {
        moved_ = between(pose_before, frame_before, grip_.pose, grip_.frame);
    }
    grip_.status = solution.status;
    solved_status_ = solution.status;
    has_pose_ = true;
    solved_ = true;
    result.moved = true;
    return result;
}

bool GripTracker::hold(Status why, double dt_s, bool stale) noexcept {
    moved_ = Displacement();
    grip_.status = why;
    if (stale) {
        filter_twist(Twist(), dt_s);
    }
    if (!has_pose_ || at_rest()) {
        return false;
    }
    const GripPose pose_before = grip_.pose;
    const GripFrame frame_before = grip_.frame;
    carry_on(dt_s);
    moved_ = between(pose_before, frame_before, grip_.pose, grip_.frame);
    return true;
}

double GripTracker::fastest_point_m_s() const noexcept {
    // Both ends of a pole at once: |v + c| and |v - c|, where c is the velocity by turning.
    const Vec3 &v = grip_.twist.linear_m_s;
    const auto ends_square = [&](ContactTarget end) {
        const Vec3 c = grip_point_velocity(grip_, end) - v;
        return glm::dot(c, c) + 2.0 * std::abs(glm::dot(v, c));
    };
    const double pole1 = ends_square(ContactTarget::pole1_plus);
    const double pole2 = ends_square(ContactTarget::pole2_plus);
    return std::sqrt(glm::dot(v, v) + std::max(pole1, pole2));
}

} // namespace spidar
