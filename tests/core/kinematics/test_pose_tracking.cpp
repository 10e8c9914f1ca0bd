// Strings that err by millimetres, as those of a device that is not calibrated do: the pose follows the hand without a
// jump, and another answer is gone to in steps.
#include <doctest/doctest.h>

#include <cmath>

#include "core/kinematics/forward_kinematics.h"
#include "core/kinematics/search/pose_polish.h"
#include "core/presets/presets.h"
#include "support/pose_helpers.h"

using namespace spidar;

namespace {

// Trajectory T1, as in test_forward_kinematics.cpp.
GripPose trajectory_t1(const GripGeometry &grip, double t) {
    const Vec3 position(0.15 * std::sin(3.1 * t), 0.15 * std::sin(2.3 * t + 1.0),
                        0.12 * std::sin(2.9 * t + 2.0));
    const Mat3 rotation = test::rotation_zyx(0.6 * std::sin(4.1 * t), 0.6 * std::sin(3.7 * t + 1.0),
                                             0.5 * std::sin(3.3 * t + 2.0));
    return make_pose(grip, position, rotation, -0.5 * std::sin(2.1 * t));
}

double length2(const CrossedPose &change) {
    return dot(change.position_m, change.position_m)[0] +
           sum_of(dot(change.poles_m, change.poles_m));
}

} // namespace

TEST_CASE("motion prior: nothing known and exact lengths weigh nothing, errors weigh by their "
          "square") {
    MotionPrior prior;
    CHECK(prior.weight() == 0.0);
    for (int tick = 0; tick < 1000; ++tick) {
        prior.learn(8.0 * 1e-30, CrossedPose());
    }
    CHECK(prior.weight() == 0.0);
    CHECK(prior.length_sigma_m() < 1e-14);
    // A level that stays is met exactly, from below within 200 ticks, and the weight is (sigma / sigma of the motion)^2.
    for (int tick = 0; tick < 200; ++tick) {
        prior.learn(9e-6, CrossedPose());
    }
    CHECK(prior.length_sigma_m() == doctest::Approx(3e-3).epsilon(1e-3));
    CHECK(prior.weight() == doctest::Approx(1.0).epsilon(1e-3));
    // One length is redundant: a residual that passes through zero does not make the others exact.
    for (int tick = 0; tick < 50; ++tick) {
        prior.learn(0.0, CrossedPose());
    }
    CHECK(prior.length_sigma_m() > 2.9e-3);
    for (int tick = 0; tick < 20000; ++tick) {
        prior.learn(0.0, CrossedPose());
    }
    CHECK(prior.weight() == 0.0);
    prior.begin(1.0);
    CHECK(prior.weight() == MotionPrior::kMostWeight);
    prior.restart();
    CHECK(prior.weight() == 0.0);
}

TEST_CASE("motion prior: the expected movement is the mean one, and the first difference is none") {
    MotionPrior prior;
    CrossedPose jump;
    jump.position_m = {both(0.1), both(0.0), both(0.0)};
    prior.learn(0.0, jump);
    CHECK(length2(prior.expected_change()) == 0.0);
    CrossedPose change;
    change.position_m = {both(1e-4), both(-2e-4), both(0.0)};
    change.poles_m.z = Lanes{3e-4, 0.0};
    for (int tick = 0; tick < 400; ++tick) {
        prior.learn(0.0, change);
    }
    const CrossedPose &expected = prior.expected_change();
    CHECK(length2({expected.position_m - change.position_m, expected.poles_m - change.poles_m}) <
          1e-20);
    prior.forget_motion();
    CHECK(length2(prior.expected_change()) == 0.0);
}

TEST_CASE("pose blend: goes to another pose in steps while that moves, also to a mirrored pole") {
    const GripGeometry grip;
    const double d = grip.pole_half_length_m;
    const GripPose from = make_pose(grip, Vec3(0.01, 0.02, 0.03), Mat3(1.0), 0.1);
    GripPose to = from;
    to.r1_m = -to.r1_m;
    to.position_m += Vec3(0.03, 0.0, -0.02);
    PoseBlend blend;
    CHECK_FALSE(blend.active());
    blend.start(from, to);
    GripPose before = from;
    int ticks = 0;
    while (blend.active()) {
        to.position_m += Vec3(2e-4, 0.0, 0.0);
        const GripPose shown = blend.next(to);
        ++ticks;
        REQUIRE(ticks <= PoseBlend::kLongest_ticks);
        CHECK(glm::distance(shown.position_m, before.position_m) < 1e-3);
        CHECK(glm::distance(shown.r1_m, before.r1_m) < 1.3e-3);
        CHECK(glm::length(shown.r1_m) == doctest::Approx(d));
        before = shown;
    }
    CHECK(ticks > 100);
    CHECK(test::distance(before, to) == 0.0);
}

