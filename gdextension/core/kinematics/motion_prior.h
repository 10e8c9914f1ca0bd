// How far the measured lengths are trusted, and where the grip is expected: what a warm tick adds to its least squares,
//   minimise sum_i (l_i - l_i(pose))^2 + weight |pose - expected pose|^2,
// so that a direction that the strings determine badly is held by the motion, and one that they determine well follows
// the strings. weight = (sigma of a length / sigma of the motion)^2, with the first taken from the recent residual: exact
// lengths make it zero.
#pragma once

#include <cmath>

#include "core/base/sound_state.h"
#include "core/kinematics/steps/crossed_step.h"

namespace spidar {

class MotionPrior {
public:
    // What the expected pose may miss in a tick beyond what the lengths say. Of 1 to 20 mm this is the largest that holds
    // the pose of strings that err by +-5 mm to less than 1 mm a tick beyond the hand's motion.
    static constexpr double kMotionSigma_m = 3e-3;
    // Below this weight, a residual of 0.03 mm, the lengths alone decide.
    static constexpr double kLeastWeight = 1e-3;
    // And this is the largest weight, of a residual of 3.3 mm: more is no calibration but a fault, and the
    // pose must not stand still for it.
    static constexpr double kMostWeight = 10.0;
    // The level rises to a larger residual in 20 ticks and falls in 1000: the one redundant length shows nothing of the
    // other errors where its own passes through zero.
    static constexpr double kRise = 0.05;
    static constexpr double kFall = 0.001;
    // Of the newest movement in the mean one: 20 ticks, in which a hand keeps its speed.
    static constexpr double kNewest = 0.05;

    void restart() noexcept { *this = MotionPrior(); }
    void forget_motion() noexcept {
        change_ = CrossedPose();
        moving_ = false;
    }

    // A pose was found anew, with these length errors.
    void begin(double sum_of_squares_m2) noexcept {
        restart();
        variance_m2_ = sum_of_squares_m2;
    }
    // Once a tick. sum_of_squares_m2: of the length errors at the pose found. change: from the pose before.
    void learn(double sum_of_squares_m2, const CrossedPose &change) noexcept {
        const double off_m2 = sum_of_squares_m2 - variance_m2_;
        variance_m2_ += (off_m2 > 0.0 ? kRise : kFall) * off_m2;
        if (!moving_) { // the first difference leads from a pose of other lengths
            moving_ = true;
            return;
        }
        const Lanes share = both(kNewest);
        change_.position_m = change_.position_m + share * (change.position_m - change_.position_m);
        change_.poles_m = change_.poles_m + share * (change.poles_m - change_.poles_m);
    }

    // 0 when the lengths alone decide.
    [[nodiscard]] double weight() const noexcept {
        const double weight = variance_m2_ * (1.0 / (kMotionSigma_m * kMotionSigma_m));
        return weight < kLeastWeight ? 0.0 : weight < kMostWeight ? weight : kMostWeight;
    }
    // The recent level of the residual over all eight lengths, which is about the standard deviation of one (unit: m).
    [[nodiscard]] double length_sigma_m() const noexcept { return std::sqrt(variance_m2_); }
    // The movement that the next tick is expected to make.
    [[nodiscard]] const CrossedPose &expected_change() const noexcept { return change_; }
    // core/base/sound_state.h
    [[nodiscard]] bool is_sound() const noexcept { return are_flags(moving_); }

private:
    double variance_m2_ = 0.0;
    CrossedPose change_{};
    bool moving_ = false;
};

} // namespace spidar
