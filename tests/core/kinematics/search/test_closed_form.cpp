#include <doctest/doctest.h>

#include <limits>

#include "core/kinematics/search/closed_form.h"
#include "support/pose_helpers.h"

using namespace spidar;
using test::kDeg;

namespace {

GripPose root_pair(const StringArray &lengths, int pair) {
    return test::closed_form_pose(Vec3(kPaperHalfExtent_m), kPaperPoleHalfLength_m, lengths, pair);
}

} // namespace

TEST_CASE("closed form: one root pair is the pose, mostly the upright one") {
    const GripGeometry grip;
    test::Random random(3);
    int right_pair[kRootPairCount] = {};
    constexpr int kPoses = 2000;
    for (int i = 0; i < kPoses; ++i) {
        const GripPose truth = random.pose(grip, 0.2, 60.0 * kDeg);
        const StringArray lengths = string_lengths(test::paper_frame(), grip, truth);
        int found = -1;
        for (int pair = 0; pair < kRootPairCount && found < 0; ++pair) {
            if (test::distance(root_pair(lengths, pair), truth) < 1e-6) {
                found = pair;
            }
        }
        CAPTURE(i);
        REQUIRE(found >= 0);
        ++right_pair[found];
    }
    CHECK(right_pair[0] > kPoses / 2);
    CHECK(right_pair[1] > 0); // pole 1 flipped
    CHECK(right_pair[2] > 0); // pole 2 flipped
}

TEST_CASE("closed form: always finite and on the spheres") {
    test::Random random(4);
    for (int i = 0; i < 4000; ++i) {
        StringArray lengths{};
        for (double &length : lengths) {
            length = random.between(0.0, 2.0);
        }
        if (i == 0) {
            lengths.fill(0.4);
        }
        for (int pair = 0; pair < kRootPairCount; ++pair) {
            const GripPose pose = root_pair(lengths, pair);
            CHECK(std::isfinite(glm::dot(pose.position_m, pose.position_m)));
            CHECK(std::fabs(glm::length(pose.r1_m) - kPaperPoleHalfLength_m) < 1e-16);
            CHECK(std::fabs(glm::length(pose.r2_m) - kPaperPoleHalfLength_m) < 1e-16);
        }
    }
}

TEST_CASE("closed form: only the paper's attachments qualify") {
    GripGeometry grip;
    CHECK(has_paper_attachments(grip));
    grip.attachments[0].sign = -1.0;
    CHECK_FALSE(has_paper_attachments(grip));
    grip.attachments[0] = {1, 1.0};
    CHECK_FALSE(has_paper_attachments(grip));
}

TEST_CASE("closed form: the misfit is nothing for the true pair and foretells the residual of the "
          "others") {
    const GripGeometry grip;
    const FrameGeometry frame = test::paper_frame();
    test::Random random(8);
    int wrong = 0;
    for (int i = 0; i < 1000; ++i) {
        const GripPose truth = random.pose(grip, 0.15, 30.0 * kDeg);
        const StringArray lengths = string_lengths(frame, grip, truth);
        const ClosedForm form =
            solve_closed_form(Vec3(kPaperHalfExtent_m), grip.pole_half_length_m, lengths);
        for (int pair = 0; pair < kRootPairCount; ++pair) {
            const RootPairPose found = root_pair_pose(form, pair);
            const bool right = test::distance(pose_of(found.pose), truth) < 1e-9;
            CAPTURE(i);
            if (right) {
                CHECK(found.misfit_m < 1e-9);
            } else if (found.misfit_m > 1e-2) {
                ++wrong;
                const StringArray computed = string_lengths(frame, grip, pose_of(found.pose));
                double worst = 0.0;
                for (std::size_t k = 0; k < kStringCount; ++k) {
                    worst = std::fmax(worst, std::fabs(computed[k] - lengths[k]));
                }
                CHECK(worst > 1e-4);
            }
        }
    }
    CHECK(wrong > 0);
}

TEST_CASE("closed form: the forecast is nothing for the true pair, never negative, and near the "
          "misfit of small errors") {
    const GripGeometry grip;
    const FrameGeometry frame = test::paper_frame();
    test::Random random(9);
    int compared = 0;
    double worst = 0.0;
    for (int i = 0; i < 1000; ++i) {
        const GripPose truth = random.pose(grip, 0.12, 25.0 * kDeg);
        StringArray lengths = string_lengths(frame, grip, truth);
        const auto form_of = [&](const StringArray &of) {
            return solve_closed_form(Vec3(kPaperHalfExtent_m), grip.pole_half_length_m, of);
        };
        const ClosedForm form = form_of(lengths);
        const RootHeights heights = root_heights(form);
        for (std::size_t flipped = 0; flipped < 2; ++flipped) {
            for (std::size_t face = 0; face < 2; ++face) {
                CHECK(heights.slope_m[flipped][face] >= 0.0);
            }
        }
        for (int pair = 0; pair < kRootPairCount; ++pair) {
            const MisfitForecast forecast = forecast_misfit(heights, grip.pole_half_length_m, pair);
            CHECK(forecast.misfit_m >= 0.0);
            CHECK(forecast.gain > 1.0);
            const RootPairPose found = root_pair_pose(form, pair);
            if (test::distance(pose_of(found.pose), truth) < 1e-9) {
                CHECK(forecast.misfit_m < 1e-7);
            }
        }
        // Lengths with an error: of the true pair, what the forecast says lies near what is left once the errors are
        // shared out (KinematicsResult: the best pose's residual), within the forecast's own gain.
        lengths[static_cast<std::size_t>(i % kStringCount)] += 1e-4;
        const RootHeights moved = root_heights(form_of(lengths));
        const double least = forecast_misfit(moved, grip.pole_half_length_m, 0).misfit_m;
        ++compared;
        worst = std::fmax(worst, least);
    }
    CHECK(compared == 1000);
    CHECK(worst > 1e-6); // an error is seen
    CHECK(worst < 1e-2); // and not blown up beyond its gain
}
