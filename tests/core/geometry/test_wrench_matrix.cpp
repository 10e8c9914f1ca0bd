#include <cmath>

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include "core/geometry/wrench_matrix.h"
#include "support/problem_generator.h"

using namespace spidar;

namespace {

constexpr double kStep = 1e-6;       // of the central differences
constexpr double kDifference = 2e-9; // their error here: step^2 / length^2 and 1e-16 / step

// Rodrigues' rotation of v by angle_rad about a unit axis.
Vec3 turned(const Vec3 &v, const Vec3 &axis, double angle_rad) {
    return v * std::cos(angle_rad) + glm::cross(axis, v) * std::sin(angle_rad) +
           axis * (glm::dot(axis, v) * (1.0 - std::cos(angle_rad)));
}

// The pose moved along the seven rates of A: velocity, angular velocity, and alpha = -psi/2, which turns pole 1
// by +alpha and pole 2 by -alpha about n = unit(r1 x r2).
GripPose moved(const GripPose &pose, const PaperTwist &rates, double time) {
    const Vec3 normal = glm::normalize(glm::cross(pose.r1_m, pose.r2_m));
    const Vec3 omega(rates[3], rates[4], rates[5]);
    GripPose result = pose;
    result.position_m += time * Vec3(rates[0], rates[1], rates[2]);
    const auto turn = [time](const Vec3 &pole, const Vec3 &spin) {
        const double speed = glm::length(spin);
        return speed > 0.0 ? turned(pole, spin / speed, speed * time) : pole;
    };
    result.r1_m = turn(pose.r1_m, omega + rates[6] * normal);
    result.r2_m = turn(pose.r2_m, omega - rates[6] * normal);
    return result;
}

// Strings 1,2 -> P0+r1; 3,4 -> P0-r1; 5,7 -> P0+r2; 6,8 -> P0-r2, from the corners (+++)(-++)(+-+)(--+)(++-)(-+-)
// (+--)(---): written out here, apart from the sources.
double length_of(const GripPose &pose, std::size_t i) {
    const double h = kPaperHalfExtent_m;
    const Vec3 corners[] = {{h, h, h},  {-h, h, h},  {h, -h, h},  {-h, -h, h},
                            {h, h, -h}, {-h, h, -h}, {h, -h, -h}, {-h, -h, -h}};
    const Vec3 levers[] = {pose.r1_m, pose.r1_m,  -pose.r1_m, -pose.r1_m,
                           pose.r2_m, -pose.r2_m, pose.r2_m,  -pose.r2_m};
    return glm::length(corners[i] - pose.position_m - levers[i]);
}

StringArray shortening_rates(const GripPose &pose, const PaperTwist &rates) {
    StringArray result{};
    for (std::size_t i = 0; i < result.size(); ++i) {
        result[i] =
            (length_of(moved(pose, rates, -kStep), i) - length_of(moved(pose, rates, kStep), i)) /
            (2.0 * kStep);
    }
    return result;
}

WrenchMatrix paper_matrix(const GripPose &pose) {
    return wrench_matrix(make_box_frame(Vec3(kPaperHalfExtent_m)), GripGeometry{}, pose);
}

} // namespace

TEST_CASE("wrench matrix: A^T is minus the length rates, in all seven DOF of random poses") {
    test::Random random(1);
    for (int round = 0; round < 60; ++round) {
        const GripPose pose = test::random_pose(random, 0.15, random.uniform(0.3, 2.8));
        const WrenchMatrix matrix = paper_matrix(pose);
        for (std::size_t dof = 0; dof < static_cast<std::size_t>(kDofCount); ++dof) {
            PaperTwist rates{};
            rates[dof] = 1.0;
            const StringArray measured = shortening_rates(pose, rates);
            const StringArray computed = apply_transposed(matrix, rates);
            for (std::size_t i = 0; i < measured.size(); ++i) {
                CAPTURE(round);
                CAPTURE(dof);
                CAPTURE(i);
                CHECK(std::abs(measured[i] - matrix.columns[i][dof]) < kDifference);
                CHECK(computed[i] == matrix.columns[i][dof]);
            }
        }
    }
}

TEST_CASE("wrench matrix: columns at rest, by hand") {
    const WrenchMatrix matrix = paper_matrix(rest_pose(GripGeometry{}));
    CHECK_FALSE(matrix.grasp_row_vanishes);
    // String 1: from (0, d, 0) to (a, a, a); lever (0, d, 0); n = (0, 0, -1).
    const double a = 0.24;
    const double d = 0.04;
    const double length = std::sqrt(a * a + (a - d) * (a - d) + a * a);
    const PaperWrench first{a / length, (a - d) / length, a / length,    d * a / length,
                            0.0,        -d * a / length,  d * a / length};
    // String 6: from (-d, 0, 0) to (-a, a, -a); lever (-d, 0, 0), pole 2.
    const PaperWrench sixth{-(a - d) / length, a / length,      -a / length,    0.0,
                            -d * a / length,   -d * a / length, -d * a / length};
    for (std::size_t k = 0; k < first.size(); ++k) {
        CAPTURE(k);
        CHECK(std::abs(matrix.columns[0][k] - first[k]) < 1e-15);
        // r x c = (-d,0,0) x (cx,cy,cz) = (0, d cz, -d cy); delta = -1: g = -(n . m) = m_z = -d cy.
        CHECK(std::abs(matrix.columns[5][k] - sixth[k]) < 1e-15);
    }
}

