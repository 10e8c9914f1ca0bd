#include "device/safety/monitors/workspace_guard.h"

#include <algorithm>

namespace spidar {

namespace {

// Stiffness of the wall: felt within a centimeter, passive in every hand without damping.
constexpr double kWallStiffness_n_m = 300.0;
constexpr double kWallMost_n = 3.0;
// Smallest pivots (about sigma7 squared) between which the forces fade. Poses that a hand takes
// with the paper's device have at least 0.05; near-singular poses are flagged at 0.0001.
constexpr double kFadeFromPivot = 0.01;
constexpr double kFadedPivot = 0.001;

} // namespace

void WorkspaceGuard::configure(const ServoSettings &settings) noexcept {
    const double border_m = settings.grip.pole_half_length_m + settings.safety.workspace_margin_m;
    free_ = reach_box(settings.frame, border_m);
    on_ = settings.safety.workspace_margin_m > 0.0;
}

Wrench WorkspaceGuard::wall(const GripState &grip) const noexcept {
    Wrench result;
    if (!on_) {
        return result;
    }
    const Vec3 &p = grip.pose.position_m;
    for (int axis = 0; axis < 3; ++axis) {
        const double inside = std::clamp(p[axis], free_.low_m[axis], free_.high_m[axis]);
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
        most_m = std::max({most_m, free_.low_m[axis] - p[axis], p[axis] - free_.high_m[axis]});
    }
    return most_m;
}

} // namespace spidar
