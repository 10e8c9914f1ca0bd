// Reliefs: what a repeating image of heights is between its heights, and how it is made coarser.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include "device/contact/relief/relief_map.h"
#include "device/contact/shapes/cooked_shape.h"
#include "device/contact/shapes/tool_shape.h"
#include "support/relief_samples.h"

using namespace spidar;
using namespace spidar::test;

TEST_CASE("relief: waves are waves, lower by what a cubic B-spline smooths") {
    const CookResult made = cook(relief_waves(64, 32, 4, 0));
    REQUIRE(made.shape != nullptr);
    // Of samples of a wave: (4 + 2 cos(step)) / 6 of it, exactly, at the heights themselves.
    const double step = 2.0 * std::numbers::pi * 4.0 / 64.0;
    const double kept = (4.0 + 2.0 * std::cos(step)) / 6.0;
    for (int column = 0; column < 64; ++column) {
        const double u = column / 64.0;
        const ReliefPoint point = relief_point(made.shape->relief(), 0.0, u, 0.123);
        CHECK(point.height ==
              doctest::Approx(0.5 + 0.5 * kept * std::cos(step * column)).epsilon(1e-6));
        CHECK(std::abs(point.slope_v) < 1e-5);
    }
}

TEST_CASE("relief: it repeats, and its slopes are those of its heights") {
    const CookResult made = cook(relief_noise(32, 16, 5));
    REQUIRE(made.shape != nullptr);
    std::mt19937 random(6);
    std::uniform_real_distribution<double> place(-3.0, 3.0);
    constexpr double kStep = 1e-6;
    for (int i = 0; i < 300; ++i) {
        const double u = place(random);
        const double v = place(random);
        const double level = 0.5 * std::abs(place(random));
        const ReliefPoint here = relief_point(made.shape->relief(), level, u, v);
        const ReliefPoint again = relief_point(made.shape->relief(), level, u + 2.0, v - 0.5);
        CHECK(here.height == doctest::Approx(again.height).epsilon(1e-9));
        CHECK(here.height >= 0.0);
        CHECK(here.height <= 1.0);
        const auto height = [&](double du, double dv) {
            return relief_point(made.shape->relief(), level, u + du, v + dv).height;
        };
        CHECK(here.slope_u ==
              doctest::Approx((height(kStep, 0.0) - height(-kStep, 0.0)) / (2.0 * kStep))
                  .epsilon(1e-4));
        CHECK(here.slope_v ==
              doctest::Approx((height(0.0, kStep) - height(0.0, -kStep)) / (2.0 * kStep))
                  .epsilon(1e-4));
    }
}

TEST_CASE("relief: a place that is no place gives some height of the relief") {
    const CookResult made = cook(relief_noise(32, 16, 5));
    REQUIRE(made.shape != nullptr);
    for (const double place : {1e300, -1e300, 1e18, std::numeric_limits<double>::infinity(),
                               -std::numeric_limits<double>::infinity(), std::nan("")}) {
        const ReliefPoint point = relief_point(made.shape->relief(), 0.0, place, place);
        CHECK(point.height >= 0.0);
        CHECK(point.height <= 1.0);
        CHECK(std::isfinite(point.slope_u));
    }
}

TEST_CASE("relief: made coarser, it keeps to the spacing and the curvature that are wanted") {
    const CookResult made = cook(relief_noise(256, 256, 7));
    REQUIRE(made.shape != nullptr);
    CHECK(made.shape->relief().front().columns == 256);
    CHECK(made.shape->relief().back().columns == 8);
    CHECK(relief_coarseness(made.shape->relief(), 0.0, std::numeric_limits<double>::infinity()) ==
          0.0);
    CHECK(relief_coarseness(made.shape->relief(), 1.0 / 64.0, 1e12) == doctest::Approx(2.0));
    CHECK(relief_coarseness(made.shape->relief(), 1.0 / 4.0, 1e12) ==
          doctest::Approx(6.0)); // there is none
    double last = 0.0;
    for (double part = 1.0; part > 0.002; part *= 0.7) {
        const double wanted = part * made.shape->relief().front().most_curvature;
        const double coarseness = relief_coarseness(made.shape->relief(), 0.0, wanted);
        CHECK(coarseness >= last);
        last = coarseness;
        if (wanted < made.shape->relief().back().most_curvature) {
            continue;
        }
        constexpr double kStep = 1e-4;
        double most = 0.0;
        for (int i = 0; i < 2000; ++i) {
            const double u = i / 2000.0;
            const double bend =
                relief_point(made.shape->relief(), coarseness, u + kStep, 0.3).slope_u -
                relief_point(made.shape->relief(), coarseness, u - kStep, 0.3).slope_u;
            most = std::max(most, std::abs(bend) / (2.0 * kStep));
        }
        CAPTURE(part);
        CHECK(most <= wanted);
    }
}

TEST_CASE("relief: it is no solid, and no tool") {
    const CookResult made = cook(relief_waves(16, 16, 2, 0));
    REQUIRE(made.shape != nullptr);
    CHECK_FALSE(made.shape->convex());
    CHECK(made.shape->bytes() > 2 * 16 * 16 * sizeof(float)); // the heights, and their copy
    CHECK_FALSE(usable(make_tool(*made.shape, 0.001).status));
}

TEST_CASE("relief: a description without sense is refused with what is wrong") {
    CHECK(cook(relief_of(3, 8, std::vector<float>(24))).status == Status::invalid_shape);
    CHECK(cook(relief_of(8, 2000, std::vector<float>(16000))).status == Status::invalid_shape);
    CHECK(cook(relief_of(8, 8, std::vector<float>(63))).status == Status::invalid_shape);
    std::vector<float> heights(64, 0.5F);
    heights[9] = 1.5F;
    CHECK(cook(relief_of(8, 8, heights)).sentence ==
          "A height of a relief is outside 0 to 1; give heights from 0 to 1.");
    heights[9] = std::numeric_limits<float>::quiet_NaN();
    CHECK(cook(relief_of(8, 8, heights)).status == Status::not_finite);
}
