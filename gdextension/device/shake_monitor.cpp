#include "device/shake_monitor.h"

#include <algorithm>
#include <cmath>

#include "device/pole_end_speed.h"

namespace spidar {

namespace {

// A swing: 1 mm to and fro at 40 Hz, five times what a good rendering may dither. Rubbing along three surfaces at once
// shows nearly as much and is felt as rough, not as a danger.
constexpr double kSwing_m_s = 0.10;
// Half a period of 8 Hz: a light hand bounces off a wall so slowly; nobody shakes a grip as fast for long.
constexpr double kLongestHalfPeriod_s = 0.060;
// Four whole periods in a row: no tap swings so often.
constexpr int kSwings = 8;
// Time constant of what counts as the hand's own motion: a corner of 13 Hz.
constexpr double kHandMotion_s = 0.012;
// The forces come back to full within this, once the grip is calm.
constexpr double kRecovery_s = 1.0;
constexpr double kLeastScale = 0.25;
// Of a grip at rest: so little is nothing.
constexpr double kStill_m_s = 1e-9;
// A swing so long ago is no longer in a row.
constexpr double kLongAgo_s = 2.0 * kLongestHalfPeriod_s;

} // namespace

void ShakeMonitor::found(double swing_m_s) noexcept {
    swing_m_s_ = swing_m_s;
    unstable_ = unstable_ || scale_ <= kLeastScale;
    scale_ = std::max(kLeastScale, 0.5 * scale_);
    calm_s_ = 0.0;
}

void ShakeMonitor::update(const Twist &twist, bool rendering, double dt_s) noexcept {
    const DofArray speeds = pole_end_speeds(twist);
    const double gain = dt_s / (dt_s + kHandMotion_s);
    bool shaking = false;
    for (std::size_t k = 0; k < channels_.size(); ++k) {
        Channel &channel = channels_[k];
        channel.slow += gain * (speeds[k] - channel.slow);
        if (speeds[k] == 0.0 && std::abs(channel.slow) < kStill_m_s) {
            channel.slow = 0.0;
        }
        channel.since_s = std::min(kLongAgo_s, channel.since_s + dt_s);
        const double swing = speeds[k] - channel.slow;
        if (!(std::abs(swing) >= kSwing_m_s)) {
            continue;
        }
        const std::int8_t side = swing > 0.0 ? 1 : -1;
        channel.largest = std::max(channel.largest, std::abs(swing));
        if (side == channel.side) {
            continue;
        }
        const bool in_a_row = channel.since_s <= kLongestHalfPeriod_s;
        channel.count = in_a_row ? static_cast<std::uint8_t>(channel.count + 1) : std::uint8_t{0};
        channel.largest = in_a_row ? channel.largest : std::abs(swing);
        channel.side = side;
        channel.since_s = 0.0;
        if (channel.count >= kSwings) {
            shaking = true;
            swing_m_s_ = channel.largest;
            channel.count = 0;
        }
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

bool ShakeMonitor::settled() const noexcept {
    bool still = scale_ >= 1.0 && !unstable_;
    for (const Channel &channel : channels_) {
        still = still && channel.slow == 0.0 && channel.since_s >= kLongAgo_s;
    }
    return still;
}

} // namespace spidar
