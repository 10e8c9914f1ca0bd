#include <doctest/doctest.h>

#include <algorithm>

#include "core/kinematics/search/pose_polish.h"
#include "core/kinematics/steps/crossed_step.h"
#include "core/kinematics/steps/gauss_newton.h"
#include "support/pose_helpers.h"

using namespace spidar;
using test::kDeg;

namespace {

CrossedLayout layout_of(const GripGeometry &grip) {
    CrossedLayout layout;
    REQUIRE(make_layout(test::paper_frame(), grip, layout));
    return layout;
}

GripPose nearby(const GripPose &pose, test::Random &random, double size_m, double d) {
    const auto shift = [&] {
        return Vec3(random.between(-size_m, size_m), random.between(-size_m, size_m),
                    random.between(-size_m, size_m));
    };
    return {pose.position_m + shift(), d * glm::normalize(pose.r1_m + shift()),
            d * glm::normalize(pose.r2_m + shift())};
}

} // namespace

TEST_CASE("crossed step: the same step and pivots as the general one, for any two strings an end") {
    const FrameGeometry frame = test::paper_frame();
    test::Random random(61);
    for (int i = 0; i < 1000; ++i) {
        GripGeometry grip;
        if (i % 2 == 1) { // the eight ties in any order
            for (std::size_t k = kStringCount - 1; k > 0; --k) {
                const auto other =
                    static_cast<std::size_t>(random.between(0.0, static_cast<double>(k) + 0.999));
                std::swap(grip.attachments[k], grip.attachments[other]);
            }
        }
        const double d = grip.pole_half_length_m;
        const CrossedLayout layout = layout_of(grip);
        const GripPose truth = random.pose(grip, 0.2, 45.0 * kDeg);
        const StringArray lengths = string_lengths(frame, grip, truth);
        const GripPose start = nearby(truth, random, 2e-3, d);

        const LengthProblem problem{frame, grip, lengths};
        GripPose expected = start;
        const GaussNewtonStep general =
            gauss_newton_step(problem, length_errors(problem, start), expected);
        const CrossedErrors errors = errors_at(layout, lengths, lanes_of(start));
        const CrossedFactor factor = factorise(errors, lanes_of(start), d);
        REQUIRE(factor.solvable == general.solvable);
        if (general.min_pivot < 1e-4) { // rounding over the pivot hides the comparison
            continue;
        }
        const CrossedStep step = solve(factor, errors);
        CAPTURE(i);
        CHECK(factor.min_pivot == doctest::Approx(general.min_pivot).epsilon(1e-8));
        CHECK(std::sqrt(step.size_m2) == doctest::Approx(general.step_m).epsilon(1e-9));
        CHECK(test::distance(pose_of(moved(lanes_of(start), step, d)), expected) <
              1e-12 * general.step_m / general.min_pivot);
    }
}

TEST_CASE("crossed step: the sum of squares falls by what the linear model says") {
    const FrameGeometry frame = test::paper_frame();
    const GripGeometry grip;
    const CrossedLayout layout = layout_of(grip);
    test::Random random(63);
    for (int i = 0; i < 300; ++i) {
        const GripPose truth = random.pose(grip, 0.15, 30.0 * kDeg);
        StringArray lengths = string_lengths(frame, grip, truth);
        for (double &length : lengths) {
            length += random.between(-1e-5, 1e-5);
        }
        const CrossedErrors errors = errors_at(layout, lengths, lanes_of(truth));
        const CrossedStep step =
            solve(factorise(errors, lanes_of(truth), grip.pole_half_length_m), errors);
        const CrossedPose after = moved(lanes_of(truth), step, grip.pole_half_length_m);
        const double left = errors_at(layout, lengths, after).sum_of_squares_m2;
        CHECK(std::fabs(errors.sum_of_squares_m2 - step.decrease_m2 - left) <
              1e-2 * errors.sum_of_squares_m2);
    }
}

