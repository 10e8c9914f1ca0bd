#include <doctest/doctest.h>

#include <cstring>
#include <limits>

#include "core/geometry/wrench_matrix.h"
#include "core/kinematics/forward_kinematics.h"
#include "core/kinematics/search/closed_form.h"
#include "core/kinematics/search/pose_polish.h"
#include "core/kinematics/search/pose_search.h"
#include "support/pose_helpers.h"

using namespace spidar;
using test::kDeg;

namespace {

// Rounding of eight lengths near 0.5 m.
constexpr double kLengthRounding_m = 2e-15;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct Rig {
    FrameGeometry frame = test::paper_frame();
    GripGeometry grip;
    ForwardKinematics kinematics;

    Rig() { REQUIRE(kinematics.configure(frame, grip) == Status::ok); }
    Rig(const FrameGeometry &f, const GripGeometry &g) : frame(f), grip(g) {
        REQUIRE(kinematics.configure(frame, grip) == Status::ok);
    }
    [[nodiscard]] StringArray lengths(const GripPose &pose) const {
        return string_lengths(frame, grip, pose);
    }
};

bool same_bits(const GripPose &a, const GripPose &b) {
    return std::memcmp(&a, &b, sizeof a) == 0;
}

// Defining equation of a least-squares pose: residuals taken as pulls along the strings leave no force on the
// grip and no couple that could turn a pole. Largest of the three (unit: m).
double imbalance(const Rig &rig, const GripPose &pose, const StringArray &lengths_m) {
    Vec3 force(0.0);
    Vec3 ends[2] = {Vec3(0.0), Vec3(0.0)};
    for (std::size_t i = 0; i < kStringCount; ++i) {
        const Vec3 string =
            attachment_point(rig.grip, pose, static_cast<int>(i)) - rig.frame.motors_m[i];
        const double length = glm::length(string);
        const Vec3 pull = string * ((lengths_m[i] - length) / length);
        force += pull;
        ends[rig.grip.attachments[i].pole] += pull * rig.grip.attachments[i].sign;
    }
    const double d = rig.grip.pole_half_length_m;
    return std::fmax(glm::length(force),
                     std::fmax(glm::length(glm::cross(pose.r1_m / d, ends[0])),
                               glm::length(glm::cross(pose.r2_m / d, ends[1]))));
}

// Trajectory T1: hand motion to about 0.7 m/s and 2.5 rad/s through most of the workspace.
GripPose trajectory_t1(const GripGeometry &grip, double t) {
    const Vec3 position(0.15 * std::sin(3.1 * t), 0.15 * std::sin(2.3 * t + 1.0),
                        0.12 * std::sin(2.9 * t + 2.0));
    const Mat3 rotation = test::rotation_zyx(0.6 * std::sin(4.1 * t), 0.6 * std::sin(3.7 * t + 1.0),
                                             0.5 * std::sin(3.3 * t + 2.0));
    return make_pose(grip, position, rotation, -0.5 * std::sin(2.1 * t));
}

} // namespace

TEST_CASE("kinematics: cold, exact lengths give the pose back") {
    Rig rig;
    test::Random random(1);
    for (int i = 0; i < 2000; ++i) {
        const bool wide = i % 2 == 1;
        const GripPose truth = random.pose(rig.grip, 0.2, (wide ? 45.0 : 30.0) * kDeg);
        const KinematicsResult result = rig.kinematics.solve_cold(rig.lengths(truth));
        CAPTURE(i);
        REQUIRE(usable(result.status));
        CHECK(result.cold_start);
        CHECK(result.residual_rms_m < kLengthRounding_m);
        CHECK(test::distance(result.pose, truth) < 1e-14 + 2e-14 / std::sqrt(result.conditioning));
    }
}

