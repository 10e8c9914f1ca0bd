#include "device/safety/monitors/shake_monitor.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "device/safety/monitors/pole_end_speed.h"

namespace spidar {

namespace {

// Four whole periods in a row: no tap swings so often.
constexpr int kSwings = 8;
// The forces come back to full within this, once the grip is calm.
constexpr double kRecovery_s = 1.0;
constexpr double kLeastScale = 0.25;
// Of a grip at rest (m/s), of a contact left (N): so little is nothing.
constexpr double kStill = 1e-9;
// A swing so long ago is no longer in a row.
constexpr double kLongAgo_s = 0.15;

} // namespace

// Least: 1 mm to and fro at 40 Hz, five times what a good rendering may dither; rubbing along three surfaces at once shows
// nearly as much and is felt as rough, not as a danger. Longest half: of 8 Hz; a light hand bounces off a wall so slowly,
// and nobody shakes a grip as fast for long. Slow: a corner of 13 Hz.
constexpr ShakeMonitor::Kind ShakeMonitor::kSpeed{0.10, 0.060, 0.012};
// Least: ten times what a good wall dithers; a firm hand lets a bad one move it by less than the above. Longest half: of
// 6.7 Hz; so slowly swings a firm hand on what is too stiff, and no hand presses and leaves as often. Slow: 3 Hz.
constexpr ShakeMonitor::Kind ShakeMonitor::kPush{2.0, 0.075, 0.050};

void ShakeMonitor::found(double swing_m_s) noexcept {
    swing_m_s_ = swing_m_s;
    unstable_ = unstable_ || scale_ <= kLeastScale;
    scale_ = std::max(kLeastScale, 0.5 * scale_);
    calm_s_ = 0.0;
}

bool ShakeMonitor::Channel::update(double value, const Kind &kind, double dt_s) noexcept {
    slow += dt_s / (dt_s + kind.slow_s) * (value - slow);
    if (value == 0.0 && std::abs(slow) < kStill) {
        slow = 0.0;
    }
    since_s = std::min(kLongAgo_s, since_s + dt_s);
    const double swing = value - slow;
    if (!(std::abs(swing) >= kind.least)) {
        return false;
    }
    const std::int8_t now = swing > 0.0 ? 1 : -1;
    largest = std::max(largest, std::abs(swing));
    if (now == side) {
        return false;
    }
    const bool in_a_row = since_s <= kind.longest_half_s;
    count = in_a_row ? static_cast<std::uint8_t>(count + 1) : std::uint8_t{0};
    largest = in_a_row ? largest : std::abs(swing);
    side = now;
    since_s = 0.0;
    if (count < kSwings) {
        return false;
    }
    count = 0;
    return true;
}

bool ShakeMonitor::Channel::at_rest() const noexcept {
    return slow == 0.0 && since_s >= kLongAgo_s;
}

void ShakeMonitor::update(const Twist &twist, const Wrench &push, bool rendering,
                          double dt_s) noexcept {
    const DofLanes speeds = pole_end_speeds(twist);
    bool shaking = false;
    for (std::size_t k = 0; k < speeds_.size(); ++k) {
        if (speeds_[k].update(speeds[k], kSpeed, dt_s)) {
            shaking = true;
            swing_m_s_ = speeds_[k].largest;
        }
    }
    const double push_n = glm::length(push.force_n);
    if ((push_n > 0.0 || !push_.at_rest()) && push_.update(push_n, kPush, dt_s)) {
        shaking = true;
        swing_m_s_ = glm::length(twist.linear_m_s);
    }
    if (shaking && rendering) {
        found(swing_m_s_);
        return;
    }
    calm_s_ += dt_s;
    if (calm_s_ >= kCalm_s && scale_ < 1.0) {
        scale_ = std::min(1.0, scale_ + dt_s / kRecovery_s);
        unstable_ = false;
    }
}

bool ShakeMonitor::at_rest() const noexcept {
    bool still = scale_ >= 1.0 && !unstable_ && push_.at_rest();
    for (const Channel &channel : speeds_) {
        still = still && channel.at_rest();
    }
    return still;
}

} // namespace spidar