TEST_CASE("crossed step: a factorisation from nearby ends at the same least-squares pose") {
    const FrameGeometry frame = test::paper_frame();
    const GripGeometry grip;
    const double d = grip.pole_half_length_m;
    const CrossedLayout layout = layout_of(grip);
    test::Random random(67);
    for (int i = 0; i < 300; ++i) {
        const GripPose truth = random.pose(grip, 0.15, 30.0 * kDeg);
        StringArray lengths = string_lengths(frame, grip, truth);
        for (double &length : lengths) {
            length += random.between(-1e-3, 1e-3);
        }
        CrossedPose best = lanes_of(truth);
        for (int k = 0; k < 40; ++k) {
            const CrossedErrors errors = errors_at(layout, lengths, best);
            best = moved(best, solve(factorise(errors, best, d), errors), d);
        }
        const CrossedPose elsewhere = lanes_of(nearby(pose_of(best), random, 1e-4, d));
        const CrossedFactor factor = factorise(errors_at(layout, lengths, elsewhere), elsewhere, d);
        const CrossedErrors errors = errors_at(layout, lengths, best);
        CAPTURE(i);
        CHECK(std::sqrt(solve_nearby(factor, errors, best).size_m2) < 1e-15 / factor.min_pivot);
    }
}

TEST_CASE(
    "crossed step: with the curvature of the lengths steps converge quadratically, errors or not") {
    const FrameGeometry frame = test::paper_frame();
    const GripGeometry grip;
    const double d = grip.pole_half_length_m;
    const CrossedLayout layout = layout_of(grip);
    test::Random random(68);
    int plain_unfinished = 0;
    for (int i = 0; i < 300; ++i) {
        const GripPose truth = random.pose(grip, 0.15, 30.0 * kDeg);
        StringArray lengths = string_lengths(frame, grip, truth);
        for (double &length : lengths) {
            length += random.between(-1e-3, 1e-3);
        }
        const PolishResult best = polish_pose({frame, grip, lengths}, truth);
        REQUIRE(best.converged);
        const CrossedPose start = lanes_of(nearby(best.pose, random, 1e-4, d));
        const CrossedErrors errors = errors_at(layout, lengths, start);
        const CrossedFactor curved = factorise_curved(errors, start, d);
        REQUIRE(curved.solvable);
        const CrossedStep newton = solve(curved, errors);
        const double before = test::distance(pose_of(start), best.pose);
        const double left = test::distance(pose_of(moved(start, newton, d)), best.pose);
        CAPTURE(i);
        CHECK(left < 4.0 * kLengthCurvature * before * before / curved.min_pivot);
        // Three steps end where plain Gauss-Newton, bent by the residual, still has some way to go.
        CrossedPose three = moved(start, newton, d);
        CrossedPose plain = moved(start, solve(factorise(errors, start, d), errors), d);
        for (int k = 0; k < 2; ++k) {
            const CrossedErrors at_three = errors_at(layout, lengths, three);
            three = moved(three, solve(factorise_curved(at_three, three, d), at_three), d);
            const CrossedErrors at_plain = errors_at(layout, lengths, plain);
            plain = moved(plain, solve(factorise(at_plain, plain, d), at_plain), d);
        }
        CHECK(test::distance(pose_of(three), best.pose) < 1e-13 / curved.min_pivot);
        plain_unfinished += test::distance(pose_of(plain), best.pose) > 1e-11 ? 1 : 0;
    }
    CHECK(plain_unfinished > 100);
    // Exact lengths have no residual to bend anything: the same matrix.
    const GripPose rest = rest_pose(grip);
    const StringArray lengths = string_lengths(frame, grip, rest);
    const CrossedErrors none = errors_at(layout, lengths, lanes_of(rest));
    CHECK(factorise_curved(none, lanes_of(rest), d).min_pivot ==
          doctest::Approx(factorise(none, lanes_of(rest), d).min_pivot).epsilon(1e-12));
}

TEST_CASE("crossed step: three strings at an end are left to the general method") {
    GripGeometry grip;
    grip.attachments[0] = {0, -1.0};
    CrossedLayout layout;
    CHECK_FALSE(make_layout(test::paper_frame(), grip, layout));
}
