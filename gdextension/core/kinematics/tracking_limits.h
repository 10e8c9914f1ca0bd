// Limits of a warm tick, for the fast steps (crossed_step.h) and the general steps
// (gauss_newton.h), and arithmetic of pose changes.
#pragma once

#include "core/kinematics/forward_kinematics.h"

namespace spidar::tracking {

// Smallest distance of P0 from a z face of the frame, a 25th of an encoder count. Below it a pole
// and its mirror image have equal lengths up to rounding.
inline constexpr double kFaceMargin_m = 1e-6;
// Longest string that is accepted: the diagonal of the largest frame is 35 m.
inline constexpr double kLongestString_m = 40.0;
// Residual of a warm tick above which a search runs, unless such a residual is usual for these
// lengths. Calibrated strings err by less; the redundant eighth length shows only a third of the
// error of one string.
inline constexpr double kWarmResidualGate_m = 1e-3;
// Residual, less than an encoder count, up to which a search accepts the remembered pose without
// trying others. Above it another pose must fit 50 times better (twice as well above 2 mm), since a
// wrong pose may fit to a millimeter.
inline constexpr double kContentResidual_m = 2e-5;
// A residual above this many times its recent level leads to a search.
inline constexpr double kUnusual = 3.0;
// Near badly determined poses, lengths that err by sigma move the predicted pose by up to this many
// sigma per tick.
inline constexpr double kNoiseReach = 4.0;
// For lengths with errors, a second step below this share of the first counts as convergence.
inline constexpr double kSettlingShare = 0.5;
// Largest motion in one tick for which Gauss-Newton alone is trusted: 5 m/s at 1 kHz.
inline constexpr double kMaxWarmStep_m = 5e-3;
// Largest motion in one tick after which the last pose, if it fits, is still used to select the
// right root. Strings that err by millimeters move the pole ends this far in a tick. Beyond it the
// closed form is tried too.
inline constexpr double kTrustedStep_m = 0.02;
// Largest second step of a warm tick. The second step is quadratically smaller than the first; a
// larger one means no convergence.
inline constexpr double kMaxSecondStep_m = 5e-4;
// Second step above which a third is taken, since more than 10 nm of error would remain. This
// happens for unpredicted movements of more than a millimeter per tick, and after lost samples.
inline constexpr double kThirdStep_m = 2e-5;
// Motion in one tick beyond which the last pose is forgotten (device restarted, samples lost).
inline constexpr double kForgetStep_m = 0.05;
// Smallest scaled pivot of an accepted pose: below it the lengths do not determine some direction.
inline constexpr double kRankDeficientPivot = 1e-12;
// Error that a warm tick may leave without another step. The fast steps add kTrackingShare of the
// residual to it. The general steps use only that share for lengths with errors, and only this
// value for other lengths.
inline constexpr double kTrackingFloor_m = 1e-12;
// A higher order of extrapolation is used if its squared error in the last tick was below this
// share of that of the next lower order.
inline constexpr double kForeseenShare = 0.25;

inline CrossedPose minus(const CrossedPose &a, const CrossedPose &b) noexcept {
    return {a.position_m - b.position_m, a.poles_m - b.poles_m};
}

inline double sum_of_squares(const KinematicsResult &result) noexcept {
    return kStringCount * result.residual_rms_m * result.residual_rms_m;
}

inline double squared(const CrossedPose &change) noexcept {
    return dot(change.position_m, change.position_m)[0] +
           sum_of(dot(change.poles_m, change.poles_m));
}

// Returns the pose after one more change. The poles keep their length to second order.
inline CrossedPose one_change_on(const CrossedPose &pose, const CrossedPose &change,
                                 double d) noexcept {
    const LaneVec poles = pose.poles_m + change.poles_m;
    const Lanes excess = dot(poles, poles) * both(1.0 / (d * d)) - both(1.0);
    const Lanes scale = both(1.0) + excess * (both(0.375) * excess - both(0.5));
    return {pose.position_m + change.position_m, scale * poles};
}

} // namespace spidar::tracking