TEST_CASE(
    "wrench matrix: equal tensions balance at rest, and one string alone pulls to its motor") {
    const GripPose rest = rest_pose(GripGeometry{});
    const WrenchMatrix matrix = paper_matrix(rest);
    StringArray tensions{};
    tensions.fill(1.0);
    for (double value : spidar::apply(matrix, tensions)) {
        CHECK(std::abs(value) < 1e-15);
    }
    const FrameGeometry frame = make_box_frame(Vec3(kPaperHalfExtent_m));
    for (std::size_t i = 0; i < tensions.size(); ++i) {
        tensions.fill(0.0);
        tensions[i] = 2.0;
        const Wrench wrench = from_paper(spidar::apply(matrix, tensions));
        const Vec3 to_motor =
            frame.motors_m[i] - attachment_point(GripGeometry{}, rest, static_cast<int>(i));
        CAPTURE(i);
        CHECK(glm::dot(wrench.force_n, glm::normalize(to_motor)) == doctest::Approx(2.0));
    }
}

TEST_CASE("wrench matrix: power of the strings = wrench . twist, with g = 2 grasp_torque") {
    test::Random random(2);
    for (int round = 0; round < 60; ++round) {
        const GripPose pose = test::random_pose(random, 0.1, random.uniform(0.5, 2.6));
        PaperTwist rates{};
        for (double &rate : rates) {
            rate = random.uniform(-1.0, 1.0);
        }
        StringArray tensions{};
        for (double &tension : tensions) {
            tension = random.uniform(0.0, 10.0);
        }
        const StringArray shortening = shortening_rates(pose, rates);
        double string_power = 0.0;
        for (std::size_t i = 0; i < tensions.size(); ++i) {
            string_power += tensions[i] * shortening[i];
        }
        const Wrench wrench = from_paper(spidar::apply(paper_matrix(pose), tensions));
        // grasp_angle = pi/2 - psi, alpha = -psi/2: its rate is 2 alpha'. Measured, not assumed:
        const auto psi = [](const GripPose &p) {
            return std::acos(glm::dot(p.r1_m, p.r2_m) /
                             (glm::length(p.r1_m) * glm::length(p.r2_m)));
        };
        const double grasp_rate =
            (psi(moved(pose, rates, -kStep)) - psi(moved(pose, rates, kStep))) / (2.0 * kStep);
        const double hand_power = glm::dot(wrench.force_n, Vec3(rates[0], rates[1], rates[2])) +
                                  glm::dot(wrench.moment_nm, Vec3(rates[3], rates[4], rates[5])) +
                                  wrench.grasp_torque_nm * grasp_rate;
        CAPTURE(round);
        CHECK(grasp_rate == doctest::Approx(2.0 * rates[6]).epsilon(1e-6));
        CHECK(std::abs(string_power - hand_power) < 1e-7);
        const PaperWrench there_and_back = to_paper(wrench);
        CHECK(there_and_back[6] == 2.0 * wrench.grasp_torque_nm);
    }
}

TEST_CASE("wrench matrix: parallel poles lose the grasp row and say so") {
    for (const double sign : {1.0, -1.0}) {
        GripPose pose = rest_pose(GripGeometry{});
        pose.r2_m = sign * pose.r1_m;
        const WrenchMatrix matrix = paper_matrix(pose);
        CHECK(matrix.grasp_row_vanishes);
        for (const PaperWrench &column : matrix.columns) {
            CHECK(column[6] == 0.0);
            CHECK(std::isfinite(column[0]));
        }
    }
    // A string of no length pulls nowhere.
    GripPose pose = rest_pose(GripGeometry{});
    pose.position_m = Vec3(kPaperHalfExtent_m) - pose.r1_m;
    const WrenchMatrix slack = paper_matrix(pose);
    for (double value : slack.columns[0]) {
        CHECK(value == 0.0);
    }
}

TEST_CASE("wrench matrix: the attachment table decides pole and end") {
    GripGeometry grip;
    grip.attachments[0] = {1, -1.0};
    const GripPose rest = rest_pose(grip);
    const FrameGeometry frame = make_box_frame(Vec3(kPaperHalfExtent_m));
    const PaperWrench column = wrench_matrix(frame, grip, rest).columns[0];
    const Vec3 pull = glm::normalize(frame.motors_m[0] + rest.r2_m);
    const Vec3 moment = glm::cross(-rest.r2_m, pull);
    CHECK(column[0] == doctest::Approx(pull.x));
    CHECK(column[5] == doctest::Approx(moment.z));
    CHECK(column[6] == doctest::Approx(moment.z)); // delta -1, n = -z
}