TEST_CASE("kinematics: the rest pose, symmetric poses and the largest turns") {
    Rig rig;
    for (const double z : {-0.2, 0.0, 0.15}) {
        for (const double tilt : {-40.0, 0.0, 40.0}) {
            for (const double grasp : {-45.0, 0.0, 45.0}) {
                const GripPose truth =
                    make_pose(rig.grip, Vec3(0.0, 0.1, z),
                              test::rotation_zyx(tilt * kDeg, 0.0, 0.0), grasp * kDeg);
                const KinematicsResult result = rig.kinematics.solve_cold(rig.lengths(truth));
                CAPTURE(z);
                CAPTURE(tilt);
                CAPTURE(grasp);
                REQUIRE(usable(result.status));
                CHECK(test::distance(result.pose, truth) < 1e-14);
            }
        }
    }
}

TEST_CASE("kinematics: a flipped pole is found from no memory") {
    // Pole 1 tilted past its fold, where only the second root of its cubic is the true one.
    Rig rig;
    int flipped = 0;
    test::Random random(21);
    for (int i = 0; i < 300; ++i) {
        const Mat3 rotation = test::rotation_zyx(random.between(70.0, 88.0) * kDeg, 0.1, 0.05);
        const GripPose truth =
            make_pose(rig.grip, Vec3(random.between(-0.1, 0.1), random.between(-0.2, 0.2), 0.05),
                      rotation, 0.1);
        const KinematicsResult result = rig.kinematics.solve_cold(rig.lengths(truth));
        CAPTURE(i);
        REQUIRE(usable(result.status));
        CHECK(result.residual_rms_m < kLengthRounding_m);
        CHECK(test::distance(result.pose, truth) < 1e-12);
        const GripPose upright = test::closed_form_pose(
            Vec3(kPaperHalfExtent_m), rig.grip.pole_half_length_m, rig.lengths(truth), 0);
        flipped += test::distance(upright, truth) > 1e-3 ? 1 : 0;
    }
    CHECK(flipped > 0); // the case exists: the upright pair is wrong for some
}

TEST_CASE("kinematics: nearly parallel poles") {
    Rig rig;
    test::Random random(5);
    for (const double psi : {0.1, 1.0, 5.0, 175.0, 179.0, 179.9}) {
        for (int i = 0; i < 50; ++i) {
            const GripPose level = random.pose(rig.grip, 0.15, 30.0 * kDeg);
            const GripFrame frame = frame_of(level, Mat3(1.0));
            const GripPose truth =
                make_pose(rig.grip, level.position_m, frame.rotation, (90.0 - psi) * kDeg);
            const KinematicsResult result = rig.kinematics.solve_cold(rig.lengths(truth));
            CAPTURE(psi);
            REQUIRE(usable(result.status));
            CHECK(test::distance(result.pose, truth) < 1e-13);
        }
    }
}

TEST_CASE("kinematics: noisy lengths end at the least-squares pose, cold and warm") {
    Rig rig;
    test::Random random(7);
    for (const double noise_m : {1e-5, 1e-4, 1e-3, 3e-3}) {
        for (int i = 0; i < 200; ++i) {
            const GripPose truth = random.pose(rig.grip, 0.15, 30.0 * kDeg);
            StringArray lengths = rig.lengths(truth);
            for (double &length : lengths) {
                length += random.between(-noise_m, noise_m);
            }
            const KinematicsResult cold = rig.kinematics.solve_cold(lengths);
            CAPTURE(noise_m);
            CAPTURE(i);
            REQUIRE(usable(cold.status));
            CHECK(cold.residual_rms_m <= noise_m); // the truth fits that well, the optimum better
            CHECK(imbalance(rig, cold.pose, lengths) < 1e-14);
            // Warm ticks on constant lengths settle on the same pose.
            KinematicsResult warm;
            for (int tick = 0; tick < 40; ++tick) {
                warm = rig.kinematics.update(lengths);
            }
            REQUIRE(usable(warm.status));
            CHECK(test::distance(warm.pose, cold.pose) < 1e-9);
        }
    }
}

TEST_CASE("kinematics: warm tracking of T1 with at most two steps a tick") {
    Rig rig;
    double worst = 0.0;
    int cold_starts = 0;
    for (int tick = 0; tick < 60000; ++tick) {
        const GripPose truth = trajectory_t1(rig.grip, 0.001 * tick);
        const KinematicsResult result = rig.kinematics.update(rig.lengths(truth));
        REQUIRE(usable(result.status));
        cold_starts += result.cold_start ? 1 : 0;
        if (!result.cold_start) {
            CHECK(result.steps <= 2);
        }
        worst = std::fmax(worst, test::distance(result.pose, truth));
    }
    CHECK(cold_starts == 1); // the first tick only
    CHECK(worst < 2e-11);
}

