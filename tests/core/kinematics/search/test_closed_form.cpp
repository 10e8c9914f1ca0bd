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
