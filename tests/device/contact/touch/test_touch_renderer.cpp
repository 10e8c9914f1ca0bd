// What a hand feels of a game's scene of shapes: forces in closed form, what happens between two frames of the game, when
// the game is late, and what may not be published.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <random>

#include <glm/geometric.hpp>

#include "core/geometry/rotation_log.h"
#include "support/allocation_trap.h"
#include "support/touch_rig.h"

using namespace spidar;
using namespace spidar::test;

namespace {

double automatic_n_m(const ServoSettings &settings) {
    return kAutomaticShare * gain_caps(settings.render, settings.rate_hz).stiffness_n_m;
}

} // namespace

TEST_CASE(
    "touch: a floor pushes with the automatic stiffness, 60 % of the cap, or with what was asked") {
    for (const double asked_n_m : {0.0, 500.0}) {
        TouchRig rig;
        FloorScene floor(0.0, asked_n_m);
        rig.motion.grip.pose.position_m.y = kBall_m + 0.001;
        rig.give(floor.touch);
        CHECK(rig.tick().force_n.y == 0.0);
        rig.motion.grip.pose.position_m.y = kBall_m - 0.004;
        const double stiffness_n_m = asked_n_m > 0.0 ? asked_n_m : automatic_n_m(rig.settings);
        const Wrench wrench = rig.ticks(3);
        CHECK(wrench.force_n.y == doctest::Approx(0.004 * stiffness_n_m).epsilon(1e-4));
        CHECK(rig.report().position_m.y == doctest::Approx(kBall_m).epsilon(1e-6));
    }
}

TEST_CASE("touch: a stiffness above the cap is brought down to it, and told") {
    TouchRig rig;
    FloorScene floor(0.0, 1e5);
    floor.touch.state_time_s = 0.0;
    const GainClamp clamp = rig.renderer.accept(floor.touch, 1, 0.0);
    CHECK(clamp.gain == GainClamp::Gain::stiffness);
    CHECK(clamp.asked == 1e5);
    rig.motion.grip.pose.position_m.y = kBall_m + 0.001;
    rig.tick();
    rig.motion.grip.pose.position_m.y = kBall_m - 0.002;
    const double cap_n_m = gain_caps(rig.settings.render, rig.settings.rate_hz).stiffness_n_m;
    CHECK(rig.ticks(3).force_n.y == doctest::Approx(0.002 * cap_n_m).epsilon(1e-4));
}

TEST_CASE("touch: where nothing is near, the proxy is the device and no shape is looked at") {
    TouchRig rig;
    FloorScene floor(-1.0);
    rig.give(floor.touch);
    rig.motion.grip.pose.position_m = Vec3(0.01, 0.02, 0.03);
    CHECK(rig.ticks(5).force_n == Vec3(0.0));
    CHECK(rig.report().position_m == rig.motion.grip.pose.position_m);
    TouchScene nothing;
    rig.give(nothing);
    rig.tick();
    CHECK(rig.renderer.at_rest());
    CHECK(rig.report().queries == 0);
    CHECK(rig.report().point_count == 0);
}

TEST_CASE("touch: a floor that moves is felt where it is, between the frames of a game") {
    TouchRig rig;
    constexpr double kSpeed_m_s = 0.1;
    FloorScene floor;
    floor.touch.damping_n_s_m = 0.0;
    const double stiffness_n_m = automatic_n_m(rig.settings);
    rig.motion.grip.pose.position_m.y = kBall_m - 0.001;
    double worst_n = 0.0;
    for (int i = 0; i < 60; ++i) {
        if (i % 16 == 0) {
            ScenePart &part = floor.touch.scene.parts[0];
            part.at.origin_m.y = kSpeed_m_s * rig.time_s - 0.002;
            part.velocity_m_s.y = kSpeed_m_s;
            rig.give(floor.touch);
        }
        const Wrench wrench = rig.tick();
        const double depth_m = kSpeed_m_s * rig.time_s - 0.001;
        worst_n =
            std::max(worst_n, std::abs(wrench.force_n.y - stiffness_n_m * std::max(0.0, depth_m)));
    }
    CHECK(worst_n < 0.01 * stiffness_n_m * 0.005);
}

