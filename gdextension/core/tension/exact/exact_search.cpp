// solve_exactly(): the exact optimum of one bounded least-squares problem.
//
// First a few rounds guess the active set: each holds every string that left its range and releases
// every string whose bound pulls the wrong way. A primal active-set method follows, one string at a
// time. The objective falls with every move, so that it cannot cycle (see kSureMove_n). The answer
// is refined with gradients from A itself, and is therefore exact to rounding.
#include <algorithm>
#include <cmath>

#include "core/base/finite.h"
#include "core/tension/exact/box_least_squares.h"
#include "core/tension/exact/tension_problem.h"

namespace spidar {

namespace {

// Largest Newton step that ends the refinement (unit: N): the next one would be at least 1e6 times
// smaller (see kCancelledPivot).
constexpr double kStepTolerance_n = 1e-10;
// Smallest movement for which a held string is released (unit: N): five roundings of a 10 N
// tension. Less is noise; more shows in an objective near zero.
constexpr double kReleaseMove_n = 1e-14;
// Smallest movement that rounding cannot undo (unit: N).
constexpr double kSureMove_n = 1e-11;
// Number of releases with a smaller movement, two per string, so that no two active sets can
// alternate endlessly. Well below kMaxFactorisations.
constexpr int kBareReleases = 16;
// Rounding of a gradient in double, as a share of the largest force that cancels in it.
constexpr double kGradientRounding = 2e-15;
// Movement of a free string by that rounding above which the gradient is computed in double-double
// (unit: N).
constexpr double kRoundingMove_n = 1e-11;
// Rounds that guess which strings are at a bound. 98 % of problems need one or two.
constexpr int kGuessRounds = 6;
// Limit of factorizations, used twice: from the guess, then from cold. Eight strings take at most
// 18.
constexpr int kMaxFactorisations = 50;
constexpr int kMaxPasses = 4 * kMaxFactorisations;
constexpr int kMaxRefinements = 6;

class ActiveSetSearch {
public:
    ActiveSetSearch(const TensionProblem &problem, BoxLeastSquares &system) noexcept
        : problem_(problem), system_(system) {
        for (std::size_t i = 0; i < kStringCount; ++i) {
            if (problem.lower_n[i] < problem.upper_n[i]) {
                movable_ = with_string(movable_, i);
            }
        }
    }

    // Returns false at the iteration limit or on overflow; the tensions are then feasible but not
    // optimal.
    bool run(const ActiveSet *warm, int guess_rounds) noexcept {
        start(warm);
        guess_rounds_ = guess_rounds;
        int factorisations = 0;
        for (int pass = 0; pass < kMaxPasses; ++pass) {
            if (!factored_) {
                if (++factorisations > kMaxFactorisations) {
                    return false;
                }
                system_.factor(free_);
                ++iterations_;
                factored_ = true;
                refinements_ = 0;
            }
            gradient_ = system_.gradient(tensions_, precise_);
            StringArray step = system_.solve(gradient_.values);
            double largest = 0.0;
            for (double &value : step) {
                value = -value;
                if (!std::isfinite(value)) {
                    return false;
                }
                largest = std::max(largest, std::abs(value));
            }
            if (!take_step(step)) {
                continue;
            }
            if (needs_another_refinement(largest)) {
                continue;
            }
            if (!release_strings(step)) {
                return true;
            }
        }
        return false;
    }

    [[nodiscard]] const StringArray &tensions() const noexcept { return tensions_; }
    [[nodiscard]] const ActiveSet &active() const noexcept { return active_; }
    [[nodiscard]] int iterations() const noexcept { return iterations_; }

private:
    void start(const ActiveSet *warm) noexcept {
        free_ = 0;
        bare_releases_ = 0;
        factored_ = false;
        precise_ = false;
        for (std::size_t i = 0; i < kStringCount; ++i) {
            const StringBound guess = warm == nullptr ? StringBound::free : (*warm)[i];
            if (!has_string(movable_, i) || guess == StringBound::at_lower) {
                hold(i, StringBound::at_lower);
            } else if (guess == StringBound::at_upper) {
                hold(i, StringBound::at_upper);
            } else {
                active_[i] = StringBound::free;
                free_ = with_string(free_, i);
                tensions_[i] = std::clamp(problem_.proximal_target_n[i], problem_.lower_n[i],
                                          problem_.upper_n[i]);
            }
        }
    }

