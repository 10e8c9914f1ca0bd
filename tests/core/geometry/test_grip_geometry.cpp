#include <doctest/doctest.h>

#include <limits>

#include "core/geometry/grip_geometry.h"
#include "support/pose_helpers.h"

using namespace spidar;
using test::kDeg;

namespace {

constexpr double kHalfPi = 1.5707963267948966;

bool mentions(const std::string &text, const char *part) {
    return text.find(part) != std::string::npos;
}

} // namespace

TEST_CASE("grip: at rest the frame is the identity and all lengths are equal") {
    const GripGeometry grip;
    const GripPose rest = rest_pose(grip);
    CHECK(rest.r1_m == Vec3(0.0, 0.04, 0.0));
    CHECK(rest.r2_m == Vec3(0.04, 0.0, 0.0));
    const GripFrame frame = frame_of(rest, Mat3(0.0));
    CHECK(test::distance(frame.rotation, Mat3(1.0)) < 1e-15);
    CHECK(std::fabs(frame.crossing_angle_rad - kHalfPi) < 1e-15);
    CHECK(std::fabs(frame.grasp_angle_rad) < 1e-15);
    CHECK_FALSE(frame.rotation_held);
    CHECK(test::distance(make_pose(grip, Vec3(0.0), Mat3(1.0), 0.0), rest) == 0.0);

    // Pythagoras: 0.24 to the side, 0.24 - 0.04 along the pole, 0.24 up.
    const double expected = std::sqrt(0.24 * 0.24 + 0.20 * 0.20 + 0.24 * 0.24);
    for (const double length : string_lengths(test::paper_frame(), grip, rest)) {
        CHECK(std::fabs(length - expected) < 1e-15);
    }
}

TEST_CASE("grip: strings are tied as the paper says") {
    const GripGeometry grip;
    const GripPose pose{Vec3(1, 2, 3), Vec3(0.01, 0.02, 0.03), Vec3(0.04, 0.05, 0.06)};
    const Vec3 ends[] = {pose.position_m + pose.r1_m, pose.position_m + pose.r1_m,
                         pose.position_m - pose.r1_m, pose.position_m - pose.r1_m,
                         pose.position_m + pose.r2_m, pose.position_m - pose.r2_m,
                         pose.position_m + pose.r2_m, pose.position_m - pose.r2_m};
    for (int i = 0; i < kStringCount; ++i) {
        CHECK(attachment_point(grip, pose, i) == ends[i]);
    }
}

TEST_CASE("grip: lengths satisfy eq. (4)-(11), squared and written out") {
    const double a = 0.21;
    const double b = 0.24;
    const double c = 0.27;
    const GripGeometry grip;
    const GripPose pose = test::Random(3).pose(grip, 0.15, 0.5);
    const auto [x, y, z] =
        std::array<double, 3>{pose.position_m.x, pose.position_m.y, pose.position_m.z};
    const Vec3 &p = pose.r1_m;
    const Vec3 &q = pose.r2_m;
    const auto square = [](double u, double v, double w) { return u * u + v * v + w * w; };
    const StringArray squares{square(x + p.x - a, y + p.y - b, z + p.z - c),
                              square(x + p.x + a, y + p.y - b, z + p.z - c),
                              square(x - p.x - a, y - p.y + b, z - p.z - c),
                              square(x - p.x + a, y - p.y + b, z - p.z - c),
                              square(x + q.x - a, y + q.y - b, z + q.z + c),
                              square(x - q.x + a, y - q.y - b, z - q.z + c),
                              square(x + q.x - a, y + q.y + b, z + q.z + c),
                              square(x - q.x + a, y - q.y + b, z - q.z + c)};
    const StringArray lengths = string_lengths(make_box_frame(Vec3(a, b, c)), grip, pose);
    for (std::size_t i = 0; i < kStringCount; ++i) {
        CAPTURE(i);
        CHECK(std::fabs(lengths[i] * lengths[i] - squares[i]) < 1e-15);
    }
}