TEST_CASE("touch: what a new scene corrects comes within a game frame, without a blow; what was "
          "put elsewhere is there at once") {
    TouchRig rig;
    FloorScene floor;
    floor.touch.damping_n_s_m = 0.0;
    rig.motion.grip.pose.position_m.y = kBall_m + 0.001;
    rig.give(floor.touch);
    rig.ticks(30);
    const double stiffness_n_m = automatic_n_m(rig.settings);
    floor.touch.scene.parts[0].at.origin_m.y = 0.004;
    rig.give(floor.touch);
    double before_n = 0.0;
    double most_n = 0.0;
    for (int i = 0; i < 20; ++i) {
        const double now_n = rig.tick().force_n.y;
        most_n = std::max(most_n, now_n - before_n);
        before_n = now_n;
    }
    CHECK(before_n == doctest::Approx(0.003 * stiffness_n_m).epsilon(1e-3));
    CHECK(most_n < 1.1 * stiffness_n_m * 0.004 / 16.0);
    floor.touch.scene.parts[0].at.origin_m.y = -0.5;
    rig.give(floor.touch);
    CHECK(rig.tick().force_n.y == 0.0);
}

TEST_CASE("touch: a game that falls silent fades away, and comes back without a blow") {
    TouchRig rig;
    FloorScene floor;
    rig.motion.grip.pose.position_m.y = kBall_m + 0.001;
    rig.give(floor.touch);
    rig.tick();
    rig.motion.grip.pose.position_m.y = kBall_m - 0.004;
    const double full_n = rig.ticks(20).force_n.y;
    CHECK(full_n > 1.0);
    double before_n = full_n;
    for (int i = 0; i < 320; ++i) {
        const double now_n = rig.tick().force_n.y;
        CHECK(now_n <= before_n + 1e-12);
        CHECK(before_n - now_n < 0.02 * full_n);
        before_n = now_n;
    }
    CHECK(before_n == 0.0);
    CHECK(rig.expired == 1);
    rig.give(floor.touch);
    CHECK(rig.tick().force_n.y < 0.05 * full_n);
}

TEST_CASE("touch: a load is felt in full in free air, and not at all on what carries it") {
    TouchRig rig;
    FloorScene floor(0.0, 800.0);
    floor.touch.load.force_n.y = -0.8;
    rig.motion.grip.pose.position_m.y = kBall_m;
    rig.give(floor.touch);
    CHECK(std::abs(rig.ticks(30).force_n.y) < 1e-6);
    CHECK(rig.report().position_m.y == doctest::Approx(kBall_m));
    // The floor gets the weight.
    const Vec3 before_ns = rig.report().parts[0].impulse_ns;
    rig.tick();
    CHECK((rig.report().parts[0].impulse_ns.y - before_ns.y) / kTick_s ==
          doctest::Approx(-0.8).epsilon(1e-3));
    // Half of it is lifted half a millimetre up: the spring of 800 N/m hangs 1 mm through.
    rig.motion.grip.pose.position_m.y = kBall_m + 0.0005;
    CHECK(rig.ticks(2).force_n.y == doctest::Approx(-0.4).epsilon(1e-3));
    rig.motion.grip.pose.position_m.y = kBall_m + 0.01;
    CHECK(rig.ticks(2).force_n.y == doctest::Approx(-0.8).epsilon(1e-6));
    floor.touch.load = Wrench();
    rig.give(floor.touch);
    CHECK(rig.tick().force_n.y < -0.7); // it does not vanish in one cycle
    rig.give(floor.touch);
    CHECK(rig.ticks(20).force_n.y == 0.0);
}

