// TensionReport: where the wrench that is asked for and not given went.
#include <cmath>

#include <doctest/doctest.h>

#include "core/tension/tension_report.h"
#include "support/problem_generator.h"

using namespace spidar;

namespace {

constexpr std::size_t kStrings = 8;
constexpr std::size_t kDofs = 7;

WrenchMatrix matrix_at(const GripPose &pose) {
    return wrench_matrix(make_box_frame(Vec3(kPaperHalfExtent_m)), GripGeometry{}, pose);
}

PaperWrench random_wrench(test::Random &random, double size) {
    PaperWrench wrench{};
    for (std::size_t k = 0; k < kDofs; ++k) {
        wrench[k] = random.uniform(-size, size) * (k < 3 ? 1.0 : 0.04);
    }
    return wrench;
}

// Ticks until the change term has died out.
StringArray settled(const TensionSettings &settings, const WrenchMatrix &matrix,
                    const PaperWrench &wrench) {
    TensionSolver solver;
    REQUIRE(solver.configure(settings) == Status::ok);
    TensionResult result;
    for (int tick = 0; tick < 12000 && !result.skipped; ++tick) {
        result = solver.update(matrix, wrench);
    }
    return result.tensions_n;
}

double weighed(const PaperWrench &values) {
    double largest = 0.0;
    for (std::size_t k = 0; k < kDofs; ++k) {
        largest = std::max(largest, std::abs(values[k]) * (k < 3 ? 1.0 : 25.0));
    }
    return largest;
}

} // namespace

TEST_CASE("tension report: the shares add up to the error; at rest nothing is transient") {
    test::Random random(12);
    int limited = 0;
    int at_bounds = 0;
    double most_reference = 0.0;
    for (int round = 0; round < 60; ++round) {
        TensionSettings settings;
        settings.reference_weight = round % 2 == 0 ? 1e-3 : 1e-2;
        settings.broken_mask = round % 10 == 9 ? 1 : 0;
        const WrenchMatrix matrix = matrix_at(
            round % 2 == 0 ? make_pose(GripGeometry{}, Vec3(random.uniform(-0.03, 0.03), 0.0, 0.01),
                                       Mat3(1.0), random.uniform(-0.2, 0.2))
                           : test::random_pose(random, 0.1, random.uniform(0.7, 2.4)));
        const PaperWrench wrench = random_wrench(random, round % 3 == 0 ? 20.0 : 0.5);
        const StringArray tensions = settled(settings, matrix, wrench);
        const TensionReport report = tension_report(matrix, wrench, tensions, settings);
        CAPTURE(round);
        REQUIRE(usable(report.status));
        const PaperWrench given = apply(matrix, tensions);
        const PaperWrench bias = report.bias();
        for (std::size_t k = 0; k < kDofs; ++k) {
            CHECK(report.achieved[k] == given[k]);
            CHECK(report.error[k] == given[k] - wrench[k]);
            CHECK(bias[k] == report.ridge[k] + report.reference[k]);
            const double sum = report.limits[k] + bias[k] + report.transient[k];
            CHECK(std::abs(report.error[k] - sum) < 1e-12);
        }
        CHECK(weighed(report.transient) < 1e-9);
        CHECK((report.status == Status::wrench_limited) ==
              (weighed(report.limits) > kNoticeableLimit_n));
        limited += report.status == Status::wrench_limited ? 1 : 0;
        at_bounds += report.at_min_mask != 0 || report.at_max_mask != 0 ? 1 : 0;
        most_reference = std::max(most_reference, weighed(report.reference));
    }
    CHECK(limited > 10);
    CHECK(limited < 50);
    CHECK(at_bounds > limited);
    CHECK(most_reference > 1e-3); // there was something to report
}

