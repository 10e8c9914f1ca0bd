// Wrench closure and the feasible scale of a request, against A itself and against the tension solver.
#include <algorithm>
#include <cmath>

#include <doctest/doctest.h>

#include "core/analysis/wrench_closure.h"
#include "support/problem_generator.h"

using namespace spidar;

namespace {

WrenchMatrix matrix_at(const GripPose &pose) {
    return wrench_matrix(make_box_frame(Vec3(kPaperHalfExtent_m)), GripGeometry{}, pose);
}

// Largest weighted element of A tau - q at the best tensions there are.
double best_error(const WrenchMatrix &matrix, const PaperWrench &wrench) {
    TensionProblem p;
    p.matrix = matrix;
    p.wrench = wrench;
    p.weights = {1, 1, 1, 25, 25, 25, 25};
    p.proximal_weight = 1e-12;
    p.lower_n.fill(TensionSettings{}.min_tension_n);
    p.upper_n.fill(TensionSettings{}.max_tension_n);
    p.proximal_target_n.fill(1.0);
    const PaperWrench given = spidar::apply(matrix, solve_tension_problem(p, nullptr).tensions_n);
    double largest = 0.0;
    for (std::size_t k = 0; k < given.size(); ++k) {
        largest = std::max(largest, std::abs(p.weights[k] * (given[k] - wrench[k])));
    }
    return largest;
}

} // namespace

TEST_CASE("wrench closure: at rest all strings share alike, and the null tensions give nothing") {
    const WrenchMatrix rest = matrix_at(rest_pose(GripGeometry{}));
    CHECK(wrench_closure(rest, {}).margin == doctest::Approx(1.0).epsilon(1e-9));
    test::Random random(5);
    int closed = 0;
    for (int i = 0; i < 300; ++i) {
        GripPose pose = test::random_pose(random, 0.1, random.uniform(0.6, 2.4));
        if (i % 2 == 0) { // upright: nearly always closed
            pose.r1_m = rest_pose(GripGeometry{}).r1_m;
            pose.r2_m = rest_pose(GripGeometry{}).r2_m;
        }
        const WrenchMatrix matrix = matrix_at(pose);
        const WrenchClosure closure = wrench_closure(matrix, {});
        for (const double component : spidar::apply(matrix, closure.null_tensions)) {
            CHECK(std::abs(component) < 1e-11);
        }
        const auto [low, high] =
            std::minmax_element(closure.null_tensions.begin(), closure.null_tensions.end());
        CHECK(*high == doctest::Approx(1.0));
        CHECK(closure.margin == doctest::Approx(std::max(*low, 0.0)));
        closed += closure.margin > 0.0 ? 1 : 0;
    }
    CHECK(closed > 10); // both kinds were met
    CHECK(closed < 290);
}

TEST_CASE(
    "wrench closure: lost with a broken string, parallel poles or numbers that are not finite") {
    const WrenchMatrix rest = matrix_at(rest_pose(GripGeometry{}));
    TensionSettings broken;
    broken.broken_mask = 4;
    CHECK(wrench_closure(rest, broken).margin == 0.0);
    CHECK_FALSE(feasible_scale(rest, {1, 0, 0, 0, 0, 0, 0}, broken).any);
    GripPose parallel = rest_pose(GripGeometry{});
    parallel.r2_m = parallel.r1_m;
    CHECK(wrench_closure(matrix_at(parallel), {}).margin == 0.0);
    WrenchMatrix bad = rest;
    bad.columns[3][2] = std::nan("");
    CHECK(wrench_closure(bad, {}).margin == 0.0);
    CHECK_FALSE(feasible_scale(rest, {HUGE_VAL, 0, 0, 0, 0, 0, 0}, {}).any);
}