TEST_CASE("kinematics: on smooth motion one step a tick is enough") {
    Rig rig;
    int steps = 0;
    constexpr int kTicks = 5000;
    for (int tick = 0; tick < kTicks; ++tick) {
        steps += rig.kinematics.update(rig.lengths(trajectory_t1(rig.grip, 0.001 * tick))).steps;
    }
    CHECK(steps < kTicks + kTicks / 20);
}

TEST_CASE("kinematics: with noise a warm tick is within 1 % of the least-squares optimum") {
    Rig rig;
    test::Random random(17);
    for (const double noise_m : {2.5e-5, 1e-4, 1e-3}) {
        rig.kinematics.reset();
        double square = 0.0;
        double optimal = 0.0;
        for (int tick = 0; tick < 3000; ++tick) {
            const GripPose truth = trajectory_t1(rig.grip, 0.001 * tick);
            StringArray lengths = rig.lengths(truth);
            for (double &length : lengths) {
                length += random.between(-noise_m, noise_m);
            }
            const KinematicsResult result = rig.kinematics.update(lengths);
            REQUIRE(usable(result.status));
            const PolishResult best = polish_pose({rig.frame, rig.grip, lengths}, truth);
            CHECK(imbalance(rig, best.pose, lengths) < 1e-7 * noise_m);
            const double error = test::distance(result.pose, truth);
            const double least = test::distance(best.pose, truth);
            square += error * error;
            optimal += least * least;
            // Reported without a further look at the lengths: off by no more than the pose may be.
            double residual2 = 0.0;
            const StringArray computed = rig.lengths(result.pose);
            for (std::size_t i = 0; i < kStringCount; ++i) {
                residual2 += (lengths[i] - computed[i]) * (lengths[i] - computed[i]);
            }
            CHECK(std::fabs(result.residual_rms_m - std::sqrt(residual2 / kStringCount)) <
                  kTrackingShare * noise_m);
        }
        CAPTURE(noise_m);
        CHECK(std::sqrt(square) < 1.01 * std::sqrt(optimal));
    }
}

TEST_CASE("kinematics: noise alone starts no search") {
    Rig rig;
    test::Random random(19);
    rig.kinematics.set_last_pose(trajectory_t1(rig.grip, 0.0));
    int searches = 0;
    for (int tick = 1; tick <= 3000; ++tick) {
        StringArray lengths = rig.lengths(trajectory_t1(rig.grip, 0.001 * tick));
        for (double &length : lengths) {
            length += random.between(-4e-4, 4e-4);
        }
        searches += rig.kinematics.update(lengths).cold_start ? 1 : 0;
    }
    CHECK(searches == 0);
}

TEST_CASE("kinematics: cold, a root pair that fits as well is never dropped unseen") {
    Rig rig;
    test::Random random(23);
    int rivals = 0;
    for (int i = 0; i < 3000; ++i) {
        const GripPose truth = random.pose(rig.grip, 0.2, 60.0 * kDeg);
        StringArray lengths = rig.lengths(truth);
        for (double &length : lengths) {
            length += random.between(-1e-4, 1e-4);
        }
        const KinematicsResult cold = rig.kinematics.solve_cold(lengths);
        if (!usable(cold.status)) {
            continue;
        }
        const LengthProblem problem{rig.frame, rig.grip, lengths};
        for (int pair = 0; pair < kRootPairCount; ++pair) {
            const PolishResult other = polish_pose(
                problem, test::closed_form_pose(Vec3(kPaperHalfExtent_m),
                                                rig.grip.pole_half_length_m, lengths, pair));
            // As good as the answer, elsewhere: then the answer must say so.
            if (other.converged && other.residual_rms_m < 2.0 * cold.residual_rms_m &&
                test::distance(other.pose, cold.pose) > kDistinctPose_m) {
                ++rivals;
                CAPTURE(i);
                CHECK(cold.status == Status::ambiguous_pose);
            }
        }
    }
    CHECK(rivals > 0);
}

