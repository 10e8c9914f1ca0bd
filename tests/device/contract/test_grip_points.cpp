#include <doctest/doctest.h>

#include <cmath>
#include <random>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "device/contract/grip_points.h"

using namespace spidar;

namespace {

constexpr ContactTarget kPoints[] = {ContactTarget::centre, ContactTarget::pole1_plus,
                                     ContactTarget::pole1_minus, ContactTarget::pole2_plus,
                                     ContactTarget::pole2_minus};

GripState state_of(const Vec3 &position_m, const Mat3 &rotation, double grasp_angle_rad) {
    GripState grip;
    grip.pose = make_pose(GripGeometry(), position_m, rotation, grasp_angle_rad);
    grip.frame = frame_of(grip.pose, Mat3(1.0));
    return grip;
}

Mat3 turned(const Mat3 &rotation, const Vec3 &by_rad) {
    const double angle = glm::length(by_rad);
    return angle > 0.0 ? glm::mat3_cast(glm::angleAxis(angle, by_rad / angle)) * rotation
                       : rotation;
}

double power(const Wrench &wrench, const Twist &twist) {
    return glm::dot(wrench.force_n, twist.linear_m_s) +
           glm::dot(wrench.moment_nm, twist.angular_rad_s) +
           wrench.grasp_torque_nm * twist.grasp_rate_rad_s;
}

} // namespace

TEST_CASE("grip points: where the header of ContactTarget says") {
    const GripState grip = state_of(Vec3(0.01, 0.02, 0.03), Mat3(1.0), 0.0);
    const Vec3 p = grip.pose.position_m;
    CHECK(glm::distance(grip_point(grip.pose, ContactTarget::centre), p) == 0.0);
    const double d = kPaperPoleHalfLength_m;
    CHECK(glm::distance(grip_point(grip.pose, ContactTarget::pole1_plus), p + Vec3(0, d, 0)) <
          1e-15);
    CHECK(glm::distance(grip_point(grip.pose, ContactTarget::pole1_minus), p - Vec3(0, d, 0)) <
          1e-15);
    CHECK(glm::distance(grip_point(grip.pose, ContactTarget::pole2_plus), p + Vec3(d, 0, 0)) <
          1e-15);
    CHECK(glm::distance(grip_point(grip.pose, ContactTarget::pole2_minus), p - Vec3(d, 0, 0)) <
          1e-15);
}

TEST_CASE("grip points: at rest, pushing a pole end towards the other pole closes the grip") {
    const GripState grip = state_of(Vec3(0.0), Mat3(1.0), 0.0);
    // r1 = +y, r2 = +x: closing brings r1 towards +x and r2 towards +y, each by half the angle.
    const double half = 0.5 * kPaperPoleHalfLength_m;
    CHECK(wrench_of_force(grip, ContactTarget::pole1_plus, Vec3(1, 0, 0)).grasp_torque_nm ==
          doctest::Approx(half));
    CHECK(wrench_of_force(grip, ContactTarget::pole1_minus, Vec3(-1, 0, 0)).grasp_torque_nm ==
          doctest::Approx(half));
    CHECK(wrench_of_force(grip, ContactTarget::pole2_plus, Vec3(0, 1, 0)).grasp_torque_nm ==
          doctest::Approx(half));
    CHECK(wrench_of_force(grip, ContactTarget::pole2_minus, Vec3(0, -1, 0)).grasp_torque_nm ==
          doctest::Approx(half));
    CHECK(wrench_of_force(grip, ContactTarget::centre, Vec3(1, 1, 1)).grasp_torque_nm == 0.0);
}

TEST_CASE(
    "grip points: velocity and virtual work by finite differences of make_pose, all seven DOF") {
    std::mt19937_64 random(11);
    std::uniform_real_distribution<double> part(-1.0, 1.0);
    const auto vector = [&](double size) {
        return Vec3(size * part(random), size * part(random), size * part(random));
    };
    constexpr double kStep_s = 1e-6;
    for (int round = 0; round < 200; ++round) {
        const Vec3 p = vector(0.1);
        const Mat3 rotation = turned(Mat3(1.0), vector(0.6));
        const double grasp = 0.9 * part(random);
        Twist twist{vector(0.3), vector(3.0), 3.0 * part(random)};
        GripState grip = state_of(p, rotation, grasp);
        grip.twist = twist;
        const auto at = [&](double t) {
            return make_pose(GripGeometry(), p + t * twist.linear_m_s,
                             turned(rotation, t * twist.angular_rad_s),
                             grasp + t * twist.grasp_rate_rad_s);
        };
        for (const ContactTarget target : kPoints) {
            const Vec3 measured =
                (grip_point(at(kStep_s), target) - grip_point(at(-kStep_s), target)) /
                (2.0 * kStep_s);
            const Vec3 velocity = grip_point_velocity(grip, target);
            REQUIRE(glm::distance(measured, velocity) < 1e-8);
            // The wrench of a force does the force's own work.
            const Vec3 force = vector(5.0);
            REQUIRE(std::abs(power(wrench_of_force(grip, target, force), twist) -
                             glm::dot(force, measured)) < 1e-7);
        }
    }
}
