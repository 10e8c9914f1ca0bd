#include <doctest/doctest.h>

#include "core/geometry/string_exit.h"
#include "core/geometry/wrench_matrix.h"
#include "core/kinematics/forward_kinematics.h"
#include "support/pose_helpers.h"

using namespace spidar;
using test::kDeg;

namespace {

FrameGeometry pulley_frame() {
    FrameGeometry frame = test::paper_frame();
    frame.pulley_radius_m = 0.004;
    return frame;
}

} // namespace

TEST_CASE("string exit: an eyelet's path is the straight line") {
    const StringPath path = string_path(Vec3(1, 2, 3), 0.0, Vec3(0, 0, 1), Vec3(1, 2, 5));
    CHECK(path.length_m == 2.0);
    CHECK(path.direction == Vec3(0, 0, 1));
    CHECK_FALSE(path.on_pulley);
    const StringPath none = string_path(Vec3(1, 2, 3), 0.0, Vec3(0, 0, 1), Vec3(1, 2, 3));
    CHECK(none.length_m == 0.0);
    CHECK(none.direction == Vec3(0.0));
}

TEST_CASE("string exit: straight across from the pulley the string wraps a quarter and runs on") {
    // Inlet at the origin of the pulley's rim, axis z pointing out; the attachment 0.3 m aside, one radius outwards: the
    // tangent leaves at the rim's outermost point.
    const double r = 0.004;
    const StringPath path = string_path(Vec3(0, 0, 0.24), r, Vec3(0, 0, 1), Vec3(0.3, 0, 0.24 + r));
    CHECK(path.on_pulley);
    CHECK(path.direction.x == doctest::Approx(1.0).epsilon(1e-12));
    CHECK(std::fabs(path.direction.z) < 1e-12);
    CHECK(path.length_m == doctest::Approx(0.5 * 3.141592653589793 * r + 0.3 - r).epsilon(1e-12));
}

TEST_CASE("string exit: the length grows by direction . movement, and the direction has length 1") {
    test::Random random(5);
    for (int i = 0; i < 500; ++i) {
        const Vec3 inlet(random.between(0.1, 0.3), random.between(-0.3, -0.1),
                         i % 2 == 0 ? 0.24 : -0.24);
        const Vec3 end(random.between(-0.1, 0.1), random.between(-0.1, 0.1),
                       random.between(-0.15, 0.15));
        const StringPath path = string_path(inlet, 0.004, Vec3(0, 0, 1), end);
        REQUIRE(path.on_pulley);
        CHECK(glm::length(path.direction) == doctest::Approx(1.0).epsilon(1e-12));
        for (int axis = 0; axis < 3; ++axis) {
            constexpr double kStep_m = 1e-6;
            Vec3 step(0.0);
            step[axis] = kStep_m;
            const double rate = (string_path(inlet, 0.004, Vec3(0, 0, 1), end + step).length_m -
                                 string_path(inlet, 0.004, Vec3(0, 0, 1), end - step).length_m) /
                                (2.0 * kStep_m);
            CHECK(std::fabs(rate - path.direction[axis]) < 1e-9);
        }
    }
}

TEST_CASE("string exit: an attachment within the pulley, or on its axis, has the straight line") {
    const Vec3 inlet(0, 0, 0.24);
    CHECK_FALSE(string_path(inlet, 0.01, Vec3(0, 0, 1), inlet + Vec3(0.01, 0, 0)).on_pulley);
    CHECK_FALSE(string_path(inlet, 0.01, Vec3(0, 0, 1), inlet + Vec3(0, 0, -0.2)).on_pulley);
}

TEST_CASE("kinematics around exit pulleys: cold and warm, exact lengths give the pose back") {
    const FrameGeometry frame = pulley_frame();
    const GripGeometry grip;
    ForwardKinematics kinematics;
    REQUIRE(kinematics.configure(frame, grip) == Status::ok);
    test::Random random(6);
    double excess_m = 0.0;
    for (int i = 0; i < 500; ++i) {
        const GripPose truth = random.pose(grip, 0.15, 30.0 * kDeg);
        const StringArray lengths = string_lengths(frame, grip, truth);
        excess_m = std::fmax(
            excess_m, std::fabs(lengths[0] - string_lengths(test::paper_frame(), grip, truth)[0]));
        kinematics.reset();
        const KinematicsResult cold = kinematics.update(lengths);
        CAPTURE(i);
        REQUIRE(usable(cold.status));
        CHECK(test::distance(cold.pose, truth) < 1e-14 + 2e-14 / std::sqrt(cold.conditioning));
        // A tick later the hand has moved half a millimetre.
        GripPose next = truth;
        next.position_m += Vec3(3e-4, -3e-4, 3e-4);
        const KinematicsResult warm = kinematics.update(string_lengths(frame, grip, next));
        CHECK_FALSE(warm.cold_start);
        CHECK(test::distance(warm.pose, next) < 1e-9);
    }
    CHECK(excess_m > 1e-3); // what an eyelet's kinematics would have been wrong by
}

TEST_CASE("wrench matrix around exit pulleys: minus the slopes of the lengths, all seven DOF") {
    const FrameGeometry frame = pulley_frame();
    const GripGeometry grip;
    test::Random random(7);
    for (int i = 0; i < 50; ++i) {
        const GripPose pose = random.pose(grip, 0.15, 30.0 * kDeg);
        const GripFrame at = frame_of(pose, Mat3(1.0));
        const WrenchMatrix matrix = wrench_matrix(frame, grip, pose);
        constexpr double kStep = 1e-6;
        for (std::size_t dof = 0; dof < kDofCount; ++dof) {
            const auto moved = [&](double size) {
                Vec3 shift(0.0);
                Vec3 turn(0.0);
                (dof < 3 ? shift : turn)[static_cast<int>(dof % 3)] = dof < 6 ? size : 0.0;
                const Mat3 rotation = glm::mat3_cast(glm::dquat(turn)) * at.rotation;
                // The paper's g goes with half the grasp angle.
                const double grasp = at.grasp_angle_rad + (dof == 6 ? 2.0 * size : 0.0);
                return string_lengths(frame, grip,
                                      make_pose(grip, pose.position_m + shift, rotation, grasp));
            };
            const StringArray more = moved(kStep);
            const StringArray less = moved(-kStep);
            for (std::size_t s = 0; s < kStringCount; ++s) {
                const double slope = (more[s] - less[s]) / (2.0 * kStep);
                CHECK(std::fabs(slope + matrix.columns[s][dof]) < 1e-8);
            }
        }
    }
}

TEST_CASE("frame geometry: pulleys out of range are named") {
    FrameGeometry frame = test::paper_frame();
    frame.pulley_radius_m = 4.0;
    CHECK_FALSE(is_usable(frame));
    CHECK(validate(frame).find("pulley_radius_m is 4 m") == 0);
    frame.pulley_radius_m = std::nan("");
    CHECK_FALSE(is_usable(frame));
    frame.pulley_radius_m = 0.004;
    frame.pulley_axis = Vec3(0, 0, 2);
    CHECK_FALSE(is_usable(frame));
    CHECK(validate(frame).find("pulley_axis") == 0);
}
