#include <doctest/doctest.h>

#include <limits>

#include "core/geometry/frame_geometry.h"
#include "support/pose_helpers.h"

using namespace spidar;

namespace {

bool mentions(const std::string &text, const char *part) {
    return text.find(part) != std::string::npos;
}

} // namespace

TEST_CASE("frame: corners of the box in the paper's order") {
    const FrameGeometry frame = make_box_frame(Vec3(0.1, 0.2, 0.3));
    CHECK(frame.motors_m[0] == Vec3(0.1, 0.2, 0.3));
    CHECK(frame.motors_m[1] == Vec3(-0.1, 0.2, 0.3));
    CHECK(frame.motors_m[2] == Vec3(0.1, -0.2, 0.3));
    CHECK(frame.motors_m[3] == Vec3(-0.1, -0.2, 0.3));
    CHECK(frame.motors_m[4] == Vec3(0.1, 0.2, -0.3));
    CHECK(frame.motors_m[5] == Vec3(-0.1, 0.2, -0.3));
    CHECK(frame.motors_m[6] == Vec3(0.1, -0.2, -0.3));
    CHECK(frame.motors_m[7] == Vec3(-0.1, -0.2, -0.3));
}

TEST_CASE("frame: a box is recognised, a bent one is not") {
    FrameGeometry frame = make_box_frame(Vec3(0.1, 0.2, 0.3));
    const std::optional<Vec3> box = box_half_extents(frame);
    REQUIRE(box.has_value());
    CHECK(glm::distance(*box, Vec3(0.1, 0.2, 0.3)) < 1e-16);
    frame.motors_m[5].y += 1e-5;
    CHECK_FALSE(box_half_extents(frame).has_value());
    CHECK_FALSE(box_half_extents(make_box_frame(Vec3(0.1, 0.0, 0.3))).has_value());
    frame.motors_m[5].y = std::numeric_limits<double>::quiet_NaN();
    CHECK_FALSE(box_half_extents(frame).has_value());
}

TEST_CASE("frame: validate names field, value, unit and remedy") {
    CHECK(validate(test::paper_frame()).empty());
    CHECK(is_usable(test::paper_frame()));

    FrameGeometry nan_frame = test::paper_frame();
    nan_frame.motors_m[2].y = std::numeric_limits<double>::quiet_NaN();
    const std::string nan_message = validate(nan_frame);
    CHECK(mentions(nan_message, "motors_m[2] (string 3).y is nan m; give"));
    CHECK_FALSE(is_usable(nan_frame));

    const FrameGeometry millimetres = make_box_frame(Vec3(240.0));
    CHECK(mentions(validate(millimetres), "motors_m[0] (string 1).x is 240 m"));
    CHECK(mentions(validate(millimetres), "not millimeters"));
    CHECK_FALSE(is_usable(millimetres));

    const FrameGeometry point{};
    CHECK(mentions(validate(point), "motors_m spans 0 m; give"));
    CHECK_FALSE(is_usable(point));

    const FrameGeometry flat = make_box_frame(Vec3(0.24, 0.24, 0.0));
    CHECK(mentions(validate(flat), "motors_m lie in a slab 0 m thick; spread"));
    CHECK_FALSE(is_usable(flat));
}