    void hold(std::size_t string, StringBound bound) noexcept {
        active_[string] = bound;
        tensions_[string] =
            bound == StringBound::at_lower ? problem_.lower_n[string] : problem_.upper_n[string];
        free_ = without_string(free_, string);
        factored_ = false;
    }

    // Releases a string. barely: by less than kSureMove_n.
    void let_go(std::size_t string, bool barely) noexcept {
        bare_releases_ += barely ? 1 : 0;
        active_[string] = StringBound::free;
        free_ = with_string(free_, string);
        factored_ = false;
    }

    // Returns true when the whole step stays within the bounds. Otherwise strings were held: all
    // that left while guessing, later the first one met.
    bool take_step(const StringArray &step) noexcept {
        double share = 1.0;
        std::size_t first = kStringCount;
        for (std::size_t i = 0; i < kStringCount; ++i) {
            if (!has_string(free_, i)) {
                continue;
            }
            const double there = tensions_[i] + step[i];
            if (there >= problem_.lower_n[i] && there <= problem_.upper_n[i]) {
                continue;
            }
            const double bound = step[i] < 0.0 ? problem_.lower_n[i] : problem_.upper_n[i];
            const double reach = (bound - tensions_[i]) / step[i];
            if (first == kStringCount || reach < share) {
                share = std::clamp(reach, 0.0, 1.0);
                first = i;
            }
        }
        if (first == kStringCount) {
            for (std::size_t i = 0; i < kStringCount; ++i) {
                tensions_[i] += step[i];
            }
            return true;
        }
        const bool guessing = guess_rounds_ > 0;
        guess_rounds_ -= guessing ? 1 : 0;
        const StringMask was_free = free_;
        for (std::size_t i = 0; i < kStringCount; ++i) {
            if (!has_string(was_free, i)) {
                continue;
            }
            const double there = tensions_[i] + (guessing ? step[i] : share * step[i]);
            const double lower = problem_.lower_n[i];
            const double upper = problem_.upper_n[i];
            const bool leaves = there < lower || there > upper;
            if (i == first || (guessing && leaves)) {
                hold(i, step[i] < 0.0 ? StringBound::at_lower : StringBound::at_upper);
            } else {
                tensions_[i] = std::clamp(there, lower, upper);
            }
        }
        return false;
    }

    // Returns how far rounding of the gradient moves a string of this stiffness.
    [[nodiscard]] double rounding_move(double stiffness) const noexcept {
        return kGradientRounding * gradient_.largest_force_n / stiffness;
    }

    bool needs_another_refinement(double largest_step) noexcept {
        // The first step is large, and what cancels in it says nothing about the end. A small step
        // proves nothing where the gradient rounds the same way each time.
        const bool near_the_end = refinements_ > 0 || largest_step <= kStepTolerance_n;
        if (near_the_end && !precise_ &&
            rounding_move(system_.smallest_pivot()) > kRoundingMove_n) {
            precise_ = true;
            refinements_ = 1;
            return true;
        }
        return largest_step > kStepTolerance_n && ++refinements_ <= kMaxRefinements;
    }

    enum class Release { none, unclear, bare, sure };

    // Decides whether held string i is released. wish: slope towards its range. noise: rounding of
    // that slope.
    [[nodiscard]] Release judge_release(std::size_t i, double wish, double noise) const noexcept {
        if (!(wish > -noise)) {
            return Release::none;
        }
        if (wish > noise && wish > kSureMove_n * system_.diagonal(i)) {
            return Release::sure;
        }
        // Near zero the movement of the strings decides.
        const BoxLeastSquares::Release release = system_.release(i);
        double reach = 1.0;
        for (const double value : release.direction) {
            reach = std::max(reach, std::abs(value));
        }
        if (!precise_ && noise * reach > kReleaseMove_n * release.stiffness) {
            return Release::unclear;
        }
        if (wish * reach > kSureMove_n * release.stiffness) {
            return Release::sure;
        }
        return wish * reach > kReleaseMove_n * release.stiffness && bare_releases_ < kBareReleases
                   ? Release::bare
                   : Release::none;
    }

