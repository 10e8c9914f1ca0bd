#include "core/kinematics/forward_kinematics.h"

#include <cmath>

#include <glm/geometric.hpp>

#include "core/base/finite.h"
#include "core/geometry/string_exit.h"
#include "core/kinematics/search/closed_form.h"
#include "core/kinematics/search/pose_search.h"
#include "core/kinematics/steps/gauss_newton.h"

namespace spidar {

namespace {

// Nearer to a z face than this, a 25th of an encoder count, a pole and its mirror image have the same lengths to rounding.
constexpr double kFaceMargin_m = 1e-6;
// No string is longer: the diagonal of the largest frame is 35 m.
constexpr double kLongestString_m = 40.0;
// After the steps of a warm tick a residual above this asks for a cold start, unless lengths have erred before. Calibrated
// strings err by less, and the redundant eighth length shows only a third of the error of one string.
constexpr double kWarmResidualGate_m = 1e-3;
// A search ends at the remembered pose where the lengths fit it to this, less than an encoder count. Else the others are
// looked at too, and must fit 50 times better: next to it a wrong branch may fit to a millimetre.
constexpr double kContentResidual_m = 2e-5;
// A residual this many times its recent level is no usual one.
constexpr double kUnusual = 3.0;
// Lengths that err by sigma move the foreseen pose by up to this many sigma in a tick, near badly determined poses.
constexpr double kNoiseReach = 4.0;
// With errors a second step of less than this share of the first still settles.
constexpr double kSettlingShare = 0.5;
// Motion within one tick above which Gauss-Newton alone is not trusted: 5 m/s at 1 kHz.
constexpr double kMaxWarmStep_m = 5e-3;
// Up to this the last pose is still trusted to lead to the right answer of several, if that fits: strings that err by
// millimetres move the pole ends so far in a tick. Beyond, it competes with the closed form.
constexpr double kTrustedStep_m = 0.02;
// The second step of a warm tick is quadratically smaller than the first; above this it did not settle.
constexpr double kMaxSecondStep_m = 5e-4;
// Above this it leaves more than 10 nm, and a third is taken: movements of more than a millimetre within a tick that were
// not foreseen, or samples lost.
constexpr double kThirdStep_m = 2e-5;
// Motion within one tick after which the last pose says nothing (device restarted, samples lost).
constexpr double kForgetStep_m = 0.05;
// Below this smallest scaled pivot the lengths leave a direction open to the square root of rounding: the pose is refused.
constexpr double kRankDeficientPivot = 1e-12;
// A warm tick is done when the error it leaves is below this or below kTrackingShare of the residual.
constexpr double kTrackingFloor_m = 1e-12;
// A higher order of extrapolation is used when its squared miss was this much smaller.
constexpr double kForeseenShare = 0.25;

bool all_possible(const StringArray &lengths_m) noexcept {
    for (const double length : lengths_m) {
        if (!(length > 0.0 && length <= kLongestString_m)) {
            return false;
        }
    }
    return true;
}

CrossedPose minus(const CrossedPose &a, const CrossedPose &b) noexcept {
    return {a.position_m - b.position_m, a.poles_m - b.poles_m};
}

// Residual once a step is taken, by the linear model that the step comes from. The step of a prior decreases the
// sum of both; its share is taken off again. off: from the pose of the step to the expected one.
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

double sum_of_squares(const KinematicsResult &result) noexcept {
    return kStringCount * result.residual_rms_m * result.residual_rms_m;
}

double squared(const CrossedPose &change) noexcept {
    return dot(change.position_m, change.position_m)[0] +
           sum_of(dot(change.poles_m, change.poles_m));
}

// The pose one change on. Poles back on their spheres to second order: a start needs no more.
CrossedPose one_change_on(const CrossedPose &pose, const CrossedPose &change, double d) noexcept {
    const LaneVec poles = pose.poles_m + change.poles_m;
    const Lanes excess = dot(poles, poles) * both(1.0 / (d * d)) - both(1.0);
    const Lanes scale = both(1.0) + excess * (both(0.375) * excess - both(0.5));
    return {pose.position_m + change.position_m, scale * poles};
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

// The gates that every new pose passes; on success it becomes the last pose.
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

// No search for a residual that is usual: errors of the strings that stay are no reason to doubt the pose.
bool ForwardKinematics::residual_alarms(double residual_rms_m) const noexcept {
    // On the way to another answer its level is not known yet.
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
    // Squares, so that the pivot needs no root. A step of size s leaves k s^2, and one more by the same
    // factorisation (k s)^2 s. One that leaves too little to matter is not looked at again.
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
    if (look || !noisy) { // the strings' own: the prior is no knowledge of the pose
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

// Changes `found` to another answer once that was better for long enough, and starts to blend from one to the other.
void ForwardKinematics::look_for_rivals(const StringArray &lengths_m,
                                        KinematicsResult &found) noexcept {
    PolishResult known;
    known.pose = found.pose;
    known.residual_rms_m = found.residual_rms_m;
    const double usual_m = prior_.length_sigma_m() * std::sqrt(1.0 / kStringCount);
    const RivalResult rival =
        find_rival({frame_, grip_, lengths_m}, search_tools(), known, usual_m);
    ambiguous_ = rival.ambiguous && closed_form_ && crossed_; // of others cold starts alone tell
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

// The next change by that order of extrapolation (none, constant speed, constant acceleration) which would have served
// best for the change just seen. Noise makes the higher orders worse, smooth motion much better.
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

// Where the motion leads, as a pose of this grip.
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

// Rigid grips, strings that leave over pulleys, and grips with other than two strings to a pole end.
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
        // One start in a million, far away, meets the bound just before the end: it may go on once.
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
    blend_.stop(); // found anew: the lengths themselves jumped
    if (ambiguous_) {
        result.status = Status::ambiguous_pose;
    }
    forget_motion();
    prior_.begin(sum_of_squares(result));
    return accept(result);
}

} // namespace spidar
