#include "device/rendering/motion_filter.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "device/contract/dof_lanes.h"

namespace spidar {

namespace {

// Depth and width of the notch (damping ratios of its numerator and denominator). Wide, as the swing's
// frequency lies between 105 and 140 Hz in the seven DOF of the paper's device, and moves with the hand.
constexpr double kNotchDepth = 0.12;
constexpr double kNotchWidth = 1.0;
// Above this part of the rate a notch has no room below the Nyquist frequency.
constexpr double kHighestResonance = 0.4;
// Motion below these is far under an encoder count: set to rest, so that a grip at rest is exactly at rest.
constexpr double kRestMove = 1e-12;  // m, rad
constexpr double kRestSpeed = 1e-10; // m/s, rad/s

} // namespace

void MotionFilter::configure(const RenderSettings &settings, double rate_hz) noexcept {
    *this = MotionFilter();
    velocity_filter_ = OnePole(settings.velocity_cutoff_hz);
    lead_s_ = settings.delay_compensation_s;
    steady_lead_s_ = lead_s_;
    const double hz = settings.string_resonance_hz;
    if (!(hz > 0.0) || !(hz < kHighestResonance * rate_hz)) {
        return; // offset stays zero
    }
    // Bilinear transform, exact at the resonance: N(s) = (s^2 + 2 depth w s + w^2) / (s^2 + 2 width w s + w^2).
    const double w = 2.0 * std::numbers::pi * hz;
    const double c = w / std::tan(0.5 * w / rate_hz);
    const double a0 = c * c + 2.0 * kNotchWidth * w * c + w * w;
    const double b0 = (c * c + 2.0 * kNotchDepth * w * c + w * w) / a0;
    const double b2 = (c * c - 2.0 * kNotchDepth * w * c + w * w) / a0;
    a1_ = 2.0 * (w * w - c * c) / a0;
    a2_ = (c * c - 2.0 * kNotchWidth * w * c + w * w) / a0;
    // N - 1 has a zero at z = 1, which is divided out against the sum of the moves.
    c0_ = b0 - 1.0;
    c1_ = a2_ - b2;
    steady_lead_s_ +=
        (c0_ + c1_) / (1.0 + a1_ + a2_) / rate_hz; // offset of a steady move, per speed
}

void MotionFilter::reset() noexcept {
    moved_ = {};
    offset_ = {};
    last_offset_ = {};
    velocity_ = {};
    at_rest_ = true;
}

void MotionFilter::update(const Displacement &moved, double dt_s) noexcept {
    Lanes now{};
    std::ranges::copy(lanes(moved), now.begin());
    const double alpha = velocity_filter_.share(dt_s);
    const double per_s = 1.0 / dt_s;
    for (std::size_t i = 0; i < kLanes; ++i) {
        const double offset =
            c0_ * now[i] + c1_ * moved_[i] - a1_ * offset_[i] - a2_ * last_offset_[i];
        const double speed = (now[i] + offset - offset_[i]) * per_s;
        velocity_[i] += alpha * (speed - velocity_[i]);
        last_offset_[i] = offset_[i];
        offset_[i] = offset;
        moved_[i] = now[i];
    }
    bool moving = false;
    for (std::size_t i = 0; i < kLanes && !moving; ++i) {
        moving = std::abs(moved_[i]) > kRestMove || std::abs(offset_[i]) > kRestMove ||
                 std::abs(last_offset_[i]) > kRestMove || std::abs(velocity_[i]) > kRestSpeed;
    }
    at_rest_ = false;
    if (!moving) {
        reset();
    }
}

Displacement MotionFilter::ahead() const noexcept {
    DofLanes sum{};
    for (std::size_t i = 0; i < sum.size(); ++i) {
        sum[i] = offset_[i] + lead_s_ * velocity_[i];
    }
    return of_lanes<Displacement>(sum);
}

Twist MotionFilter::velocity() const noexcept {
    DofLanes row{};
    std::copy_n(velocity_.begin(), row.size(), row.begin());
    return of_lanes<Twist>(row);
}

} // namespace spidar