TEST_CASE("kinematics: a pose that two root pairs explain is flagged, cold and warm, and memory "
          "keeps its branch") {
    Rig rig;
    // A pole seen edge on: upright and flipped root of its cubic nearly meet, and 0.1 mm in the lengths decide.
    test::Random random(31);
    int flagged = 0;
    int plain = 0;
    for (int i = 0; i < 3000; ++i) {
        const GripPose truth = random.pose(rig.grip, 0.2, 60.0 * kDeg);
        StringArray lengths = rig.lengths(truth);
        for (double &length : lengths) {
            length += random.between(-2e-4, 2e-4);
        }
        const PolishResult branch = polish_pose({rig.frame, rig.grip, lengths}, truth);
        if (!branch.converged) {
            continue;
        }
        // Every pose that fits, by the slow way.
        bool rival = false;
        double least_m = branch.residual_rms_m;
        for (int pair = 0; pair < kRootPairCount; ++pair) {
            const PolishResult other =
                polish_pose({rig.frame, rig.grip, lengths},
                            test::closed_form_pose(Vec3(kPaperHalfExtent_m),
                                                   rig.grip.pole_half_length_m, lengths, pair));
            if (other.converged && test::distance(other.pose, branch.pose) > 0.01 &&
                other.residual_rms_m < 2.0 * branch.residual_rms_m) {
                rival = true;
                least_m = std::fmin(least_m, other.residual_rms_m);
            }
        }
        rig.kinematics.set_last_pose(branch.pose);
        const KinematicsResult warm = rig.kinematics.update(lengths);
        CAPTURE(i);
        REQUIRE(usable(warm.status));
        REQUIRE_FALSE(warm.cold_start);
        REQUIRE(test::distance(warm.pose, branch.pose) < 1e-4); // memory decides
        if (rival) {
            CHECK(warm.status == Status::ambiguous_pose);
            // Between two looks the flag stands.
            CHECK(rig.kinematics.update(lengths).status == Status::ambiguous_pose);
            // Without memory a rival that fits 50 times better, more than noise explains, is the answer.
            if (branch.residual_rms_m < 50.0 * least_m) {
                CHECK(rig.kinematics.solve_cold(lengths).status == Status::ambiguous_pose);
            }
            ++flagged;
        } else {
            plain += warm.status == Status::ok ? 1 : 0;
        }
    }
    CHECK(flagged > 10);
    CHECK(plain > 2000);
    // Back at rest it falls within a period.
    const StringArray rest = rig.lengths(rest_pose(rig.grip));
    KinematicsResult last = rig.kinematics.solve_cold(rest);
    for (int tick = 0; tick < kRivalPeriod; ++tick) {
        last = rig.kinematics.update(rest);
    }
    CHECK(last.status == Status::ok);
}

TEST_CASE("kinematics: warm, the flag rises and falls within a period as the hand passes an "
          "ambiguous pose") {
    // Noise-free lengths of one pose, from memory of it: no rival. Then lengths on which two pairs agree.
    Rig rig;
    test::Random random(32);
    for (int i = 0, seen = 0; i < 20000 && seen < 20; ++i) {
        const GripPose truth = random.pose(rig.grip, 0.2, 60.0 * kDeg);
        StringArray noisy = rig.lengths(truth);
        for (double &length : noisy) {
            length += random.between(-2e-4, 2e-4);
        }
        if (rig.kinematics.solve_cold(noisy).status != Status::ambiguous_pose) {
            continue;
        }
        const StringArray exact = rig.lengths(rig.kinematics.last_pose());
        rig.kinematics.set_last_pose(rig.kinematics.last_pose());
        CAPTURE(i);
        Status status = Status::ok;
        for (int tick = 0; tick <= kRivalPeriod; ++tick) {
            status = rig.kinematics.update(exact).status;
        }
        CHECK(status != Status::ambiguous_pose);
        for (int tick = 0; tick <= kRivalPeriod; ++tick) {
            status = rig.kinematics.update(noisy).status;
        }
        CHECK(status == Status::ambiguous_pose);
        ++seen;
    }
}

