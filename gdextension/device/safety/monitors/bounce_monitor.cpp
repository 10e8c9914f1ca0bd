#include "device/safety/monitors/bounce_monitor.h"

#include <cmath>

#include "device/safety/monitors/pole_end_speed.h"

namespace spidar {

namespace {

// Smallest push that counts as a touch.
constexpr double kLeastPush_n = 0.02;
// Longest touch that counts: a longer one is the hand's own push, which may leave at any speed.
constexpr double kLongestTouch_s = 0.080;
// Smallest speed that counts: slower bounces feel rough at most.
constexpr double kLeastSpeed_m_s = 0.06;
// Ratio of leaving to arrival speed that counts: slightly more than the filter of the twist can
// make of a lossless bounce.
constexpr double kGain = 1.1;
// Bounces in a series, and the longest time between them. Tapping cannot cause a series, since a
// tap leaves slower than it came.
constexpr int kBounces = 3;
constexpr double kLongestPause_s = 0.4;

double dot(const DofLanes &a, const DofLanes &b) noexcept {
    double sum = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        sum += a[i] * b[i];
    }
    return sum;
}

} // namespace

bool BounceMonitor::update(const Twist &twist, const Wrench &push, double dt_s) noexcept {
    since_s_ += dt_s;
    const DofLanes speed = pole_end_speeds(twist);
    const DofLanes force =
        lanes(push.force_n, push.moment_nm / kRotationArm_m, push.grasp_torque_nm / kGraspArm_m);
    const bool touches = dot(force, force) > kLeastPush_n * kLeastPush_n; // false for NaN
    if (touches) {
        if (!touching_) {
            touching_ = true;
            arrival_m_s_ = speed;
            impulse_ns_ = {};
            touched_s_ = 0.0;
        }
        touched_s_ += dt_s;
        for (std::size_t i = 0; i < force.size(); ++i) {
            impulse_ns_[i] += dt_s * force[i];
        }
        return false;
    }
    if (!touching_) {
        row_ = since_s_ > kLongestPause_s ? 0 : row_; // the last bounce is too long ago
        return false;
    }
    touching_ = false;
    const double size = std::sqrt(dot(impulse_ns_, impulse_ns_));
    const double came_m_s = -dot(arrival_m_s_, impulse_ns_) / size;
    const double left_m_s = dot(speed, impulse_ns_) / size;
    const bool thrown = touched_s_ <= kLongestTouch_s && came_m_s > 0.0 &&
                        left_m_s >= kLeastSpeed_m_s && left_m_s > kGain * came_m_s;
    row_ = !thrown ? 0 : since_s_ <= kLongestPause_s ? row_ + 1 : 1;
    since_s_ = 0.0;
    if (row_ < kBounces) {
        return false;
    }
    row_ = 0;
    speed_m_s_ = left_m_s;
    return true;
}

} // namespace spidar