TEST_CASE("tension report: each share is what dropping its term takes away, bounds included") {
    test::Random random(14);
    for (int round = 0; round < 40; ++round) {
        TensionSettings settings;
        settings.ridge = 1e-3;
        settings.reference_weight = 5e-3;
        settings.reference_tension_n = 2.0;
        settings.change_weight = 0.0;
        const WrenchMatrix matrix =
            matrix_at(test::random_pose(random, 0.05, random.uniform(0.9, 2.2)));
        const PaperWrench wrench = random_wrench(random, 2.0);
        const StringArray tensions = settled(settings, matrix, wrench);
        const TensionReport report = tension_report(matrix, wrench, tensions, settings);
        TensionSettings less = settings;
        less.reference_weight = 0.0;
        const PaperWrench ridge_only = apply(matrix, settled(less, matrix, wrench));
        less.ridge = 1e-11;
        const PaperWrench bare = apply(matrix, settled(less, matrix, wrench));
        CAPTURE(round);
        for (std::size_t k = 0; k < kDofs; ++k) {
            CHECK(std::abs(report.reference[k] - (report.achieved[k] - ridge_only[k])) < 1e-8);
            CHECK(std::abs(report.ridge[k] - (ridge_only[k] - bare[k])) < 1e-7);
            CHECK(std::abs(report.limits[k] - (bare[k] - wrench[k])) < 1e-7);
        }
    }
}

TEST_CASE("tension report: the change term's share is transient, and gone when it has settled") {
    const GripGeometry grip;
    const WrenchMatrix matrix = matrix_at(make_pose(grip, Vec3(0.05, 0.02, 0.0), Mat3(1.0), 0.1));
    const PaperWrench wrench{0.0, 3.0, 0.0, 0.0, 0.02, 0.0, 0.0};
    TensionSettings settings;
    TensionSolver solver;
    REQUIRE(solver.configure(settings) == Status::ok);
    solver.update(matrix, PaperWrench{});
    const TensionReport early =
        tension_report(matrix, wrench, solver.update(matrix, wrench).tensions_n, settings);
    const TensionReport late =
        tension_report(matrix, wrench, settled(settings, matrix, wrench), settings);
    CHECK(weighed(early.transient) > 1e-3);
    CHECK(weighed(late.transient) < 1e-9);
    for (std::size_t k = 0; k < kDofs; ++k) {
        CHECK(std::abs(early.reference[k] - late.reference[k]) < 1e-9); // a steady share is steady
    }
}

TEST_CASE("tension report: what no string can give is a limit and no bias of the terms") {
    // Parallel poles: g about their common normal is lost.
    GripPose pose = rest_pose(GripGeometry{});
    pose.r2_m = pose.r1_m;
    const WrenchMatrix matrix = matrix_at(pose);
    PaperWrench wrench{};
    wrench[6] = 0.05;
    const TensionSettings settings;
    const TensionReport report =
        tension_report(matrix, wrench, settled(settings, matrix, wrench), settings);
    CHECK(report.status == Status::wrench_limited);
    CHECK(report.limits[6] == doctest::Approx(-0.05));
    CHECK(std::abs(report.bias()[6]) < 1e-6);
}

TEST_CASE("tension report: input that is not finite is refused with zeros") {
    const WrenchMatrix matrix = matrix_at(rest_pose(GripGeometry{}));
    const TensionSettings settings;
    StringArray tensions{};
    tensions.fill(1.0);
    const double bad_values[] = {std::nan(""), HUGE_VAL};
    for (const double bad : bad_values) {
        PaperWrench wrench{};
        wrench[2] = bad;
        WrenchMatrix broken = matrix;
        broken.columns[3][4] = bad;
        StringArray sent = tensions;
        sent[5] = bad;
        for (const TensionReport &report :
             {tension_report(matrix, wrench, tensions, settings),
              tension_report(broken, PaperWrench{}, tensions, settings),
              tension_report(matrix, PaperWrench{}, sent, settings)}) {
            CHECK_FALSE(usable(report.status));
            CHECK(report.achieved == PaperWrench{});
            CHECK(report.error == PaperWrench{});
        }
    }
    TensionSettings wrong;
    wrong.max_tension_n = -1.0;
    CHECK(tension_report(matrix, PaperWrench{}, tensions, wrong).status ==
          Status::invalid_settings);
}
