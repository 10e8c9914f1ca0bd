#include "core/kinematics/search/pose_search.h"

#include <cmath>

#include <glm/geometric.hpp>

#include "core/kinematics/search/closed_form.h"
#include "core/kinematics/search/pose_starts.h"

namespace spidar {

namespace {

// Residual at which a pose explains the lengths to double precision (eight lengths near 0.5 m).
constexpr double kResidualFloor_m = 1e-14;
// With one redundant length, noise alone often makes one pose fit many times better than another. A
// pose whose fit is worse than the best by less than these factors may be true: it makes the answer
// ambiguous, and is no reason to leave the remembered pose. Above kSuspiciousResidual_m the fit is
// worse than calibrated strings allow, and kClearlyBetter applies.
constexpr double kSuspiciousResidual_m = 2e-3;
constexpr double kClearlyBetter = 0.5;
constexpr double kBeyondChance = 0.02;
// Factor by which another root pair must fit better than the upright one, without memory. The
// upright pair is right in 98 % of all poses. Of the factors 1 to 0.02 this one gave the fewest
// wrong choices on the 60/45 set with counts and noise of 0.1 mm.
constexpr double kUprightPrior = 0.3;
// Largest residual at the true pose for strings that each err by 5 mm. Above it a pose that fits
// twice as well is another answer, not chance.
constexpr double kImprobableResidual_m = 6e-3;
// Residual above which the device counts as not calibrated. An upright pose that fits within
// kWithinNoise of the usual level is then likelier than a flipped one that fits better, since 98 %
// of all poses are upright.
constexpr double kNoisyResidual_m = 3e-4;
constexpr double kWithinNoise = 1.6;
// A root pair's start this close to the remembered pose leads to that pose.
constexpr double kSamePose_m = 1e-3;
// Largest second derivative of the string lengths that was seen, four times the usual one. Used
// where a search must not end too early.
constexpr double kWorstCurvature = 4.0 * kLengthCurvature;
// A residual r leaves the same error in a step as a step of this many times r.
constexpr double kResidualCurvature = 4.0;
// Fast steps before the damped method takes over. Lengths without errors need 1-5.
constexpr int kMaxRefineSteps = 10;
// A step longer than this share of the last one hands over to the damped method.
constexpr double kSlowestRate = 0.3;
// The factorized matrix is reused while the pose has moved by less than this since its computation.
constexpr double kRefactorStep_m = 1e-5;
// A step with a reused matrix that is longer than this share of the last one requires a new
// factorization. Near a singular pose even good steps only halve.
constexpr double kOutwornRate = 0.1;
// A matrix from a distance s leaves the same error in a step as a step of this many times s:
// strings near a corner of the frame are short, and their directions turn fast.
constexpr double kNearbyBend = 8.0;
// The residual has settled when a step lowers the sum of squares by less than this share.
constexpr double kSettledDecrease = 0.2;
// Largest misfit of a root pair per residual of the lengths, divided by (1 + c / distance to the z
// face). The worst of 120,000 poses of the 60/45 set with noise of 0.01 to 1 mm was 2.6, the median
// 1.1.
constexpr double kMisfitGain = 3.0;
// Factor by which a forecast misfit may exceed that limit before the pair is skipped. Of the pairs
// that mattered on that set 1 in 1000 exceeded it.
constexpr double kForecastSlack = 3.0;
// Last step below which the predicted residual is used: rounding allows the root of the step's
// rounding.
constexpr double kForetoldStep_m = 1e-12;
// Largest squared step, relative to the squared length errors, for which a reused factorization
// predicts the residual.
constexpr double kForetoldShare = 1e-6;

// Returns by which factor a pose must fit better than one with residual_m to exclude chance.
double beyond_chance(double residual_m) noexcept {
    return residual_m > kSuspiciousResidual_m ? kClearlyBetter : kBeyondChance;
}

// Returns whether a pose with candidate_m is also an answer when the best has best_m.
bool fits_as_well(double candidate_m, double best_m) noexcept {
    return !(candidate_m > kResidualFloor_m && best_m < beyond_chance(candidate_m) * candidate_m);
}

double pole_distance(const GripPose &a, const GripPose &b) noexcept {
    return std::fmax(glm::distance(a.position_m, b.position_m),
                     std::fmax(glm::distance(a.r1_m, b.r1_m), glm::distance(a.r2_m, b.r2_m)));
}

class Search {
public:
    Search(const LengthProblem &problem, const SearchTools &tools, SearchResult &found) noexcept
        : problem_(problem), tools_(tools), found_(found) {}

