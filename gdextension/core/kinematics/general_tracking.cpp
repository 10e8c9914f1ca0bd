// Warm tick for rigid grips, exit pulleys and unusual stringing: the general Gauss-Newton steps.
#include <cmath>

#include <glm/geometric.hpp>

#include "core/kinematics/forward_kinematics.h"
#include "core/kinematics/steps/gauss_newton.h"
#include "core/kinematics/tracking_limits.h"

namespace spidar {

using namespace tracking;

// Returns the predicted pose as a valid pose of this grip.
GripPose ForwardKinematics::expected_pose() const noexcept {
    const double d = grip_.pole_half_length_m;
    GripPose pose = pose_of(one_change_on(lanes_of(last_pose_), prior_.expected_change(), d));
    pose.r2_m = d * glm::normalize(pose.r2_m);
    if (grip_.kind == GripKind::rigid) {
        pose.r1_m -= pose.r2_m * (glm::dot(pose.r1_m, pose.r2_m) / (d * d));
    }
    pose.r1_m = d * glm::normalize(pose.r1_m);
    return pose;
}

// Warm tick of rigid grips, exit pulleys, and grips without two strings per pole end.
KinematicsResult ForwardKinematics::track_any(const StringArray &lengths_m) noexcept {
    const LengthProblem problem{frame_, grip_, lengths_m};
    ExpectedPose expected;
    expected.weight = prior_.weight();
    const bool noisy = expected.weight > 0.0;
    expected.pose = noisy ? expected_pose() : last_pose_;
    const double reach_m = noisy ? kNoiseReach * prior_.length_sigma_m() : 0.0;
    GripPose pose = expected.pose;
    const GaussNewtonStep first =
        gauss_newton_step(problem, length_errors(problem, pose), pose, expected);
    if (!first.solvable || !(first.step_m <= kMaxWarmStep_m + reach_m)) {
        const bool forget = !first.solvable || !(first.step_m <= kForgetStep_m + reach_m);
        return search(lengths_m, forget ? nullptr : &last_pose_, 0.0);
    }
    LengthErrors errors = length_errors(problem, pose);
    const GaussNewtonStep second = gauss_newton_step(problem, errors, pose, expected);
    const double settling_m =
        std::fmax(kMaxSecondStep_m, noisy ? kSettlingShare * first.step_m : 0.0);
    GaussNewtonStep last = second;
    int steps = 2;
    errors = length_errors(problem, pose);
    const double enough_m = noisy ? kTrackingShare * errors.rms_m() : kTrackingFloor_m;
    if (second.solvable && second.step_m <= settling_m &&
        kLengthCurvature * second.step_m * second.step_m > enough_m) {
        last = gauss_newton_step(problem, errors, pose, expected);
        errors = length_errors(problem, pose);
        ++steps;
    }
    const double residual_rms_m = errors.rms_m();
    if (!last.solvable || !(second.step_m <= settling_m) || residual_alarms(residual_rms_m)) {
        return search(lengths_m, &last_pose_, kWarmResidualGate_m);
    }
    KinematicsResult result;
    result.pose = pose;
    result.residual_rms_m = residual_rms_m;
    result.steps = steps;
    const CrossedPose change = minus(lanes_of(pose), lanes_of(last_pose_));
    prior_.learn(sum_of_squares(result), change);
    still_ = squared(change) <= kStill_m * kStill_m;
    const bool look = --ticks_to_rivals_ <= 0;
    if (look) {
        ticks_to_rivals_ = kSlowRivalPeriod;
    }
    if (look || !noisy) {
        GripPose unmoved = pose;
        conditioning_ =
            noisy ? gauss_newton_step(problem, errors, unmoved).min_pivot : last.min_pivot;
    }
    result.conditioning = conditioning_;
    finish_look(look, lengths_m, result);
    return accept(result);
}

} // namespace spidar
