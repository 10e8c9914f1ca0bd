#include "device/tracking/grip_tracker.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "core/geometry/rotation_log.h"
#include "device/contract/grip_points.h"

namespace spidar {

namespace {

// Far under what an encoder count in a second is (m/s, rad/s).
constexpr double kRest = 1e-10;

} // namespace

Status GripTracker::configure(const ServoSettings &settings) noexcept {
    ForwardKinematics kinematics;
    const Status status = kinematics.configure(settings.frame, settings.grip);
    if (!usable(status)) {
        return status;
    }
    *this = GripTracker();
    kinematics_ = kinematics;
    lengths_of_.configure(settings.strings, settings.corrections);
    twist_filter_ = OnePole(settings.velocity_cutoff_hz);
    grip_.pose = rest_pose(settings.grip);
    grip_.frame = frame_of(grip_.pose, Mat3(1.0));
    return Status::ok;
}

void GripTracker::restart() noexcept {
    kinematics_.reset();
    has_pose_ = false;
    solved_ = false;
    since_pose_s_ = 0.0;
    moved_ = Displacement();
    grip_.twist = Twist();
    grip_.status = Status::held_last_pose;
}

void GripTracker::set_zero(const CountArray &counts) noexcept {
    lengths_of_.set_zero(counts);
    restart();
}

void GripTracker::filter_twist(const Twist &raw, double dt_s) noexcept {
    const double alpha = twist_filter_.share(dt_s);
    Twist &twist = grip_.twist;
    twist.linear_m_s += alpha * (raw.linear_m_s - twist.linear_m_s);
    twist.angular_rad_s += alpha * (raw.angular_rad_s - twist.angular_rad_s);
    twist.grasp_rate_rad_s += alpha * (raw.grasp_rate_rad_s - twist.grasp_rate_rad_s);
}

// The pose did not change: the twist falls to exactly nothing.
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
    }
}

bool GripTracker::at_rest() const noexcept {
    const Twist &twist = grip_.twist;
    return twist.linear_m_s == Vec3(0.0) && twist.angular_rad_s == Vec3(0.0) &&
           twist.grasp_rate_rad_s == 0.0;
}

GripTracker::Update GripTracker::update(const CountArray &counts, bool unchanged,
                                        const StringArray &tensions_n, double dt_s) noexcept {
    Update result;
    moved_ = Displacement();
    const bool stretches = lengths_of_.follow(tensions_n, dt_s);
    if (unchanged && solved_ && !stretches) {
        result.skipped = true;
        since_pose_s_ = 0.0;
        grip_.status = solved_status_;
        come_to_rest(dt_s);
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
    const double elapsed_s = since_pose_s_ + dt_s;
    since_pose_s_ = 0.0;
    const GripFrame frame = frame_of(solution.pose, grip_.frame.rotation);
    if (!has_pose_) {
        grip_.twist = Twist();
    } else if (solution.cold_start) {
        filter_twist(grip_.twist, dt_s); // found anew, not moved: a difference would be no velocity
    } else {
        Twist raw;
        raw.linear_m_s = (solution.pose.position_m - grip_.pose.position_m) / elapsed_s;
        raw.angular_rad_s =
            rotation_log(frame.rotation * glm::transpose(grip_.frame.rotation)) / elapsed_s;
        raw.grasp_rate_rad_s = (frame.grasp_angle_rad - grip_.frame.grasp_angle_rad) / elapsed_s;
        filter_twist(raw, dt_s);
        moved_ = {elapsed_s * raw.linear_m_s, elapsed_s * raw.angular_rad_s,
                  elapsed_s * raw.grasp_rate_rad_s};
    }
    grip_.pose = solution.pose;
    grip_.frame = frame;
    grip_.status = solution.status;
    solved_status_ = solution.status;
    has_pose_ = true;
    solved_ = true;
    result.moved = true;
    return result;
}

void GripTracker::hold(Status why, double dt_s, bool stale) noexcept {
    since_pose_s_ += dt_s;
    moved_ = Displacement();
    grip_.status = why;
    if (stale) {
        filter_twist(Twist(), dt_s);
    }
}

double GripTracker::fastest_point_m_s() const noexcept {
    // Both ends of a pole at once: |v + c| and |v - c|, c what its turning adds.
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