TEST_CASE("grip: pose -> frame -> pose is the same, and the frame is a rotation") {
    const GripGeometry grip;
    test::Random random(11);
    for (int i = 0; i < 500; ++i) {
        const Mat3 rotation = test::rotation_zyx(
            random.between(-3.1, 3.1), random.between(-1.5, 1.5), random.between(-3.1, 3.1));
        const double grasp = random.between(-80.0, 80.0) * kDeg;
        const GripPose pose = make_pose(grip, Vec3(0.1, -0.05, 0.02), rotation, grasp);
        const GripFrame frame = frame_of(pose, Mat3(0.0));
        CHECK(test::distance(frame.rotation, rotation) < 1e-14);
        CHECK(std::fabs(frame.grasp_angle_rad - grasp) < 1e-14);
        CHECK(std::fabs(frame.grasp_angle_rad + frame.crossing_angle_rad - kHalfPi) < 1e-15);
        CHECK(test::distance(glm::transpose(frame.rotation) * frame.rotation, Mat3(1.0)) < 4e-15);
        CHECK(glm::determinant(frame.rotation) > 0.0);
        const GripPose again =
            make_pose(grip, pose.position_m, frame.rotation, frame.grasp_angle_rad);
        CHECK(test::distance(again, pose) < 1e-15);
    }
}

TEST_CASE("grip: positive grasp angle closes the poles") {
    const GripGeometry grip;
    const GripPose closed = make_pose(grip, Vec3(0.0), Mat3(1.0), 30.0 * kDeg);
    const double angle =
        std::acos(glm::dot(closed.r1_m, closed.r2_m) / (0.04 * 0.04)); // far from 0: acos is fine
    CHECK(std::fabs(angle - 60.0 * kDeg) < 1e-14);
}

TEST_CASE("grip: parallel poles hold the rotation, nearly parallel ones do not") {
    const GripGeometry grip;
    const Mat3 before = test::rotation_zyx(0.3, 0.2, 0.1);
    for (const double side : {1.0, -1.0}) { // psi 0 and 180 degrees
        const GripPose parallel{Vec3(0.0), Vec3(0.0, 0.04, 0.0), Vec3(0.0, 0.04 * side, 0.0)};
        const GripFrame held = frame_of(parallel, before);
        CHECK(held.rotation_held);
        CHECK(held.rotation == before);
        CHECK(std::fabs(held.crossing_angle_rad - (side > 0.0 ? 0.0 : 2.0 * kHalfPi)) < 1e-15);

        const double off = 0.1 * kDeg;
        const double grasp = side > 0.0 ? kHalfPi - off : off - kHalfPi;
        const GripFrame free = frame_of(make_pose(grip, Vec3(0.0), before, grasp), Mat3(0.0));
        CHECK_FALSE(free.rotation_held);
        // Rounding of the pole ends over sin(psi).
        CHECK(test::distance(free.rotation, before) < 1e-15 / std::sin(off));
        CHECK(std::fabs(free.grasp_angle_rad - grasp) < 1e-15);
    }
}

TEST_CASE("grip: validate names field, value, unit and remedy") {
    const FrameGeometry frame = test::paper_frame();
    CHECK(validate(GripGeometry{}, frame).empty());
    CHECK(is_usable(GripGeometry{}, frame));

    GripGeometry bad;
    for (const double d : {0.0, -0.04, std::numeric_limits<double>::quiet_NaN()}) {
        bad.pole_half_length_m = d;
        CHECK(mentions(validate(bad, frame), "pole_half_length_m is "));
        CHECK(mentions(validate(bad, frame), " m; give at least"));
        CHECK_FALSE(is_usable(bad, frame));
    }
    bad.pole_half_length_m = 40.0;
    CHECK(mentions(validate(bad, frame), "pole_half_length_m is 40 m, longer than"));
    bad = GripGeometry{};
    bad.attachments[3].pole = 2;
    CHECK(mentions(validate(bad, frame), "attachments[3] (string 4).pole is 2 (index); use"));
    CHECK_FALSE(is_usable(bad, frame));
    bad = GripGeometry{};
    bad.attachments[6].sign = 0.5;
    CHECK(mentions(validate(bad, frame), "attachments[6] (string 7).sign is 0.5"));
    CHECK_FALSE(is_usable(bad, frame));
}
