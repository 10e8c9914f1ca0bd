#include "device/safety/monitors/shake_monitor.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "device/safety/monitors/pole_end_speed.h"

namespace spidar {

namespace {

// Swings in a series: four whole periods, more than a tap gives.
constexpr int kSwings = 8;
// Time in which the forces return once the grip is calm.
constexpr double kRecovery_s = 1.0;
constexpr double kLeastScale = 0.25;
// Slow parts that count as zero: of a grip at rest (m/s) and of a contact that was left (N).
constexpr double kStill = 1e-9;
// Time after which a swing no longer belongs to a series.
constexpr double kLongAgo_s = 0.15;

} // namespace

// Smallest swing: 1 mm peak to peak at 40 Hz, five times what a good rendering dithers; rubbing
// along three surfaces at once shows nearly as much and only feels rough. Longest half period: 8
// Hz; a light hand bounces off a wall no slower, and nobody shakes a grip as fast for long. Slow
// part: below 13 Hz.
constexpr ShakeMonitor::Kind ShakeMonitor::kSpeed{0.10, 0.060, 0.012};
// Smallest swing: ten times what a good wall dithers; a bad wall moves a firm hand by less than the
// limit above. Longest half period: 6.7 Hz, the slowest swing of a firm hand on a wall that is too
// stiff; no hand presses and leaves as often. Slow part: below 3 Hz.
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