TEST_CASE("kinematics: after a jump of the pose the next tick is right") {
    Rig rig;
    test::Random random(9);
    for (int i = 0; i < 3000; ++i) {
        const GripPose truth = random.pose(rig.grip, 0.15, 30.0 * kDeg);
        const KinematicsResult result = rig.kinematics.update(rig.lengths(truth));
        CAPTURE(i);
        REQUIRE(usable(result.status));
        CHECK(test::distance(result.pose, truth) < 1e-11);
    }
}

TEST_CASE("kinematics: garbage is refused, the last pose held bit for bit, and tracking resumes") {
    Rig rig;
    const GripPose truth = test::Random(2).pose(rig.grip, 0.1, 0.3);
    const StringArray good = rig.lengths(truth);
    REQUIRE(rig.kinematics.update(good).status == Status::ok);
    const GripPose held = rig.kinematics.last_pose();

    const auto refused_with = [&](StringArray lengths, Status status) {
        const KinematicsResult warm = rig.kinematics.update(lengths);
        CHECK(warm.status == status);
        CHECK(same_bits(warm.pose, held));
        const KinematicsResult cold = rig.kinematics.solve_cold(lengths);
        CHECK(cold.status == status);
        CHECK(same_bits(cold.pose, held));
        CHECK(same_bits(rig.kinematics.last_pose(), held));
    };
    for (std::size_t i = 0; i < kStringCount; ++i) {
        for (const double bad : {kNan, kInfinity, -kInfinity}) {
            StringArray lengths = good;
            lengths[i] = bad;
            refused_with(lengths, Status::not_finite);
        }
        for (const double bad : {0.0, -0.3, 1e6, 1e200, 1.7e308}) {
            StringArray lengths = good;
            lengths[i] = bad;
            CAPTURE(i);
            CAPTURE(bad);
            refused_with(lengths, Status::impossible_lengths);
        }
    }
    StringArray all{};
    for (const double same : {1e-300, 1e-3, 0.05, 3.0, 1e150}) {
        all.fill(same);
        CAPTURE(same);
        refused_with(all, Status::impossible_lengths);
    }
    const KinematicsResult again = rig.kinematics.update(good);
    CHECK(again.status == Status::ok);
    CHECK(test::distance(again.pose, truth) < 1e-14);
}

TEST_CASE("kinematics: a pose at or beyond a z face is refused") {
    Rig rig;
    for (const double z : {0.25, 0.3, -0.26, -0.34}) {
        rig.kinematics.reset();
        const GripPose outside =
            make_pose(rig.grip, Vec3(0.03, -0.05, z), test::rotation_zyx(0.2, -0.1, 0.3), 0.2);
        const KinematicsResult result = rig.kinematics.update(rig.lengths(outside));
        CAPTURE(z);
        CHECK(result.status == Status::outside_frame);
        CHECK(test::distance(result.pose, rest_pose(rig.grip)) == 0.0);
    }
    // Just inside is served.
    const GripPose inside =
        make_pose(rig.grip, Vec3(0.03, -0.05, 0.239), test::rotation_zyx(0.2, -0.1, 0.3), 0.2);
    const KinematicsResult result = rig.kinematics.solve_cold(rig.lengths(inside));
    REQUIRE(usable(result.status));
    CHECK(test::distance(result.pose, inside) < 1e-12);
}

TEST_CASE("kinematics: Rz +-90 degrees at psi 90 degrees has no determined pose and says so") {
    Rig rig;
    for (const double turn : {90.0, -90.0}) {
        const GripPose truth = make_pose(rig.grip, Vec3(0.05, -0.03, 0.04),
                                         test::rotation_zyx(0.0, 0.0, turn * kDeg), 0.0);
        const KinematicsResult result = rig.kinematics.solve_cold(rig.lengths(truth));
        const bool flagged = result.status != Status::ok;
        CHECK(flagged);
        if (usable(result.status)) {
            CHECK(test::distance(result.pose, truth) < 1e-6);
        } else {
            CHECK(same_bits(result.pose, rig.kinematics.last_pose()));
        }
    }
}