TEST_CASE("touch: jaws stop where they hold something, or on each other") {
    TouchRig rig;
    TouchScene held;
    held.tool.stop_rad = 0.3;
    rig.give(held);
    rig.motion.grip.frame.grasp_angle_rad = 0.25;
    CHECK(rig.tick().grasp_torque_nm == 0.0);
    rig.motion.grip.frame.grasp_angle_rad = 0.5;
    rig.give(held);
    const double stiffness_nm_rad =
        kAutomaticShare *
        gain_caps(rig.settings.render, rig.settings.rate_hz).grasp_stiffness_nm_rad;
    CHECK(rig.tick().grasp_torque_nm == doctest::Approx(-0.2 * stiffness_nm_rad).epsilon(1e-4));
    CHECK(rig.report().stop_push_nm == doctest::Approx(0.2 * stiffness_nm_rad).epsilon(1e-4));
    rig.tick();
    CHECK(rig.report().grasp_rad == doctest::Approx(0.3).epsilon(1e-6));
    TouchScene open;
    rig.give(open);
    CHECK(rig.tick().grasp_torque_nm == 0.0);
    rig.motion.grip.frame.grasp_angle_rad = open.tool.jaws.closed_rad + 0.1;
    CHECK(rig.tick().grasp_torque_nm == doctest::Approx(-0.1 * stiffness_nm_rad).epsilon(1e-4));
}

TEST_CASE("touch: DOF that are not felt push nobody, and the load is felt all the same") {
    TouchRig rig;
    FloorScene floor(0.0, 800.0);
    floor.touch.felt = 0b1000000;
    rig.motion.grip.pose.position_m.y = kBall_m + 0.001;
    rig.give(floor.touch);
    rig.tick();
    rig.motion.grip.pose.position_m.y = kBall_m - 0.004;
    CHECK(rig.ticks(3).force_n.y == 0.0);
    CHECK(rig.report().position_m.y == doctest::Approx(kBall_m));
}

TEST_CASE("touch: pads and what they hold touch what they are meant to") {
    TouchRig rig;
    FloorScene floor;
    floor.touch.scene.parts[0].groups = kHeldGroup;
    floor.touch.tool.parts[0].groups = kPadGroup;
    rig.motion.grip.pose.position_m.y = kBall_m - 0.004;
    rig.give(floor.touch);
    CHECK(rig.ticks(3).force_n.y == 0.0);
    floor.touch.tool.parts[0].groups = kHeldGroup | kPadGroup;
    rig.give(floor.touch);
    CHECK(rig.ticks(3).force_n.y > 0.0);
}

TEST_CASE("touch: what does not change costs nothing, and is counted") {
    TouchRig rig;
    FloorScene floor;
    rig.motion.grip.pose.position_m.y = kBall_m + 0.001;
    rig.give(floor.touch);
    rig.tick();
    rig.motion.grip.pose.position_m.y = kBall_m - 0.002;
    const Wrench wrench = rig.ticks(40);
    const std::uint64_t skipped = rig.report().skipped;
    CHECK(rig.ticks(10).force_n == wrench.force_n);
    CHECK(rig.report().skipped == skipped + 10);
    rig.motion.grip.pose.position_m.y -= 1e-6;
    rig.tick();
    CHECK(rig.report().skipped == skipped + 10);
}

TEST_CASE("touch: no cycle allocates, and none says anything that is not finite") {
    TouchRig rig;
    std::mt19937_64 random(5);
    std::normal_distribution<double> normal;
    TouchScene touch;
    add_tool(touch, make_pad(0.012, 0.003, 0.003), ToolMount::jaw_minus,
             {Vec3(-0.003, 0.0, 0.0), Mat3(1.0)});
    add_tool(touch, make_pad(0.012, 0.003, 0.003), ToolMount::jaw_plus,
             {Vec3(0.003, 0.0, 0.0), Mat3(1.0)});
    for (int i = 0; i < 8; ++i) {
        ScenePart &part = add(touch, box(Vec3(0.02)));
        part.friction = 0.5;
    }
    std::size_t allocated = 0;
    for (int frame = 0; frame < 200; ++frame) {
        const auto draw = [&](double size) {
            return size * Vec3(normal(random), normal(random), normal(random));
        };
        for (int s = 0; s < touch.scene.count; ++s) {
            ScenePart &part = touch.scene.parts[static_cast<std::size_t>(s)];
            part.at = {draw(0.05), rotation_exp(draw(1.0))};
            part.velocity_m_s = draw(0.3);
            part.angular_rad_s = draw(2.0);
        }
        touch.load = {draw(1.0), draw(0.05), 0.0};
        touch.tool.stop_rad = frame % 3 == 0 ? 0.4 : std::numeric_limits<double>::infinity();
        rig.give(touch);
        const Vec3 step_m = draw(2e-4);
        for (int i = 0; i < 16; ++i) {
            rig.motion.grip.pose.position_m += step_m;
            rig.motion.grip.frame.grasp_angle_rad = 0.4 + 0.3 * std::sin(0.01 * (16 * frame + i));
            const std::size_t before = allocations_of_this_thread();
            const Wrench wrench = rig.tick();
            allocated += allocations_of_this_thread() - before;
            CHECK(std::isfinite(glm::length(wrench.force_n) + glm::length(wrench.moment_nm) +
                                wrench.grasp_torque_nm));
        }
        REQUIRE(rig.renderer.is_sound());
    }
    CHECK(allocated == 0);
}

