// Surfaces that run along themselves: conveyors and turning tables drag the hand by friction, and move no shape.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>

#include "support/touch_gates.h"
#include "support/touch_rig.h"

using namespace spidar;
using namespace spidar::test;

namespace {

constexpr double kFriction = 0.4;
constexpr double kDepth_m = 0.005;
constexpr int kFrame = 16; // servo cycles

struct Dragged {
    Wrench wrench; // at the end
    double push_n = 0.0;
    double deepest_m = 0.0; // of all points, at all times
    Vec3 proxy_m{0.0};
};

// The device is held kDepth_m in a floor at height 0 at (x_m, z_m).
Dragged rest_on(TouchScene &touch, double foot_m, double x_m, double z_m, double time_s) {
    TouchRig rig;
    touch.scene.parts[0].friction = kFriction;
    Dragged result;
    const int ticks = static_cast<int>(time_s / kTick_s);
    for (int i = 0; i < ticks; ++i) {
        const double down_m = kDepth_m * std::min(1.0, i / 100.0);
        rig.motion.grip.pose.position_m = Vec3(x_m, foot_m - down_m, z_m);
        if (i % kFrame == 0) {
            rig.give(touch);
        }
        result.wrench = rig.tick();
        const TouchReport told = rig.report();
        for (int p = 0; p < told.point_count; ++p) {
            result.deepest_m =
                std::max(result.deepest_m, -told.points[static_cast<std::size_t>(p)].gap_m);
        }
        result.proxy_m = told.position_m;
    }
    result.push_n = result.wrench.force_n.y;
    return result;
}

} // namespace

TEST_CASE("touch: a conveyor drags a hand that rests on it with mu N along its way, and moves "
          "nothing else") {
    FloorScene still;
    const Dragged on_still = rest_on(still.touch, kBall_m, 0.0, 0.0, 1.0);
    REQUIRE(on_still.push_n > 1.0);
    CHECK(on_still.wrench.force_n.x == doctest::Approx(0.0));
    for (const Vec3 belt_m_s : {Vec3(0.1, 0.0, 0.0), Vec3(-0.1, 0.0, 0.0), Vec3(0.06, 0.0, -0.08),
                                Vec3(0.1, 0.1, 0.0), Vec3(0.1, -0.3, 0.0)}) {
        CAPTURE(belt_m_s.x);
        CAPTURE(belt_m_s.y);
        FloorScene floor;
        floor.touch.scene.parts[0].belt_m_s = belt_m_s;
        const Dragged dragged = rest_on(floor.touch, kBall_m, 0.0, 0.0, 1.0);
        const Vec3 along = glm::normalize(Vec3(belt_m_s.x, 0.0, belt_m_s.z));
        const Vec3 due_n = kFriction * dragged.push_n * along;
        const Vec3 felt_n(dragged.wrench.force_n.x, 0.0, dragged.wrench.force_n.z);
        CHECK(glm::distance(felt_n, due_n) < 0.05 * glm::length(due_n));
        // It presses no more and no less, and the tool is shown where it was.
        CHECK(dragged.push_n == doctest::Approx(on_still.push_n).epsilon(1e-9));
        CHECK(dragged.deepest_m <= on_still.deepest_m + 1e-9);
        CHECK(glm::distance(dragged.proxy_m, on_still.proxy_m) < 1e-9);
    }
}