TEST_CASE("feasible scale: just below it the request is met, just above it is not") {
    test::Random random(9);
    int tried = 0;
    for (int i = 0; i < 200; ++i) {
        const WrenchMatrix matrix =
            matrix_at(test::random_pose(random, 0.1, random.uniform(0.8, 2.2)));
        StringArray tensions{};
        for (double &tension : tensions) {
            tension = random.uniform(0.5, 9.0);
        }
        const PaperWrench q = spidar::apply(matrix, tensions); // so that 1 is feasible
        const FeasibleScale scale = feasible_scale(matrix, q, {});
        CAPTURE(i);
        REQUIRE(scale.any);
        CHECK(scale.least <= 1.0 + 1e-9);
        CHECK(scale.largest >= 1.0 - 1e-9);
        const auto times = [&q](double factor) {
            PaperWrench scaled = q;
            for (double &component : scaled) {
                component *= factor;
            }
            return scaled;
        };
        CHECK(best_error(matrix, times(scale.largest * (1.0 - 1e-6))) < 1e-6);
        CHECK(best_error(matrix, times(scale.largest * 1.01)) > 1e-4);
        ++tried;
    }
    CHECK(tried == 200);
    const WrenchMatrix rest = matrix_at(rest_pose(GripGeometry{}));
    const FeasibleScale nothing = feasible_scale(rest, {}, {});
    CHECK(nothing.any);
    CHECK(std::isinf(nothing.largest));
}

TEST_CASE(
    "wrench closure under a mask: forces alone close where all seven DOF do, and further out") {
    test::Random random(8);
    TensionSettings forces;
    forces.dof_mask = kTranslationOnly;
    int wider = 0;
    for (int round = 0; round < 60; ++round) {
        const WrenchMatrix matrix =
            matrix_at(test::random_pose(random, 0.1, random.uniform(0.7, 2.4)));
        const WrenchClosure all = wrench_closure(matrix, {});
        const WrenchClosure masked = wrench_closure(matrix, forces);
        CAPTURE(round);
        CHECK(masked.margin >= all.margin - 1e-6);
        wider += masked.margin > 0.0 && all.margin == 0.0 ? 1 : 0;
        if (masked.margin > 0.0) {
            const PaperWrench left = apply(matrix, masked.null_tensions);
            const auto [least, most] =
                std::minmax_element(masked.null_tensions.begin(), masked.null_tensions.end());
            CHECK(*least >= masked.margin - 1e-6);
            CHECK(*most <= 1.0);
            for (std::size_t k = 0; k < 3; ++k) {
                CHECK(std::abs(left[k]) < 1e-8);
            }
        }
    }
    CHECK(wider > 10);
}

TEST_CASE("feasible scale under a mask or with a broken string: given up to there and not beyond") {
    test::Random random(9);
    int given = 0;
    for (int round = 0; round < 40; ++round) {
        TensionSettings settings;
        settings.dof_mask = round % 2 == 0 ? kTranslationOnly : kAllDofs;
        settings.broken_mask = round % 4 == 1 ? 16 : 0;
        const WrenchMatrix matrix = matrix_at(rest_pose(GripGeometry{}));
        PaperWrench q{};
        for (std::size_t k = 0; k < q.size(); ++k) {
            q[k] = random.uniform(-1.0, 1.0) * (k < 3 ? 1.0 : 0.02);
        }
        const FeasibleScale scale = feasible_scale(matrix, q, settings);
        CAPTURE(round);
        if (!scale.any) {
            CHECK(settings.broken_mask != 0);
            continue;
        }
        ++given;
        const auto error_at = [&](double s) {
            TensionProblem problem;
            problem.matrix = matrix;
            problem.weights = tension_weights(settings);
            problem.proximal_weight = 1e-10;
            for (std::size_t k = 0; k < q.size(); ++k) {
                problem.wrench[k] = s * q[k];
            }
            for (std::size_t i = 0; i < problem.lower_n.size(); ++i) {
                const bool works = ((settings.broken_mask >> i) & 1) == 0;
                problem.lower_n[i] = works ? settings.min_tension_n : 0.0;
                problem.upper_n[i] = works ? settings.max_tension_n : 0.0;
            }
            return solve_exactly(problem, nullptr).largest_error_n;
        };
        CHECK(error_at(scale.largest) < 1e-6);
        CHECK(error_at(scale.largest * 1.001 + 1e-3) > 1e-6);
        CHECK(error_at(0.5 * (scale.least + scale.largest)) < 1e-6);
    }
    CHECK(given >= 20);
}