TEST_CASE("touch: a scene that makes no sense is refused, and the last good one stands") {
    const auto status_of = [](auto &&spoil) {
        FloorScene floor;
        spoil(floor.touch);
        return validate(floor.touch);
    };
    constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
    CHECK(usable(status_of([](TouchScene &) {})));
    CHECK(status_of([](TouchScene &t) { t.scene.count = 33; }) == Status::invalid_request);
    CHECK(status_of([](TouchScene &t) { t.scene.count = -1; }) == Status::invalid_request);
    CHECK(status_of([](TouchScene &t) { t.tool.count = 17; }) == Status::invalid_request);
    CHECK(status_of([](TouchScene &t) { t.scene.parts[0].shape = nullptr; }) ==
          Status::invalid_request);
    CHECK(status_of([](TouchScene &t) { t.tool.parts[0].shape = nullptr; }) ==
          Status::invalid_request);
    CHECK(status_of([](TouchScene &t) { t.felt = 0x80; }) == Status::invalid_request);
    CHECK(status_of([](TouchScene &t) { t.stiffness[2] = -1.0; }) == Status::invalid_request);
    CHECK(status_of([](TouchScene &t) { t.tool.jaws.closed_rad = 0.0; }) ==
          Status::invalid_request);
    CHECK(status_of([](TouchScene &t) { t.scene.parts[0].friction = -1.0; }) ==
          Status::invalid_request);
    CHECK(status_of([=](TouchScene &t) { t.load.moment_nm.x = kNan; }) == Status::not_finite);
    CHECK(status_of([=](TouchScene &t) { t.tool.stop_rad = kNan; }) == Status::not_finite);
    CHECK(status_of([=](TouchScene &t) { t.scene.parts[0].at.origin_m.x = kNan; }) ==
          Status::not_finite);
    CHECK(status_of([=](TouchScene &t) { t.scene.parts[0].velocity_m_s.x = kNan; }) ==
          Status::not_finite);

    Bench bench;
    bench.settings.safety.arming_time_s = 0.01;
    bench.start();
    bench.activate();
    FloorScene floor(-kBall_m + 0.002);
    ++bench.command.touch_sequence;
    bench.command.touch = &floor.touch;
    bench.tick(10);
    const double felt_n = bench.now().requested.force_n.y;
    CHECK(felt_n > 1.0);
    FloorScene bad;
    bad.touch.load.force_n.x = kNan;
    ++bench.command.touch_sequence;
    bench.command.touch = &bad.touch;
    bench.tick();
    CHECK(bench.now().counters.rejected_requests == 1);
    CHECK(bench.now().touch.sequence == bench.command.touch_sequence - 1);
    CHECK(bench.now().requested.force_n.y == doctest::Approx(felt_n).epsilon(0.02));
    // Nothing any more.
    ++bench.command.touch_sequence;
    bench.command.touch = nullptr;
    bench.tick(2);
    CHECK(bench.now().requested.force_n.y == 0.0);
}

TEST_CASE("touch: without a memory for shapes a scene is refused") {
    Bench bench;
    bench.step.use(nullptr);
    bench.start();
    FloorScene floor;
    ++bench.command.touch_sequence;
    bench.command.touch = &floor.touch;
    bench.tick(2);
    CHECK(bench.now().counters.rejected_requests == 1);
    CHECK(bench.now().requested.force_n == Vec3(0.0));
}
