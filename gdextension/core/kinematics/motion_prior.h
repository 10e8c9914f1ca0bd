// Weight of the predicted motion against the measured lengths. A warm tick minimizes
//   sum_i (l_i - l_i(pose))^2 + weight |pose - expected pose|^2,
// so that the expected pose decides the directions that the strings determine badly, and the
// strings decide the others. weight = (sigma of a length / sigma of the motion)^2, where the recent
// residual gives the first sigma. Exact lengths give weight 0.
#pragma once

#include <cmath>

#include "core/base/sound_state.h"
#include "core/kinematics/steps/crossed_step.h"

namespace spidar {

class MotionPrior {
public:
    // Standard deviation of the error of the expected pose, per tick. Of the values tried (1 to 20
    // mm) it is the largest that keeps the pose within 1 mm per tick of the hand's motion for
    // strings that err by 5 mm.
    static constexpr double kMotionSigma_m = 3e-3;
    // Smallest weight that is used (a residual of 0.03 mm); below it the lengths alone decide.
    static constexpr double kLeastWeight = 1e-3;
    // Largest weight (a residual of 3.3 mm): a larger residual is a fault, and a larger weight
    // would hold the pose back.
    static constexpr double kMostWeight = 10.0;
    // Share of the difference by which the residual level rises in a tick: a time constant of 20
    // ticks.
    static constexpr double kRise = 0.05;
    // Share of the difference by which the residual level falls in a tick: a time constant of 1000
    // ticks. It is slow because the one redundant length shows no errors while its own error passes
    // through zero.
    static constexpr double kFall = 0.001;
    // Share of the newest movement in the mean movement: a time constant of 20 ticks, in which a
    // hand keeps its speed.
    static constexpr double kNewest = 0.05;

    void restart() noexcept { *this = MotionPrior(); }
    void forget_motion() noexcept {
        change_ = CrossedPose();
        moving_ = false;
    }

    // Restarts after a search. sum_of_squares_m2: squared length errors at the pose that it found.
    void begin(double sum_of_squares_m2) noexcept {
        restart();
        variance_m2_ = sum_of_squares_m2;
    }
    // Learns from one tick. sum_of_squares_m2: squared length errors at the found pose. change:
    // from the previous pose.
    void learn(double sum_of_squares_m2, const CrossedPose &change) noexcept {
        const double off_m2 = sum_of_squares_m2 - variance_m2_;
        variance_m2_ += (off_m2 > 0.0 ? kRise : kFall) * off_m2;
        if (!moving_) { // the first difference starts at the pose of a search
            moving_ = true;
            return;
        }
        const Lanes share = both(kNewest);
        change_.position_m = change_.position_m + share * (change.position_m - change_.position_m);
        change_.poles_m = change_.poles_m + share * (change.poles_m - change_.poles_m);
    }

    // Weight of the expected pose; 0 when the lengths alone decide.
    [[nodiscard]] double weight() const noexcept {
        const double weight = variance_m2_ * (1.0 / (kMotionSigma_m * kMotionSigma_m));
        return weight < kLeastWeight ? 0.0 : weight < kMostWeight ? weight : kMostWeight;
    }
    // Recent level of the residual over all eight lengths, about the standard deviation of one
    // length (unit: m).
    [[nodiscard]] double length_sigma_m() const noexcept { return std::sqrt(variance_m2_); }
    // The movement expected in the next tick.
    [[nodiscard]] const CrossedPose &expected_change() const noexcept { return change_; }
    // Checks restored memory: see core/base/sound_state.h.
    [[nodiscard]] bool is_sound() const noexcept { return are_flags(moving_); }

private:
    double variance_m2_ = 0.0;
    CrossedPose change_{};
    bool moving_ = false;
};

} // namespace spidar
