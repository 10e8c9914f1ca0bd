// What the warm tick of both kinds of steps goes by: the limits at which a step or a residual is not believed, and the
// arithmetic of movements.
#pragma once

#include "core/kinematics/forward_kinematics.h"

namespace spidar::tracking {

// Nearer to a z face than this, a 25th of an encoder count, a pole and its mirror image have the same lengths to rounding.
inline constexpr double kFaceMargin_m = 1e-6;
// No string is longer: the diagonal of the largest frame is 35 m.
inline constexpr double kLongestString_m = 40.0;
// After the steps of a warm tick a residual above this asks for a cold start, unless lengths have erred before. Calibrated
// strings err by less, and the redundant eighth length shows only a third of the error of one string.
inline constexpr double kWarmResidualGate_m = 1e-3;
// A search ends at the remembered pose where the lengths fit it to this, less than an encoder count. Else the others are
// looked at too, and must fit 50 times better: next to it a wrong branch may fit to a millimetre.
inline constexpr double kContentResidual_m = 2e-5;
// A residual this many times its recent level is no usual one.
inline constexpr double kUnusual = 3.0;
// Lengths that err by sigma move the foreseen pose by up to this many sigma in a tick, near badly determined poses.
inline constexpr double kNoiseReach = 4.0;
// With errors a second step of less than this share of the first still settles.
inline constexpr double kSettlingShare = 0.5;
// Motion within one tick above which Gauss-Newton alone is not trusted: 5 m/s at 1 kHz.
inline constexpr double kMaxWarmStep_m = 5e-3;
// Up to this the last pose is still trusted to lead to the right answer of several, if that fits: strings that err by
// millimetres move the pole ends so far in a tick. Beyond, it competes with the closed form.
inline constexpr double kTrustedStep_m = 0.02;
// The second step of a warm tick is quadratically smaller than the first; above this it did not settle.
inline constexpr double kMaxSecondStep_m = 5e-4;
// Above this it leaves more than 10 nm, and a third is taken: movements of more than a millimetre within a tick that were
// not foreseen, or samples lost.
inline constexpr double kThirdStep_m = 2e-5;
// Motion within one tick after which the last pose says nothing (device restarted, samples lost).
inline constexpr double kForgetStep_m = 0.05;
// Below this smallest scaled pivot the lengths leave a direction open to the square root of rounding: the pose is refused.
inline constexpr double kRankDeficientPivot = 1e-12;
// A warm tick is done when the error it leaves is below this or below kTrackingShare of the residual.
inline constexpr double kTrackingFloor_m = 1e-12;
// A higher order of extrapolation is used when its squared miss was this much smaller.
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

// The pose one change on. Poles back on their spheres to second order: a start needs no more.
inline CrossedPose one_change_on(const CrossedPose &pose, const CrossedPose &change,
                                 double d) noexcept {
    const LaneVec poles = pose.poles_m + change.poles_m;
    const Lanes excess = dot(poles, poles) * both(1.0 / (d * d)) - both(1.0);
    const Lanes scale = both(1.0) + excess * (both(0.375) * excess - both(0.5));
    return {pose.position_m + change.position_m, scale * poles};
}

} // namespace spidar::tracking