TEST_CASE("kinematics: strings that err by +-5 mm and stay so move the pose by no jump") {
    const FrameGeometry frame = test::paper_frame();
    const GripGeometry grip;
    for (const double size_m : {3e-3, 5e-3}) {
        for (int run = 0; run < 6; ++run) {
            ForwardKinematics kinematics;
            REQUIRE(kinematics.configure(frame, grip) == Status::ok);
            // Seeds 1 to 6; of stress_tracking's first twenty runs one in ten used to jump by 20 mm.
            test::Random random(static_cast<std::uint64_t>(run) + 1);
            StringArray errors{};
            for (double &error : errors) {
                error = random.between(-size_m, size_m);
            }
            GripPose hand = trajectory_t1(grip, 0.0);
            GripPose shown = hand;
            kinematics.set_last_pose(hand);
            int searches = 0;
            double worst = 0.0;
            for (int tick = 1; tick <= 6000; ++tick) {
                const GripPose truth = trajectory_t1(grip, 1e-3 * tick);
                StringArray lengths = string_lengths(frame, grip, truth);
                for (std::size_t i = 0; i < lengths.size(); ++i) {
                    lengths[i] += errors[i];
                }
                const KinematicsResult result = kinematics.update(lengths);
                REQUIRE(usable(result.status));
                searches += result.cold_start ? 1 : 0;
                if (tick > 50) {
                    worst =
                        std::fmax(worst, glm::distance(result.pose.position_m - shown.position_m,
                                                       truth.position_m - hand.position_m));
                    worst = std::fmax(worst, glm::distance(result.pose.r1_m - shown.r1_m,
                                                           truth.r1_m - hand.r1_m));
                    worst = std::fmax(worst, glm::distance(result.pose.r2_m - shown.r2_m,
                                                           truth.r2_m - hand.r2_m));
                }
                shown = result.pose;
                hand = truth;
            }
            CAPTURE(size_m);
            CAPTURE(run);
            CHECK(worst < 1e-3);
            CHECK(searches <= 2); // at the start, where nothing is known of the errors
        }
    }
}

TEST_CASE("kinematics: nor do they with exit pulleys, other motors or a rigid grip") {
    FrameGeometry pulleys = test::paper_frame();
    pulleys.pulley_radius_m = 0.005;
    FrameGeometry bent = test::paper_frame();
    bent.motors_m[0] += Vec3(0.03, -0.02, 0.01);
    bent.motors_m[5] += Vec3(-0.02, 0.02, -0.03);
    bent.motors_m[6] += Vec3(0.01, 0.03, 0.02);
    const DevicePreset rigid = device_preset(Preset::spidar_g6_x3r);
    const struct {
        FrameGeometry frame;
        GripGeometry grip;
        double reach; // of T1
    } devices[] = {{pulleys, GripGeometry(), 1.0},
                   {bent, GripGeometry(), 1.0},
                   {rigid.frame, rigid.grip, 0.3}};
    for (const auto &device : devices) {
        const auto hand_at = [&](double t) {
            const GripPose pose = trajectory_t1(GripGeometry(), t);
            const GripFrame frame = frame_of(pose, Mat3(1.0));
            const bool crossed = device.grip.kind == GripKind::crossed;
            const Mat3 rotation = glm::mat3_cast(
                glm::slerp(glm::dquat(1, 0, 0, 0), glm::quat_cast(frame.rotation), device.reach));
            return make_pose(device.grip, device.reach * pose.position_m, rotation,
                             crossed ? frame.grasp_angle_rad : 0.0);
        };
        for (std::uint64_t run = 1; run <= 3; ++run) {
            ForwardKinematics kinematics;
            REQUIRE(kinematics.configure(device.frame, device.grip) == Status::ok);
            test::Random random(run);
            StringArray errors{};
            for (double &error : errors) {
                error = random.between(-3e-3, 3e-3);
            }
            GripPose hand = hand_at(0.0);
            GripPose shown = hand;
            kinematics.set_last_pose(hand);
            int searches = 0;
            double worst = 0.0;
            for (int tick = 1; tick <= 4000; ++tick) {
                const GripPose truth = hand_at(1e-3 * tick);
                StringArray lengths = string_lengths(device.frame, device.grip, truth);
                for (std::size_t i = 0; i < lengths.size(); ++i) {
                    lengths[i] += errors[i];
                }
                const KinematicsResult result = kinematics.update(lengths);
                REQUIRE(usable(result.status));
                searches += result.cold_start ? 1 : 0;
                if (tick > 50) {
                    worst = std::fmax(worst, test::distance(result.pose, shown) -
                                                 test::distance(truth, hand));
                }
                shown = result.pose;
                hand = truth;
            }
            CAPTURE(&device - devices);
            CAPTURE(run);
            CHECK(worst < 1e-3);
            CHECK(searches <= 2);
        }
    }
}