TEST_CASE("touch: a turning table drags across the way to its axis, and turns what lies on it") {
    constexpr double kTurn_rad_s = 2.0;
    constexpr double kOut_m = 0.05;
    FloorScene table;
    ScenePart &part = table.touch.scene.parts[0];
    part.at.origin_m = Vec3(0.03, 0.0, 0.0); // where the velocity is told is not the axis
    part.belt_rad_s = Vec3(0.0, kTurn_rad_s, 0.0);
    part.belt_m_s = glm::cross(part.belt_rad_s, part.at.origin_m); // it turns about x = z = 0
    const Dragged dragged = rest_on(table.touch, kBall_m, 0.0, kOut_m, 1.0);
    CHECK(dragged.wrench.force_n.x == doctest::Approx(kFriction * dragged.push_n).epsilon(0.05));
    CHECK(std::abs(dragged.wrench.force_n.z) < 0.05 * kFriction * dragged.push_n);
    CHECK(dragged.deepest_m < 1e-6);

    constexpr double kHalf_m = 0.02;
    TouchScene face;
    add_tool(face, box_tool({kHalf_m, 0.01, kHalf_m}));
    add(face, cooked_half_space()).belt_rad_s = Vec3(0.0, kTurn_rad_s, 0.0);
    const Dragged turned = rest_on(face, 0.01, 0.0, 0.0, 1.0);
    // Four corners, each with a quarter of mu N at its lever.
    const double due_nm = kFriction * turned.push_n * kHalf_m * std::sqrt(2.0);
    CHECK(turned.wrench.moment_nm.y == doctest::Approx(due_nm).epsilon(0.05));
    CHECK(glm::length(Vec3(turned.wrench.force_n.x, 0.0, turned.wrench.force_n.z)) <
          0.05 * kFriction * turned.push_n);
    CHECK(turned.deepest_m < 1e-6);
}

TEST_CASE("touch: a belt without friction is not felt, and a hand that runs along with one is not "
          "dragged") {
    FloorScene slick;
    slick.touch.scene.parts[0].belt_m_s = Vec3(0.1, 0.0, 0.0);
    TouchRig rig;
    rig.motion.grip.pose.position_m = Vec3(0.0, kBall_m - kDepth_m, 0.0);
    for (int i = 0; i < 500; ++i) {
        if (i % kFrame == 0) {
            rig.give(slick.touch);
        }
        CHECK(std::abs(rig.tick().force_n.x) < 1e-12);
    }
    TouchRig with;
    FloorScene belt;
    belt.touch.scene.parts[0].belt_m_s = Vec3(0.1, 0.0, 0.0);
    belt.touch.scene.parts[0].friction = kFriction;
    with.motion.velocity.linear_m_s = Vec3(0.1, 0.0, 0.0);
    double most_n = 0.0;
    for (int i = 0; i < 1000; ++i) {
        with.motion.grip.pose.position_m =
            Vec3(0.1 * kTick_s * i, kBall_m - kDepth_m * std::min(1.0, i / 100.0), 0.0);
        if (i % kFrame == 0) {
            with.give(belt.touch);
        }
        most_n = std::max(most_n, std::abs(with.tick().force_n.x));
    }
    CHECK(with.report().point_count > 0);
    CHECK(most_n < 0.08); // one cycle's slip as the first point is made
}

TEST_CASE("touch: a belt is brought down to the greatest speed of surfaces, and one without a "
          "number is refused") {
    FloorScene fast;
    fast.touch.scene.parts[0].belt_m_s = Vec3(1e100, 0.0, 0.0);
    fast.touch.scene.parts[0].friction = kFriction;
    fast.touch.state_time_s = 0.0;
    TouchRig rig;
    REQUIRE(usable(validate(fast.touch)));
    const GainClamp clamp = rig.renderer.accept(fast.touch, 1, 0.0);
    CHECK(clamp.gain == GainClamp::Gain::speed);
    rig.motion.grip.pose.position_m = Vec3(0.0, kBall_m - kDepth_m, 0.0);
    const Wrench wrench = rig.ticks(50);
    CHECK(wrench.force_n.x == doctest::Approx(kFriction * wrench.force_n.y).epsilon(0.05));
    fast.touch.scene.parts[0].belt_m_s.x = std::numeric_limits<double>::quiet_NaN();
    CHECK(validate(fast.touch) == Status::not_finite);
    fast.touch.scene.parts[0].belt_m_s.x = 0.0;
    fast.touch.scene.parts[0].belt_rad_s.z = std::numeric_limits<double>::infinity();
    CHECK(validate(fast.touch) == Status::not_finite);
}