TEST_CASE("kinematics: conditioning falls towards the z face and flags what is nearly singular") {
    Rig rig;
    double last = 2.0;
    for (const double z : {0.0, 0.1, 0.2, 0.23, 0.239, 0.2399}) {
        const GripPose truth = make_pose(rig.grip, Vec3(0.0, 0.0, z), Mat3(1.0), 0.0);
        const KinematicsResult result = rig.kinematics.solve_cold(rig.lengths(truth));
        REQUIRE(usable(result.status));
        CHECK(result.conditioning > 0.0);
        CHECK(result.conditioning < last);
        CHECK(test::distance(result.pose, truth) < 1e-14 + 2e-14 / std::sqrt(result.conditioning));
        last = result.conditioning;
        if (z == 0.0) {
            CHECK(result.status == Status::ok);
        }
    }
    CHECK(last < kNearSingularPivot);
}

TEST_CASE("kinematics: the same input gives the same bits") {
    Rig one;
    Rig two;
    test::Random random(31);
    for (int i = 0; i < 500; ++i) {
        const GripPose truth = random.pose(one.grip, 0.2, 45.0 * kDeg);
        StringArray lengths = one.lengths(truth);
        if (i % 7 == 0) {
            lengths[static_cast<std::size_t>(i) % kStringCount] += 0.05;
        }
        const KinematicsResult a = one.kinematics.update(lengths);
        const KinematicsResult b = two.kinematics.update(lengths);
        CHECK(a.status == b.status);
        CHECK(same_bits(a.pose, b.pose));
    }
}

TEST_CASE("kinematics: unequal boxes and other grips") {
    GripGeometry grip;
    grip.pole_half_length_m = 0.06;
    Rig rig(make_box_frame(Vec3(0.3, 0.2, 0.25)), grip);
    test::Random random(41);
    for (int i = 0; i < 500; ++i) {
        const GripPose truth = random.pose(grip, 0.12, 30.0 * kDeg);
        const KinematicsResult result = rig.kinematics.solve_cold(rig.lengths(truth));
        REQUIRE(usable(result.status));
        CHECK(test::distance(result.pose, truth) < 1e-14 + 2e-14 / std::sqrt(result.conditioning));
    }
}

TEST_CASE("kinematics: frames that are no box are solved without the closed form") {
    FrameGeometry bent = test::paper_frame();
    bent.motors_m[0] += Vec3(0.03, -0.02, 0.01);
    bent.motors_m[5] += Vec3(-0.02, 0.02, -0.03);
    bent.motors_m[6] += Vec3(0.01, 0.03, 0.02);
    Rig rig(bent, GripGeometry{});
    test::Random random(43);
    for (int i = 0; i < 500; ++i) {
        const GripPose truth = random.pose(rig.grip, 0.12, 30.0 * kDeg);
        const KinematicsResult result = rig.kinematics.solve_cold(rig.lengths(truth));
        CAPTURE(i);
        REQUIRE(usable(result.status));
        CHECK(test::distance(result.pose, truth) < 1e-14 + 2e-14 / std::sqrt(result.conditioning));
    }
}

TEST_CASE("kinematics: a geometry that is impossible is refused and the old one stands") {
    Rig rig;
    GripGeometry bad_grip;
    bad_grip.pole_half_length_m = kNan;
    CHECK(rig.kinematics.configure(rig.frame, bad_grip) == Status::invalid_geometry);
    FrameGeometry bad_frame = rig.frame;
    bad_frame.motors_m[4].z = kNan;
    CHECK(rig.kinematics.configure(bad_frame, rig.grip) == Status::invalid_geometry);
    CHECK(rig.kinematics.configure(FrameGeometry{}, rig.grip) == Status::invalid_geometry);
    const GripPose truth = make_pose(rig.grip, Vec3(0.02, 0.03, 0.04), Mat3(1.0), 0.1);
    const KinematicsResult result = rig.kinematics.update(rig.lengths(truth));
    CHECK(result.status == Status::ok);
    CHECK(test::distance(result.pose, truth) < 1e-14);
}
