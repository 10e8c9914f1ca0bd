#include "core/pose_search.h"

#include <cmath>

#include <glm/geometric.hpp>

#include "core/closed_form.h"
#include "core/constants.h"
#include "core/pose_starts.h"

namespace spidar {

namespace {

// How much worse than `first_m` a residual may be and still matter: below it wins or makes the pose ambiguous.
double advantage(double first_m) noexcept {
    return first_m > kSuspiciousResidual_m ? kClearlyBetter : kBeyondChance;
}

// Whether a pose that fits to `candidate_m` replaces one that came first and fits to `first_m`.
bool replaces(double candidate_m, double first_m) noexcept {
    return first_m > kResidualFloor_m && candidate_m < advantage(first_m) * first_m;
}

double pole_distance(const GripPose &a, const GripPose &b) noexcept {
    return std::fmax(glm::distance(a.position_m, b.position_m),
                     std::fmax(glm::distance(a.r1_m, b.r1_m), glm::distance(a.r2_m, b.r2_m)));
}

class Search {
public:
    Search(const LengthProblem &problem, const SearchTools &tools) noexcept
        : problem_(problem), tools_(tools) {}

    void offer(const GripPose &start) noexcept { judge(polished(start)); }
    void try_root_pairs() noexcept;
    [[nodiscard]] bool settled() const noexcept {
        return found_.any && found_.best.residual_rms_m <= kResidualFloor_m;
    }
    [[nodiscard]] const SearchResult &result() const noexcept { return found_; }

private:
    [[nodiscard]] double relevant_m() const noexcept {
        return found_.any ? found_.best.residual_rms_m / advantage(found_.best.residual_rms_m)
                          : HUGE_VAL;
    }
    PolishResult polished(const GripPose &start) noexcept {
        return tools_.layout != nullptr ? refined(lanes_of(start)) : polish_pose(problem_, start);
    }
    PolishResult refined(const CrossedPose &start) noexcept;
    void judge(const PolishResult &candidate) noexcept;

    const LengthProblem &problem_;
    const SearchTools &tools_;
    SearchResult found_;
};

// Gauss-Newton with the fast steps as long as it converges fast: to the end when the lengths are good. Where it does
// not, the damped Newton method takes over; where it can only end far above the best, it is given up.
PolishResult Search::refined(const CrossedPose &start) noexcept {
    const CrossedLayout &layout = *tools_.layout;
    const double d = layout.pole_half_length_m;
    const double hopeless_m2 = kStringCount * relevant_m() * relevant_m();
    PolishResult result;
    CrossedPose pose = start;
    CrossedErrors errors = errors_at(layout, problem_.lengths_m, pose);
    CrossedFactor factor;
    double last_size_m = HUGE_VAL;
    while (result.steps < kMaxRefineSteps && !result.converged) {
        ++result.steps;
        const bool again = last_size_m <= kRefactorStep_m;
        if (!again) {
            factor = factorise(errors, pose, d);
        }
        const CrossedStep step = again ? solve_nearby(factor, errors, pose) : solve(factor, errors);
        const double size_m = std::sqrt(step.size_m2);
        const bool tiny = size_m < kStagnantStep_m;
        const double rate = size_m / last_size_m;
        const bool slow = !tiny && !(rate <= kSlowestRate);
        const bool settled_high =
            errors.sum_of_squares_m2 - step.decrease_m2 > hopeless_m2 &&
            (slow || step.decrease_m2 < kSettledDecrease * errors.sum_of_squares_m2);
        // The closed form starts next to a pose that matters: a rival that must go far is none.
        const bool rival_leaves = found_.any && !(size_m <= kMaxTrialStep_m) &&
                                  found_.best.residual_rms_m <= kSuspiciousResidual_m;
        if (settled_high || rival_leaves) {
            result.residual_rms_m = HUGE_VAL;
            return result;
        }
        if (!factor.solvable || !(size_m <= kMaxTrialStep_m) || slow) {
            break;
        }
        const CrossedPose trial = moved(pose, step, d);
        const CrossedErrors trial_errors = errors_at(layout, problem_.lengths_m, trial);
        if (!tiny && !(trial_errors.sum_of_squares_m2 <= errors.sum_of_squares_m2)) {
            break;
        }
        pose = trial;
        errors = trial_errors;
        result.residual_rms_m = std::sqrt(errors.sum_of_squares_m2 / kStringCount);
        // What this step leaves: by the rate seen, and by the curvature of the lengths where that rate says
        // too little, at the first step and at the first by a factorisation from elsewhere.
        const double bend_m =
            again ? kNearbyBend * last_size_m : size_m + kResidualCurvature * result.residual_rms_m;
        const double expected = kLengthCurvature * bend_m / factor.min_pivot;
        const bool first = !(last_size_m < HUGE_VAL);
        const double left_m =
            size_m * (first ? expected : std::fmax(2.0 * rate, again ? expected : 0.0));
        result.converged = left_m <= kConvergedStep_m || (tiny && rate > 0.5);
        last_size_m = size_m;
    }
    result.pose = pose_of(pose);
    result.min_pivot = factor.min_pivot;
    if (!result.converged) {
        const int before = result.steps;
        result = polish_pose(problem_, result.pose);
        result.steps += before;
    }
    return result;
}

void Search::judge(const PolishResult &candidate) noexcept {
    found_.steps += candidate.steps;
    if (!std::isfinite(candidate.residual_rms_m)) {
        return;
    }
    if (!found_.any) {
        found_.best = candidate;
        found_.any = true;
        return;
    }
    const bool another = pole_distance(candidate.pose, found_.best.pose) > kDistinctPose_m;
    if (another && replaces(candidate.residual_rms_m, found_.best.residual_rms_m)) {
        found_.ambiguous = false;
        found_.best = candidate;
    } else if (another && !replaces(found_.best.residual_rms_m, candidate.residual_rms_m)) {
        found_.ambiguous = true;
    }
}

void Search::try_root_pairs() noexcept {
    const ClosedForm form = solve_closed_form(*tools_.closed_form_half_extents_m,
                                              problem_.grip.pole_half_length_m, problem_.lengths_m);
    for (int pair = 0; pair < kRootPairCount && !settled(); ++pair) {
        const RootPairPose start = root_pair_pose(form, pair);
        const double height_m = start.pose.position_m.z[0];
        const double face_m = std::fabs(form.face[0]) - std::fabs(height_m);
        // Errors of the lengths reach the misfit magnified, the more the nearer a face is.
        const double gain = kMisfitGain * (1.0 + form.face[0] / std::fmax(face_m, 0.0));
        if (start.misfit_m > gain * relevant_m()) {
            continue;
        }
        judge(refined(start.pose));
    }
}

} // namespace

SearchResult search_pose(const LengthProblem &problem, const SearchTools &tools,
                         const GripPose *remembered, double content_m) noexcept {
    Search search(problem, tools);
    if (remembered != nullptr) {
        search.offer(*remembered);
        const PolishResult &best = search.result().best;
        if (search.result().any && best.converged && best.residual_rms_m <= content_m) {
            return search.result();
        }
    }
    if (tools.closed_form_half_extents_m.has_value()) {
        search.try_root_pairs();
        return search.result();
    }
    for (int start = 0; start < kStartCount && !search.settled(); ++start) {
        search.offer(start_pose(problem, start));
    }
    return search.result();
}

} // namespace spidar
