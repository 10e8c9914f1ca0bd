#include <doctest/doctest.h>

#include "core/geometry/wrench_matrix.h"
#include "core/kinematics/forward_kinematics.h"
#include "core/kinematics/search/pose_polish.h"
#include "core/kinematics/steps/rigid_step.h"
#include "core/presets/presets.h"
#include "support/pose_helpers.h"

using namespace spidar;
using test::kDeg;

namespace {

// P0 within a quarter of the X3's frame each way, turns to 30 degrees: its workspace.
GripPose draw(test::Random &random, const GripGeometry &grip, double size_m = 0.02,
              double turn_rad = 30.0 * kDeg) {
    const Vec3 position(random.between(-size_m, size_m), random.between(-size_m, size_m),
                        random.between(-size_m, size_m));
    const double x = random.between(-turn_rad, turn_rad);
    const double y = random.between(-turn_rad, turn_rad);
    const double z = random.between(-turn_rad, turn_rad);
    return make_pose(grip, position, test::rotation_zyx(x, y, z), 0.0);
}

// Motors and joints that obey no rule.
DevicePreset arbitrary(test::Random &random) {
    DevicePreset device = device_preset(Preset::spidar_g6_x3r);
    for (std::size_t i = 0; i < kStringCount; ++i) {
        for (int axis = 0; axis < 3; ++axis) {
            device.frame.motors_m[i][axis] += random.between(-0.02, 0.02);
            device.grip.joints_m[i][axis] += random.between(-0.005, 0.005);
        }
    }
    device.grip = make_rigid_grip(device.grip.joints_m);
    return device;
}

// Largest of the residual forces' sum and of their moment over the lever.
double imbalance(const DevicePreset &device, const GripPose &pose, const StringArray &lengths_m) {
    Vec3 force(0.0);
    Vec3 moment(0.0);
    for (std::size_t i = 0; i < kStringCount; ++i) {
        const Vec3 lever = attachment_lever(device.grip, pose, i);
        const Vec3 line = pose.position_m + lever - device.frame.motors_m[i];
        const double length = glm::length(line);
        const Vec3 pull = line * ((lengths_m[i] - length) / length);
        force += pull;
        moment += glm::cross(lever, pull);
    }
    return std::fmax(glm::length(force), glm::length(moment) / device.grip.pole_half_length_m);
}

} // namespace

TEST_CASE("rigid grip: attachments turn with the grip and keep their distances") {
    const DevicePreset device = device_preset(Preset::spidar_g6_x3l);
    const GripGeometry &grip = device.grip;
    CHECK(validate(grip, device.frame).empty());
    const GripPose rest = rest_pose(grip);
    for (std::size_t i = 0; i < kStringCount; ++i) {
        CHECK(glm::distance(attachment_lever(grip, rest, i), grip.joints_m[i]) < 1e-17);
    }
    test::Random random(1);
    const GripPose pose = draw(random, grip);
    const Mat3 rotation = frame_of(pose, Mat3(1.0)).rotation;
    for (std::size_t i = 0; i < kStringCount; ++i) {
        CHECK(glm::distance(attachment_lever(grip, pose, i), rotation * grip.joints_m[i]) < 1e-16);
    }
}

TEST_CASE("rigid grip: what cannot be a grip is named") {
    const DevicePreset device = device_preset(Preset::spidar_g6_x3r);
    StringVectors joints = device.grip.joints_m;
    joints[3] = Vec3(0.0, std::nan(""), 0.0);
    GripGeometry grip = device.grip;
    grip.joints_m = joints;
    CHECK_FALSE(is_usable(grip, device.frame));
    CHECK(validate(grip, device.frame).find("joints_m[3]") == 0);
    for (std::size_t i = 0; i < kStringCount; ++i) {
        joints[i] = Vec3(0.01 * static_cast<double>(i % 3), 0.0, 0.0);
    }
    grip = make_rigid_grip(joints);
    CHECK_FALSE(is_usable(grip, device.frame));
    CHECK(validate(grip, device.frame).find("joints_m lie on one line") == 0);
}

