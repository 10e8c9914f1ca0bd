#include "device/rendering/motion_filter.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "device/contract/dof_lanes.h"

namespace spidar {

namespace {

// Depth and width of the notch (damping ratios of its numerator and denominator). Wide, since the
// resonance lies between 105 and 140 Hz in the seven DOF of the paper's device and moves with the
// hand.
constexpr double kNotchDepth = 0.12;
constexpr double kNotchWidth = 1.0;
// Largest resonance relative to the rate: above it a notch has no room below the Nyquist frequency.
constexpr double kHighestResonance = 0.4;
// Motion that counts as rest, far below an encoder count, so that a grip at rest is exactly at
// rest.
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
    // N(s) - 1, with N(s) = (s^2 + 2 depth w s + w^2) / (s^2 + 2 width w s + w^2).
    w_ = 2.0 * std::numbers::pi * hz;
    depth_ = 2.0 * (kNotchWidth - kNotchDepth) * w_;
    warp_ = std::tan(0.5 * w_ / rate_hz) / (0.5 * w_ / rate_hz);
    steady_lead_s_ -= depth_ / (w_ * w_ * warp_); // offset of a steady move, per speed
}

void MotionFilter::reset() noexcept {
    offset_ = {};
    offset_rate_ = {};
    velocity_ = {};
    at_rest_ = true;
}

void MotionFilter::update(const Displacement &moved, double dt_s) noexcept {
    Lanes now{};
    std::ranges::copy(lanes(moved), now.begin());
    const double alpha = velocity_filter_.share(dt_s);
    const double per_s = 1.0 / dt_s;
    // The trapezoidal rule over this cycle of any length. rates: sum of the rates before and after.
    const double half_s = 0.5 * warp_ * dt_s;
    const double pull = 2.0 * half_s * w_ * w_;
    const double share = 1.0 / (1.0 + 2.0 * kNotchWidth * w_ * half_s + w_ * w_ * half_s * half_s);
    for (std::size_t i = 0; i < kLanes; ++i) {
        const double rates = share * (2.0 * offset_rate_[i] - pull * offset_[i] - depth_ * now[i]);
        const double change = half_s * rates;
        velocity_[i] += alpha * ((now[i] + change) * per_s - velocity_[i]);
        offset_[i] += change;
        offset_rate_[i] = rates - offset_rate_[i];
    }
    bool moving = false;
    for (std::size_t i = 0; i < kLanes && !moving; ++i) {
        moving = std::abs(now[i]) > kRestMove || std::abs(offset_[i]) > kRestMove ||
                 std::abs(offset_rate_[i]) > kRestSpeed || std::abs(velocity_[i]) > kRestSpeed;
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