    // At the optimum of the free strings, releases strings whose bound pulls the wrong way: all of
    // them while guessing, later the worst one. Returns false when there is none. step: the last
    // (tiny) step, which gradient_ does not include.
    bool release_strings(const StringArray &step) noexcept {
        const StringArray change = system_.curvature(step);
        const double noise = precise_ ? 0.0 : kGradientRounding * gradient_.largest_force_n;
        double worst = 0.0;
        std::size_t worst_string = kStringCount;
        bool worst_barely = false;
        bool released = false;
        for (std::size_t i = 0; i < kStringCount; ++i) {
            if (has_string(free_, i) || !has_string(movable_, i)) {
                continue;
            }
            const double slope = gradient_.values[i] + change[i];
            const double wish = active_[i] == StringBound::at_lower ? -slope : slope;
            const Release release = judge_release(i, wish, noise);
            if (release == Release::unclear) {
                precise_ = true; // check again in double-double
                return true;
            }
            if (release == Release::none) {
                continue;
            }
            if (guess_rounds_ > 0) {
                released = true;
                let_go(i, release == Release::bare);
            } else if (wish > worst) {
                worst = wish;
                worst_string = i;
                worst_barely = release == Release::bare;
            }
        }
        if (released) {
            --guess_rounds_;
        } else if (worst_string < kStringCount) {
            let_go(worst_string, worst_barely);
            released = true;
        }
        return released;
    }

    const TensionProblem &problem_;
    BoxLeastSquares &system_;
    BoxLeastSquares::Gradient gradient_{};
    StringArray tensions_{};
    ActiveSet active_{};
    StringMask movable_ = 0;
    StringMask free_ = 0;
    bool factored_ = false;
    bool precise_ = false;
    int guess_rounds_ = 0;
    int bare_releases_ = 0;
    int refinements_ = 0;
    int iterations_ = 0;
};

Status check_problem(const TensionProblem &problem) noexcept {
    if (!all_finite(problem.matrix.columns, problem.wrench, problem.weights,
                    problem.proximal_weight, problem.proximal_target_n, problem.lower_n,
                    problem.upper_n)) {
        return Status::not_finite;
    }
    bool ordered = problem.proximal_weight > 0.0;
    for (std::size_t i = 0; i < kStringCount; ++i) {
        ordered = ordered && problem.lower_n[i] <= problem.upper_n[i];
    }
    return ordered ? Status::ok : Status::invalid_settings;
}

// Returns the tensions of a refused problem: the lower bounds where they are valid, never negative,
// never above the upper bounds.
TensionSolution refused(const TensionProblem &problem, Status status) noexcept {
    TensionSolution solution;
    solution.status = status;
    solution.active.fill(StringBound::at_lower);
    for (std::size_t i = 0; i < kStringCount; ++i) {
        const double lower = problem.lower_n[i];
        const double upper = problem.upper_n[i];
        const double most = std::isfinite(upper) && upper > 0.0 ? upper : 0.0;
        const double least = std::isfinite(lower) && lower > 0.0 ? lower : 0.0;
        solution.tensions_n[i] = std::min(least, most);
    }
    return solution;
}

} // namespace

TensionSolution solve_exactly(const TensionProblem &problem, const ActiveSet *warm) noexcept {
    const Status status = check_problem(problem);
    if (!usable(status)) {
        return refused(problem, status);
    }
    BoxLeastSquares system(problem);
    ActiveSetSearch search(problem, system);
    TensionSolution solution;
    const bool solved = search.run(warm, kGuessRounds) || search.run(nullptr, 0);
    solution.tensions_n = search.tensions();
    solution.active = search.active();
    solution.iterations = search.iterations();
    solution.largest_error_n = system.gradient(solution.tensions_n, false).largest_force_n;
    solution.status = solved ? Status::ok : Status::not_converged;
    if (!std::isfinite(system.objective(solution.tensions_n))) {
        return refused(problem, Status::not_converged); // overflow in the computation
    }
    return solution;
}

} // namespace spidar