    void offer(const GripPose &start) noexcept { judge(polished(start)); }
    // Compares each candidate with `known` as well; the best preferable one is stored in `rival`.
    void look_beside(const PolishResult &known, double noise_m, RivalResult &rival) noexcept {
        known_ = &known;
        noise_m_ = noise_m;
        rival_ = &rival;
    }
    // The best pose so far comes from memory, which outweighs a better fit of another.
    void trust_memory() noexcept { remembers_ = true; }
    void try_root_pairs() noexcept;
    void try_rivals(const ClosedForm &form, int first_pair) noexcept;
    [[nodiscard]] bool settled() const noexcept {
        return found_.any && found_.best.residual_rms_m <= kResidualFloor_m;
    }

private:
    [[nodiscard]] double relevant_m() const noexcept {
        return found_.any ? found_.best.residual_rms_m / beyond_chance(found_.best.residual_rms_m)
                          : HUGE_VAL;
    }
    PolishResult polished(const GripPose &start) noexcept {
        return tools_.layout != nullptr ? refined(lanes_of(start)) : polish_pose(problem_, start);
    }
    PolishResult refined(const CrossedPose &start) noexcept;
    [[nodiscard]] bool replaces_best(double candidate_m) const noexcept;
    void judge(const PolishResult &candidate) noexcept;
    void weigh(const PolishResult &candidate) const noexcept;