TEST_CASE("rigid grip: from rest, exact lengths give the pose back, cold and warm") {
    test::Random random(2);
    for (int i = 0; i < 400; ++i) {
        const DevicePreset device =
            i % 2 == 0 ? device_preset(Preset::spidar_g6_x3r) : arbitrary(random);
        ForwardKinematics kinematics;
        REQUIRE(kinematics.configure(device.frame, device.grip) == Status::ok);
        const GripPose truth = draw(random, device.grip);
        const StringArray lengths = string_lengths(device.frame, device.grip, truth);
        const KinematicsResult cold = kinematics.update(lengths);
        CAPTURE(i);
        REQUIRE(usable(cold.status));
        CHECK(cold.cold_start);
        CHECK(test::distance(cold.pose, truth) < 1e-14 + 2e-14 / std::sqrt(cold.conditioning));
        CHECK(std::fabs(glm::dot(cold.pose.r1_m, cold.pose.r2_m)) < 1e-18);
        GripPose next = truth;
        move_rigid(next, {3e-4, -2e-4, 1e-4, 2e-4, -3e-4, 2e-4}, device.grip.pole_half_length_m);
        const KinematicsResult warm =
            kinematics.update(string_lengths(device.frame, device.grip, next));
        CHECK_FALSE(warm.cold_start);
        CHECK(test::distance(warm.pose, next) < 1e-9);
    }
}

TEST_CASE("rigid grip: with errors in the lengths the residuals balance") {
    test::Random random(3);
    const DevicePreset device = device_preset(Preset::spidar_g6_x3r);
    ForwardKinematics kinematics;
    REQUIRE(kinematics.configure(device.frame, device.grip) == Status::ok);
    for (int i = 0; i < 400; ++i) {
        StringArray lengths = string_lengths(device.frame, device.grip, draw(random, device.grip));
        for (double &length : lengths) {
            length += random.between(-5e-4, 5e-4);
        }
        const KinematicsResult result = kinematics.solve_cold(lengths);
        CAPTURE(i);
        REQUIRE(usable(result.status));
        CHECK(imbalance(device, result.pose, lengths) < 1e-14);
    }
}

TEST_CASE("rigid grip: a turn about the line of all strings has no determined pose and says so") {
    // Joints in a plane, motors in the same plane at rest: motion out of it changes no length.
    DevicePreset device = device_preset(Preset::spidar_g6_x3r);
    for (std::size_t i = 0; i < kStringCount; ++i) {
        const double angle = 0.7853981633974483 * static_cast<double>(i);
        device.frame.motors_m[i] =
            Vec3(0.1 * std::cos(angle), 0.1 * std::sin(angle), i == 7 ? 0.001 : 0.0);
        device.grip.joints_m[i] =
            Vec3(0.02 * std::cos(angle + 0.5), 0.02 * std::sin(angle + 0.5), 0.0);
    }
    device.grip = make_rigid_grip(device.grip.joints_m);
    REQUIRE(is_usable(device.frame));
    ForwardKinematics kinematics;
    REQUIRE(kinematics.configure(device.frame, device.grip) == Status::ok);
    const KinematicsResult result =
        kinematics.solve_cold(string_lengths(device.frame, device.grip, rest_pose(device.grip)));
    CHECK((result.status == Status::rank_deficient || result.status == Status::near_singular ||
           result.status == Status::ambiguous_pose || result.status == Status::not_converged));
}

TEST_CASE("rigid grip: 6 x 8 wrench matrix, minus the slopes of the lengths; no seventh row") {
    test::Random random(4);
    const DevicePreset device = arbitrary(random);
    const GripPose pose = draw(random, device.grip);
    const WrenchMatrix matrix = wrench_matrix(device.frame, device.grip, pose);
    CHECK(matrix.grasp_row_vanishes);
    const double d = device.grip.pole_half_length_m;
    constexpr double kStep_m = 1e-7;
    for (std::size_t dof = 0; dof < kRigidDofCount; ++dof) {
        RigidStep step{};
        step[dof] = kStep_m;
        GripPose more = pose;
        move_rigid(more, step, d);
        step[dof] = -kStep_m;
        GripPose less = pose;
        move_rigid(less, step, d);
        const StringArray longer = string_lengths(device.frame, device.grip, more);
        const StringArray shorter = string_lengths(device.frame, device.grip, less);
        for (std::size_t s = 0; s < kStringCount; ++s) {
            const double slope = (longer[s] - shorter[s]) / (2.0 * kStep_m);
            const double per_unit = dof < 3 ? slope : slope * d; // per radian
            CHECK(std::fabs(per_unit + matrix.columns[s][dof]) < 1e-8);
        }
    }
    for (const PaperWrench &column : matrix.columns) {
        CHECK(column[6] == 0.0);
    }
}