TEST_CASE("kinematics: a wrong branch that fitted is left within 0.2 s of not fitting, in steps") {
    // Lengths of a pose that two root pairs explain, and the memory of the wrong one; then the hand moves on.
    const FrameGeometry frame = test::paper_frame();
    const GripGeometry grip;
    test::Random random(41);
    int seen = 0;
    int clear_cases = 0;
    for (int i = 0; i < 40000 && seen < 25; ++i) {
        const GripPose start = random.pose(grip, 0.15, 0.9);
        StringArray errors{};
        for (double &error : errors) {
            error = random.between(-2e-4, 2e-4);
        }
        StringArray lengths = string_lengths(frame, grip, start);
        for (std::size_t s = 0; s < lengths.size(); ++s) {
            lengths[s] += errors[s];
        }
        const PolishResult right = polish_pose({frame, grip, lengths}, start);
        GripPose wrong = start;
        for (int pair = 0; pair < kRootPairCount; ++pair) {
            const PolishResult other =
                polish_pose({frame, grip, lengths},
                            test::closed_form_pose(Vec3(kPaperHalfExtent_m),
                                                   grip.pole_half_length_m, lengths, pair));
            if (other.converged && test::distance(other.pose, right.pose) > 0.02 &&
                other.residual_rms_m < 5e-4) {
                wrong = other.pose;
            }
        }
        if (test::distance(wrong, start) == 0.0) {
            continue;
        }
        ForwardKinematics kinematics;
        REQUIRE(kinematics.configure(frame, grip) == Status::ok);
        kinematics.set_last_pose(wrong);
        const GripFrame turned = frame_of(start, Mat3(1.0));
        GripPose shown = wrong;
        int bad_since = -1; // tick from which the right answer fitted clearly better
        int left = -1;
        double jump = 0.0;
        bool searched = false;
        for (int tick = 1; tick <= 1000; ++tick) {
            // Back towards rest in a second, where the two answers part.
            const double share = 1.0 - 0.5e-3 * tick;
            const GripPose hand =
                make_pose(grip, share * start.position_m,
                          glm::mat3_cast(glm::slerp(glm::dquat(1, 0, 0, 0),
                                                    glm::quat_cast(turned.rotation), share)),
                          share * turned.grasp_angle_rad);
            lengths = string_lengths(frame, grip, hand);
            for (std::size_t s = 0; s < lengths.size(); ++s) {
                lengths[s] += errors[s];
            }
            const KinematicsResult result = kinematics.update(lengths);
            REQUIRE(usable(result.status));
            searched = searched || result.cold_start;
            const bool off = test::distance(result.pose, hand) > 5e-3;
            const PolishResult best = polish_pose({frame, grip, lengths}, hand);
            const bool clear = best.residual_rms_m < 0.02 * result.residual_rms_m;
            bad_since = off && clear ? (bad_since < 0 ? tick : bad_since) : bad_since;
            if (!off && left < 0) {
                left = tick;
            }
            jump = std::fmax(jump, test::distance(result.pose, shown));
            shown = result.pose;
        }
        if (searched) {
            continue;
        }
        ++seen;
        CAPTURE(i);
        CHECK(left > 0);
        if (bad_since >= 0) { // else the branches met, or the posture decided
            ++clear_cases;
            CHECK(left - bad_since <= 200);
        }
        CHECK(jump < 1e-3);
    }
    CHECK(seen == 25);
    CHECK(clear_cases > 10);
}

TEST_CASE("kinematics: at the same lengths the pose settles at the least-squares pose, and says "
          "when") {
    const FrameGeometry frame = test::paper_frame();
    const GripGeometry grip;
    ForwardKinematics kinematics;
    REQUIRE(kinematics.configure(frame, grip) == Status::ok);
    test::Random random(3);
    const auto lengths_at = [&](double t, const StringArray &errors) {
        StringArray lengths = string_lengths(frame, grip, trajectory_t1(grip, t));
        for (std::size_t i = 0; i < lengths.size(); ++i) {
            lengths[i] += errors[i];
        }
        return lengths;
    };
    // Exact lengths: at once.
    (void)kinematics.update(lengths_at(0.0, {}));
    CHECK(kinematics.settled());
    (void)kinematics.update(lengths_at(1e-3, {}));
    CHECK(kinematics.settled());
    // Errors of 2 mm: over some ticks, since the motion counts too.
    StringArray errors{};
    for (double &error : errors) {
        error = random.between(-2e-3, 2e-3);
    }
    for (int tick = 0; tick < 1000; ++tick) {
        (void)kinematics.update(lengths_at(1e-3 * tick, errors));
    }
    CHECK_FALSE(kinematics.settled());
    const StringArray last = lengths_at(1.0, errors);
    int ticks = 0;
    while (!kinematics.settled() && ticks < 2000) {
        (void)kinematics.update(last);
        ++ticks;
    }
    CHECK(ticks < 1000);
    const PolishResult best = polish_pose({frame, grip, last}, trajectory_t1(grip, 1.0));
    CHECK(test::distance(kinematics.last_pose(), best.pose) < 1e-7);
}