    const LengthProblem &problem_;
    const SearchTools &tools_;
    SearchResult &found_;
    bool remembers_ = false;
    bool first_stands_ = true; // the best is the first one tried: upright or remembered
    const PolishResult *known_ = nullptr;
    double noise_m_ = 0.0;
    RivalResult *rival_ = nullptr;
};

// Takes fast Gauss-Newton steps while they converge fast, to the end for good lengths. Otherwise
// the damped Newton method continues; a search that can only end far above the best is given up.
PolishResult Search::refined(const CrossedPose &start) noexcept {
    const CrossedLayout &layout = *tools_.layout;
    const double d = layout.pole_half_length_m;
    const double hopeless_m2 = kStringCount * relevant_m() * relevant_m();
    PolishResult result;
    CrossedPose pose = start;
    CrossedErrors errors = errors_at(layout, problem_.lengths_m, pose);
    CrossedFactor factor;
    double gauss_pivot = 0.0;
    double last_size_m = HUGE_VAL;
    double bend_m = HUGE_VAL; // the error source of the next step with this factorization
    while (result.steps < kMaxRefineSteps && !result.converged) {
        const bool first = result.steps == 0;
        const bool again = bend_m <= kRefactorStep_m;
        ++result.steps;
        if (first) {
            factor = factorise(errors, pose, d);
            gauss_pivot = factor.min_pivot;
        } else if (!again) {
            factor = factorise_curved(errors, pose, d);
        }
        const CrossedStep step = again ? solve_nearby(factor, errors, pose) : solve(factor, errors);
        const double size_m = std::sqrt(step.size_m2);
        const bool tiny = size_m < kStagnantStep_m;
        const double rate = size_m / last_size_m;
        const bool slow = !tiny && !(rate <= kSlowestRate);
        const bool settled_high =
            errors.sum_of_squares_m2 - step.decrease_m2 > hopeless_m2 &&
            (slow || step.decrease_m2 < kSettledDecrease * errors.sum_of_squares_m2);
        // The closed form starts close to any pose that matters: a rival that must move far is
        // dropped.
        const bool rival_leaves = found_.any && !(size_m <= kMaxTrialStep_m) &&
                                  found_.best.residual_rms_m <= kSuspiciousResidual_m;
        if (settled_high || rival_leaves) {
            result.residual_rms_m = HUGE_VAL;
            return result;
        }
        if (!factor.solvable || !(size_m <= kMaxTrialStep_m) || slow) {
            break;
        }
        const double before_m2 = errors.sum_of_squares_m2;
        const CrossedPose before = pose;
        pose = moved(pose, step, d);
        // A step this small changes the residual as predicted.
        const double foretold_m2 = std::fmax(before_m2 - step.decrease_m2, 0.0);
        double bends_m = size_m;
        if (first) {
            bends_m += kResidualCurvature * std::sqrt(foretold_m2 / kStringCount);
        } else if (again) {
            bends_m = kNearbyBend * last_size_m;
        }
        const double left_m = size_m * std::fmax(kWorstCurvature * bends_m / gauss_pivot,
                                                 first ? 0.0 : (again ? 2.0 * rate : rate * rate));
        // A reused factorization alone may keep a step from shrinking: a new one decides.
        const bool outworn = again && !(rate <= kOutwornRate);
        result.converged = left_m <= kConvergedStep_m || (tiny && !again && rate > 0.5);
        const bool foretells = !again || step.size_m2 < kForetoldShare * before_m2;
        if (result.converged && size_m < kForetoldStep_m && foretells) {
            errors.sum_of_squares_m2 = foretold_m2;
        } else {
            errors = errors_at(layout, problem_.lengths_m, pose);
            if (!tiny && !(errors.sum_of_squares_m2 <= before_m2)) {
                pose = before;
                result.converged = false;
                break;
            }
        }
        last_size_m = size_m;
        bend_m = first ? bends_m : outworn ? HUGE_VAL : size_m;
    }
    result.residual_rms_m = std::sqrt(errors.sum_of_squares_m2 / kStringCount);
    result.pose = pose_of(pose);
    result.min_pivot = gauss_pivot;
    if (!result.converged) {
        const int before = result.steps;
        result = polish_pose(problem_, result.pose);
        result.steps += before;
    }
    return result;
}

bool Search::replaces_best(double candidate_m) const noexcept {
    const double best_m = found_.best.residual_rms_m;
    const double prior = remembers_ ? beyond_chance(best_m) : kUprightPrior;
    return best_m > kResidualFloor_m && candidate_m < (first_stands_ ? prior : 1.0) * best_m;
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
    if (rival_ != nullptr) {
        weigh(candidate);
    }
    const bool another = pole_distance(candidate.pose, found_.best.pose) > kDistinctPose_m;
    if (another && replaces_best(candidate.residual_rms_m)) {
        found_.ambiguous = fits_as_well(found_.best.residual_rms_m, candidate.residual_rms_m);
        found_.best = candidate;
        first_stands_ = false;
    } else if (another && fits_as_well(candidate.residual_rms_m, found_.best.residual_rms_m)) {
        found_.ambiguous = true;
    }
}

void Search::weigh(const PolishResult &candidate) const noexcept {
    const bool closed_form = tools_.closed_form_half_extents_m.has_value();
    const Vec3 half_extents_m = tools_.closed_form_half_extents_m.value_or(Vec3(HUGE_VAL));
    const double improbable_m = closed_form ? kImprobableResidual_m : kSuspiciousResidual_m;
    const double known_m = known_->residual_rms_m;
    const double fits_m = candidate.residual_rms_m;
    if (!(fits_m <= kImprobableResidual_m) || !candidate.converged ||
        !(std::fabs(candidate.pose.position_m.z) < half_extents_m.z) ||
        !(pole_distance(candidate.pose, known_->pose) > kSamePose_m)) {
        return;
    }
    const bool clearly =
        fits_m < (known_m > improbable_m ? kClearlyBetter : kBeyondChance) * known_m;
    const bool by_posture = closed_form && noise_m_ > kNoisyResidual_m &&
                            fits_m < kWithinNoise * std::fmax(noise_m_, known_m) &&
                            is_upright(half_extents_m, candidate.pose) &&
                            !is_upright(half_extents_m, known_->pose);
    if ((clearly || by_posture) && (!rival_->preferable || fits_m < rival_->best.residual_rms_m)) {
        rival_->preferable = true;
        rival_->best = candidate;
    }
}

void Search::try_root_pairs() noexcept {
    const ClosedForm form = solve_closed_form(
        *tools_.closed_form_half_extents_m, problem_.grip.pole_half_length_m,
        tools_.eyelet_lengths_m != nullptr ? *tools_.eyelet_lengths_m : problem_.lengths_m);
    if (tools_.layout == nullptr) {
        // These starts are too rough for their misfits to mean anything.
        for (int pair = 0; pair < kRootPairCount && !settled(); ++pair) {
            offer(pose_of(root_pair_start(form, pair)));
        }
        return;
    }
    if (!found_.any) {
        judge(refined(root_pair_start(form, 0)));
        if (!settled()) {
            try_rivals(form, 1);
        }
    } else {
        try_rivals(form, 0);
    }
}

void Search::try_rivals(const ClosedForm &form, int first_pair) noexcept {
    const RootHeights heights = root_heights(form);
    for (int pair = first_pair; pair < kRootPairCount && !settled(); ++pair) {
        // Errors of the lengths reach the misfit magnified, more so near a face.
        const MisfitForecast forecast =
            forecast_misfit(heights, problem_.grip.pole_half_length_m, pair);
        const double limit_m = kMisfitGain * forecast.gain * relevant_m();
        if (forecast.misfit_m > kForecastSlack * limit_m) {
            continue;
        }
        const RootPairPose start = root_pair_pose(form, pair);
        const bool known =
            remembers_ && pole_distance(pose_of(start.pose), found_.best.pose) < kSamePose_m;
        if (start.misfit_m <= limit_m && !known) {
            judge(refined(start.pose));
        }
    }
}

} // namespace

SearchResult search_pose(const LengthProblem &problem, const SearchTools &tools,
                         const GripPose *remembered, double content_m) noexcept {
    SearchResult found;
    Search search(problem, tools, found);
    if (remembered != nullptr) {
        search.offer(*remembered);
        search.trust_memory();
        const PolishResult &best = found.best;
        if (found.any && best.converged && best.residual_rms_m <= content_m) {
            return found;
        }
    }
    if (tools.closed_form_half_extents_m.has_value()) {
        search.try_root_pairs();
        return found;
    }
    for (int start = 0; start < kStartCount && !search.settled(); ++start) {
        search.offer(start_pose(problem, start));
    }
    return found;
}

RivalResult find_rival(const LengthProblem &problem, const SearchTools &tools,
                       const PolishResult &known, double noise_m) noexcept {
    RivalResult rival;
    SearchResult found;
    found.best = known;
    found.any = true;
    Search search(problem, tools, found);
    search.trust_memory();
    search.look_beside(known, noise_m, rival);
    if (tools.closed_form_half_extents_m.has_value()) {
        search.try_root_pairs();
    } else {
        for (int start = 0; start < kStartCount && !search.settled(); ++start) {
            search.offer(start_pose(problem, start));
        }
    }
    rival.ambiguous =
        found.ambiguous || pole_distance(found.best.pose, known.pose) > kDistinctPose_m;
    return rival;
}

} // namespace spidar
