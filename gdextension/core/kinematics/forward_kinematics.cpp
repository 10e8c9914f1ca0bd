#include "core/kinematics/forward_kinematics.h"

#include <cmath>

#include <glm/geometric.hpp>

#include "core/base/finite.h"
#include "core/geometry/string_exit.h"
#include "core/kinematics/search/closed_form.h"
#include "core/kinematics/search/pose_search.h"
#include "core/kinematics/steps/gauss_newton.h"
#include "core/kinematics/tracking_limits.h"

namespace spidar {

namespace {

using namespace tracking;

bool all_possible(const StringArray &lengths_m) noexcept {
    for (const double length : lengths_m) {
        if (!(length > 0.0 && length <= kLongestString_m)) {
            return false;
        }
    }
    return true;
}

// Returns the residual (rms) after a step, by the linear model of the step. With a prior the step
// decreases the sum of both objectives, and the prior's share is removed again. off: from the pose
// of the step to the expected one.
double rms_after(const CrossedErrors &errors, const CrossedStep &step, double prior,
                 const CrossedPose &off) noexcept {
    double left_m2 = errors.sum_of_squares_m2 - step.decrease_m2;
    if (prior > 0.0) {
        const double along_m2 =
            dot(step.position_m, off.position_m)[0] + sum_of(dot(step.poles_m, off.poles_m));
        left_m2 += prior * (2.0 * along_m2 - step.size_m2);
    }
    return std::sqrt(left_m2 > 0.0 ? left_m2 / kStringCount : 0.0);
}

} // namespace

Status ForwardKinematics::configure(const FrameGeometry &frame, const GripGeometry &grip) noexcept {
    if (!is_usable(frame) || !is_usable(grip, frame)) {
        return Status::invalid_geometry;
    }
    frame_ = frame;
    grip_ = grip;
    const std::optional<Vec3> box = box_half_extents(frame);
    is_box_ = box.has_value();
    half_extents_m_ = box.value_or(Vec3(0.0));
    crossed_ = make_layout(frame, grip, layout_) && !(frame.pulley_radius_m > 0.0);
    closed_form_ = is_box_ && has_paper_attachments(grip);
    last_pose_ = rest_pose(grip);
    reset();
    return Status::ok;
}

void ForwardKinematics::set_last_pose(const GripPose &pose) noexcept {
    reset();
    last_pose_ = pose;
    warm_ = true;
}

KinematicsResult ForwardKinematics::hold(const KinematicsResult &from,
                                         Status status) const noexcept {
    KinematicsResult result = from;
    result.pose = last_pose();
    result.status = status;
    return result;
}

KinematicsResult ForwardKinematics::refuse(const StringArray &lengths_m,
                                           const KinematicsResult &result) const noexcept {
    return hold(result, all_finite(lengths_m) ? Status::impossible_lengths : Status::not_finite);
}

// Checks that every new pose must pass; a pose that passes becomes the last pose.
KinematicsResult ForwardKinematics::accept(KinematicsResult &result) noexcept {
    if (!(result.residual_rms_m <= kImpossibleResidual_m)) {
        return hold(result, Status::impossible_lengths);
    }
    if (is_box_ && grip_.kind == GripKind::crossed &&
        !(std::fabs(result.pose.position_m.z) < half_extents_m_.z - kFaceMargin_m)) {
        return hold(result, Status::outside_frame);
    }
    if (!(result.conditioning >= kRankDeficientPivot)) {
        return hold(result, Status::rank_deficient);
    }
    if (result.status == Status::ok && result.conditioning < kNearSingularPivot) {
        result.status = Status::near_singular;
    }
    last_pose_ = result.pose;
    warm_ = true;
    fresh_ = false;
    if (blend_.active()) {
        result.pose = blend_.next(result.pose);
    }
    return result;
}

KinematicsResult ForwardKinematics::update(const StringArray &lengths_m) noexcept {
    if (!warm_) {
        return solve_cold(lengths_m);
    }
    if (!all_possible(lengths_m)) {
        return refuse(lengths_m, KinematicsResult());
    }
    return crossed_ ? track_crossed(lengths_m) : track_any(lengths_m);
}

// A usual residual causes no search: lasting errors of the strings are no reason to doubt the pose.
bool ForwardKinematics::residual_alarms(double residual_rms_m) const noexcept {
    // During a blend to another answer the usual level is not known yet.
    if (residual_rms_m <= kWarmResidualGate_m || blend_.active()) {
        return false;
    }
    const double usual_m = prior_.length_sigma_m() * std::sqrt(1.0 / kStringCount);
    return fresh_ || !(residual_rms_m <= kUnusual * usual_m);
}

KinematicsResult ForwardKinematics::track_crossed(const StringArray &lengths_m) noexcept {
    const double d = layout_.pole_half_length_m;
    const double prior = prior_.weight();
    const bool noisy = prior > 0.0;
    const CrossedPose last = lanes_of(last_pose_);
    CrossedPose pose = noisy         ? one_change_on(last, prior_.expected_change(), d)
                       : foreseeing_ ? one_change_on(last, foreseen_change_, d)
                                     : last;
    const CrossedPose expected = pose;
    CrossedErrors errors = errors_at(layout_, lengths_m, pose);
    CrossedFactor factor = factorise(errors, pose, d, prior);
    const CrossedStep first = solve(factor, errors);
    const double reach_m = noisy ? kNoiseReach * prior_.length_sigma_m() : 0.0;
    const auto within = [reach_m, &first](double limit_m) {
        return first.size_m2 <= (limit_m + reach_m) * (limit_m + reach_m);
    };
    if (!factor.solvable || !within(kMaxWarmStep_m)) {
        const bool forget = !factor.solvable || !within(kForgetStep_m);
        return search(lengths_m, forget ? nullptr : &last_pose_,
                      within(kTrustedStep_m) ? kContentResidual_m : 0.0);
    }
    pose = moved(pose, first, d);
    KinematicsResult result;
    result.steps = 1;
    result.residual_rms_m = rms_after(errors, first, prior, CrossedPose());
    // Squares avoid the root of the pivot. A step of size s leaves an error k s^2, and another step
    // with the same factorization (k s)^2 s. A step that leaves too little to matter is not checked
    // again.
    const double enough_m = kTrackingFloor_m + kTrackingShare * result.residual_rms_m;
    const double allowed = enough_m * enough_m * factor.min_pivot;
    const double bend2 = kLengthCurvature * kLengthCurvature * first.size_m2;
    if (!(bend2 * first.size_m2 <= allowed)) {
        const auto step_on = [&](bool again) {
            errors = errors_at(layout_, lengths_m, pose);
            if (!again) {
                factor = factorise(errors, pose, d, prior);
            }
            return again || noisy ? solve_nearby(factor, errors, pose, prior, expected)
                                  : solve(factor, errors);
        };
        const auto take = [&](const CrossedStep &step) {
            const CrossedPose off = minus(expected, pose);
            pose = moved(pose, step, d);
            ++result.steps;
            result.residual_rms_m = rms_after(errors, step, prior, off);
        };
        const CrossedStep second =
            step_on(bend2 * bend2 * first.size_m2 <= allowed * factor.min_pivot);
        const double settling_m2 = noisy ? kSettlingShare * kSettlingShare * first.size_m2 : 0.0;
        if (!factor.solvable ||
            !(second.size_m2 <= std::fmax(kMaxSecondStep_m * kMaxSecondStep_m, settling_m2))) {
            return search(lengths_m, &last_pose_, kContentResidual_m);
        }
        take(second);
        const double curved_m = kLengthCurvature * second.size_m2;
        if (!(second.size_m2 <= kThirdStep_m * kThirdStep_m) &&
            !(noisy && curved_m <= kTrackingShare * result.residual_rms_m)) {
            const CrossedStep third = step_on(false);
            if (!factor.solvable || !(third.size_m2 <= second.size_m2)) {
                return search(lengths_m, &last_pose_, kContentResidual_m);
            }
            take(third);
        }
    }
    if (residual_alarms(result.residual_rms_m)) {
        return search(lengths_m, &last_pose_, kContentResidual_m);
    }
    const CrossedPose change{pose.position_m - last.position_m, pose.poles_m - last.poles_m};
    foresee(change);
    prior_.learn(sum_of_squares(result), change);
    still_ = squared(change) <= kStill_m * kStill_m;
    result.pose = pose_of(pose);
    const bool look = --ticks_to_rivals_ <= 0;
    if (look) {
        ticks_to_rivals_ = closed_form_ ? kRivalPeriod : kSlowRivalPeriod;
    }
    if (look || !noisy) { // by the strings alone: a prior is no knowledge of the pose
        conditioning_ = noisy ? factorise(errors, pose, d).min_pivot : factor.min_pivot;
    }
    result.conditioning = conditioning_;
    finish_look(look, lengths_m, result);
    return accept(result);
}

void ForwardKinematics::finish_look(bool look, const StringArray &lengths_m,
                                    KinematicsResult &result) noexcept {
    const bool quick = closed_form_ && crossed_;
    if (look && !blend_.active()) {
        if (quick || result.residual_rms_m > kWarmResidualGate_m) {
            look_for_rivals(lengths_m, result);
        } else {
            better_looks_ = 0;
        }
    }
    if (quick && ambiguous_) {
        result.status = Status::ambiguous_pose;
    }
}

// Changes `found` to a rival that was preferable for long enough, and starts the blend.
void ForwardKinematics::look_for_rivals(const StringArray &lengths_m,
                                        KinematicsResult &found) noexcept {
    PolishResult known;
    known.pose = found.pose;
    known.residual_rms_m = found.residual_rms_m;
    const double usual_m = prior_.length_sigma_m() * std::sqrt(1.0 / kStringCount);
    const RivalResult rival =
        find_rival({frame_, grip_, lengths_m}, search_tools(), known, usual_m);
    ambiguous_ = rival.ambiguous && closed_form_ &&
                 crossed_; // for other grips only cold starts detect ambiguity
    better_looks_ = rival.preferable ? better_looks_ + 1 : 0;
    if (better_looks_ >= (closed_form_ && crossed_ ? kRivalLooks : kSlowRivalLooks)) {
        better_looks_ = 0;
        blend_.start(found.pose, rival.best.pose);
        found.pose = rival.best.pose;
        found.residual_rms_m = rival.best.residual_rms_m;
        found.conditioning = conditioning_ = rival.best.min_pivot;
        forget_motion();
        prior_.begin(sum_of_squares(found));
    }
}

// Predicts the next change by the order of extrapolation (none, constant speed, constant
// acceleration) that would have predicted the last change best. Noise makes higher orders worse,
// smooth motion much better.
void ForwardKinematics::foresee(const CrossedPose &change) noexcept {
    const CrossedPose turn = minus(change, last_change_);
    const double still2 = squared(change);
    const double steady2 = squared(turn);
    const double turning2 = squared(minus(turn, last_turn_));
    last_change_ = change;
    last_turn_ = turn;
    foreseeing_ = steady2 < kForeseenShare * still2;
    foreseen_change_ = change;
    if (turning2 < kForeseenShare * steady2) {
        foreseeing_ = true;
        foreseen_change_ = {change.position_m + turn.position_m, change.poles_m + turn.poles_m};
    }
}

KinematicsResult ForwardKinematics::solve_cold(const StringArray &lengths_m) noexcept {
    KinematicsResult result;
    result.cold_start = true;
    if (!all_possible(lengths_m)) {
        return refuse(lengths_m, result);
    }
    return search(lengths_m, nullptr, 0.0);
}

SearchTools ForwardKinematics::search_tools() const noexcept {
    SearchTools tools;
    tools.layout = crossed_ ? &layout_ : nullptr;
    if (closed_form_) {
        tools.closed_form_half_extents_m = half_extents_m_;
    }
    return tools;
}

KinematicsResult ForwardKinematics::search(const StringArray &lengths_m, const GripPose *remembered,
                                           double content_m) noexcept {
    const LengthProblem problem{frame_, grip_, lengths_m};
    SearchTools tools = search_tools();
    StringArray eyelets_m = lengths_m;
    if (frame_.pulley_radius_m > 0.0) {
        for (std::size_t i = 0; i < kStringCount; ++i) {
            const Vec3 end = attachment_point(grip_, last_pose_, static_cast<int>(i));
            eyelets_m[i] +=
                glm::distance(end, frame_.motors_m[i]) - string_path(frame_, i, end).length_m;
        }
        tools.eyelet_lengths_m = &eyelets_m;
    }
    SearchResult found = search_pose(problem, tools, remembered, content_m);
    if (found.any && !found.best.converged && found.best.residual_rms_m <= kImpossibleResidual_m) {
        // One distant start in a million reaches the step limit just before convergence: it may
        // continue once.
        found.best = polish_pose(problem, found.best.pose);
        found.steps += found.best.steps;
    }
    KinematicsResult result;
    result.cold_start = true;
    result.steps = found.steps;
    if (!found.any) {
        return hold(result, Status::impossible_lengths);
    }
    result.pose = found.best.pose;
    result.residual_rms_m = found.best.residual_rms_m;
    result.conditioning = found.best.min_pivot;
    if (!found.best.converged && found.best.residual_rms_m <= kImpossibleResidual_m) {
        return hold(result, Status::not_converged);
    }
    ambiguous_ = found.ambiguous;
    ticks_to_rivals_ = kRivalPeriod;
    better_looks_ = 0;
    still_ = true;
    conditioning_ = result.conditioning;
    blend_.stop(); // found by a search: the lengths themselves jumped
    if (ambiguous_) {
        result.status = Status::ambiguous_pose;
    }
    forget_motion();
    prior_.begin(sum_of_squares(result));
    return accept(result);
}

} // namespace spidar
