#include "core/forward_kinematics.h"

#include <cmath>

#include <glm/geometric.hpp>

#include "core/closed_form.h"
#include "core/constants.h"
#include "core/gauss_newton.h"
#include "core/pose_polish.h"
#include "core/pose_starts.h"

namespace spidar {

namespace {

bool all_finite(const StringArray &lengths_m) noexcept {
    for (const double length : lengths_m) {
        if (!std::isfinite(length)) {
            return false;
        }
    }
    return true;
}

bool all_positive(const StringArray &lengths_m) noexcept {
    for (const double length : lengths_m) {
        if (!(length > 0.0)) {
            return false;
        }
    }
    return true;
}

// Whether a pose that fits to `candidate_m` replaces one that came first and fits to `first_m`.
bool replaces(double candidate_m, double first_m) noexcept {
    if (first_m <= kResidualFloor_m) {
        return false;
    }
    const double factor = first_m > kSuspiciousResidual_m ? kClearlyBetter : kBeyondChance;
    return candidate_m < factor * first_m;
}

double pole_distance(const GripPose &a, const GripPose &b) noexcept {
    return std::fmax(glm::distance(a.position_m, b.position_m),
                     std::fmax(glm::distance(a.r1_m, b.r1_m), glm::distance(a.r2_m, b.r2_m)));
}

// The best pose so far, and whether another one far from it fits as well.
struct Search {
    PolishResult best;
    bool any = false;
    bool ambiguous = false;
    int steps = 0;

    void offer(const PolishResult &candidate) noexcept {
        steps += candidate.steps;
        if (!std::isfinite(candidate.residual_rms_m)) {
            return;
        }
        if (!any) {
            best = candidate;
            any = true;
            return;
        }
        const bool another = pole_distance(candidate.pose, best.pose) > kDistinctPose_m;
        if (another && replaces(candidate.residual_rms_m, best.residual_rms_m)) {
            ambiguous = false;
            best = candidate;
        } else if (another && !replaces(best.residual_rms_m, candidate.residual_rms_m)) {
            ambiguous = true;
        }
    }
};

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
    last_pose_ = rest_pose(grip);
    warm_ = false;
    return Status::ok;
}

void ForwardKinematics::set_last_pose(const GripPose &pose) noexcept {
    last_pose_ = pose;
    warm_ = true;
}

KinematicsResult ForwardKinematics::hold(KinematicsResult result, Status status) const noexcept {
    result.pose = last_pose_;
    result.status = status;
    return result;
}

// The gates that every new pose passes; on success it becomes the last pose.
KinematicsResult ForwardKinematics::accept(KinematicsResult result) noexcept {
    if (!(result.residual_rms_m <= kImpossibleResidual_m)) {
        return hold(result, Status::impossible_lengths);
    }
    if (is_box_ && !(std::fabs(result.pose.position_m.z) < half_extents_m_.z)) {
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
    return result;
}

KinematicsResult ForwardKinematics::update(const StringArray &lengths_m) noexcept {
    if (!warm_) {
        return solve_cold(lengths_m);
    }
    KinematicsResult result;
    if (!all_finite(lengths_m)) {
        return hold(result, Status::not_finite);
    }
    if (!all_positive(lengths_m)) {
        return hold(result, Status::impossible_lengths);
    }
    const LengthProblem problem{frame_, grip_, lengths_m};
    GripPose pose = last_pose_;
    const GaussNewtonStep first = gauss_newton_step(problem, length_errors(problem, pose), pose);
    if (!first.solvable || !(first.step_m <= kMaxWarmStep_m)) {
        const bool forget = !first.solvable || !(first.step_m <= kForgetStep_m);
        return search(lengths_m, forget ? nullptr : &last_pose_);
    }
    const GaussNewtonStep second = gauss_newton_step(problem, length_errors(problem, pose), pose);
    const double residual_rms_m = length_errors(problem, pose).rms_m();
    if (!second.solvable || !(second.step_m <= kMaxSecondStep_m) ||
        !(residual_rms_m <= kWarmResidualGate_m)) {
        return search(lengths_m, &last_pose_);
    }
    result.pose = pose;
    result.residual_rms_m = residual_rms_m;
    result.conditioning = second.min_pivot;
    result.steps = 2;
    return accept(result);
}

KinematicsResult ForwardKinematics::solve_cold(const StringArray &lengths_m) noexcept {
    KinematicsResult result;
    result.cold_start = true;
    if (!all_finite(lengths_m)) {
        return hold(result, Status::not_finite);
    }
    if (!all_positive(lengths_m)) {
        return hold(result, Status::impossible_lengths);
    }
    return search(lengths_m, nullptr);
}

// Every start worth trying, the preferred one first: the remembered pose, the upright root pair, the others.
KinematicsResult ForwardKinematics::search(const StringArray &lengths_m,
                                           const GripPose *remembered) noexcept {
    const LengthProblem problem{frame_, grip_, lengths_m};
    Search found;
    if (remembered != nullptr) {
        found.offer(polish_pose(problem, *remembered));
    }
    if (is_box_ && has_paper_attachments(grip_)) {
        for (int pair = 0; pair < kRootPairCount; ++pair) {
            // A pose that explains the lengths fully needs no rival.
            if (found.any && found.best.residual_rms_m <= kResidualFloor_m) {
                break;
            }
            found.offer(
                polish_pose(problem, closed_form_pose(half_extents_m_, grip_.pole_half_length_m,
                                                      lengths_m, pair)));
        }
    } else {
        for (int start = 0; start < kStartCount; ++start) {
            if (found.any && found.best.residual_rms_m <= kResidualFloor_m) {
                break;
            }
            found.offer(polish_pose(problem, start_pose(problem, start)));
        }
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
    if (found.ambiguous) {
        result.status = Status::ambiguous_pose;
    }
    return accept(result);
}

} // namespace spidar
