#include "device/safety/monitors/workspace_guard.h"

#include <algorithm>

namespace spidar {

namespace {

// Soft: felt within a centimetre, passive in every hand without damping of its own.
constexpr double kWallStiffness_n_m = 300.0;
constexpr double kWallMost_n = 3.0;
// Smallest pivots (about sigma7 squared) between which the forces fade: of the paper's device, every pose that a
// hand takes has 0.05 and more; near singular poses are flagged at 0.0001.
constexpr double kFadeFromPivot = 0.01;
constexpr double kFadedPivot = 0.001;

} // namespace

void WorkspaceGuard::configure(const ServoSettings &settings) noexcept {
    low_m_ = settings.frame.motors_m[0];
    high_m_ = low_m_;
    for (const Vec3 &motor : settings.frame.motors_m) {
        for (int axis = 0; axis < 3; ++axis) {
            low_m_[axis] = std::min(low_m_[axis], motor[axis]);
            high_m_[axis] = std::max(high_m_[axis], motor[axis]);
        }
    }
    const double border_m = settings.grip.pole_half_length_m + settings.safety.workspace_margin_m;
    on_ = settings.safety.workspace_margin_m > 0.0;
    for (int axis = 0; axis < 3; ++axis) {
        const double middle = 0.5 * (low_m_[axis] + high_m_[axis]);
        const double half = std::max(0.0, 0.5 * (high_m_[axis] - low_m_[axis]) - border_m);
        low_m_[axis] = middle - half;
        high_m_[axis] = middle + half;
    }
}

Wrench WorkspaceGuard::wall(const GripState &grip) const noexcept {
    Wrench result;
    if (!on_) {
        return result;
    }
    const Vec3 &p = grip.pose.position_m;
    for (int axis = 0; axis < 3; ++axis) {
        const double inside = std::clamp(p[axis], low_m_[axis], high_m_[axis]);
        result.force_n[axis] =
            std::clamp(kWallStiffness_n_m * (inside - p[axis]), -kWallMost_n, kWallMost_n);
    }
    return result;
}

double WorkspaceGuard::scale(const GripState &grip) noexcept {
    if (grip.conditioning >= kFadeFromPivot) {
        return 1.0;
    }
    const double scale = (grip.conditioning - kFadedPivot) / (kFadeFromPivot - kFadedPivot);
    return scale >= 0.0 ? std::min(1.0, scale) : 0.0; // NaN: 0
}

double WorkspaceGuard::beyond_m(const GripState &grip) const noexcept {
    double most_m = 0.0;
    const Vec3 &p = grip.pose.position_m;
    for (int axis = 0; on_ && axis < 3; ++axis) {
        most_m = std::max({most_m, low_m_[axis] - p[axis], p[axis] - high_m_[axis]});
    }
    return most_m;
}

} // namespace spidar
