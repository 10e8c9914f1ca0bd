// A tool that holds something tied to the scene: hinges, slides, balls, their limits, springs, dampers and motors.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/geometry/rotation_log.h"
#include "support/proxy_rig.h"

using namespace spidar;
using namespace spidar::test;

namespace {

constexpr double kLever_m = 0.06; // from the hinge to the grip
constexpr double kLinear_n_m = 1000.0;
constexpr double kTurn_nm_rad = 2.0;
// Of the grip on its springs, about the hinge.
constexpr double kAboutHinge_nm_rad = kLinear_n_m * kLever_m * kLever_m + kTurn_nm_rad;

// A door whose handle is held at the origin: it turns about y, 60 mm to the left.
struct Door : ProxyRig {
    ToolJoint &joint;
    explicit Door(const JointAxis &hinge = JointAxis::free()) : joint(tool.joints[0]) {
        add_tool(make_sphere(0.005));
        joint.id = 1;
        joint.base.origin_m = Vec3(-kLever_m, 0.0, 0.0);
        joint.in_grip.origin_m = Vec3(-kLever_m, 0.0, 0.0);
        joint.axes[4] = hinge;
        tool.joint_count = 1;
        start_at(ToolPose());
        proxy.tie(tool, 0.0);
        tick();
    }
    // Where the handle is with the door open by `angle`.
    static ToolPose opened(double angle) {
        ToolPose pose;
        pose.rotation = rotation_exp(Vec3(0.0, angle, 0.0));
        pose.position_m = Vec3(-kLever_m, 0.0, 0.0) + pose.rotation * Vec3(kLever_m, 0.0, 0.0);
        return pose;
    }
    void swing(double from, double to, int ticks) {
        for (int i = 1; i <= ticks; ++i) {
            device = opened(from + (to - from) * i / ticks);
            tick();
        }
    }
    // Of the hand's wrench, about the hinge.
    [[nodiscard]] double moment_nm() const {
        const Wrench &felt = proxy.wrench();
        const Vec3 lever_m = device.position_m - Vec3(-kLever_m, 0.0, 0.0);
        return felt.moment_nm.y + glm::cross(lever_m, felt.force_n).y;
    }
    [[nodiscard]] double angle() const { return proxy.joints().coordinate(4); }
};

// Nothing but the hinge moves.
void check_on_its_hinge(const Door &door) {
    for (const int axis : {0, 1, 2, 3, 5}) {
        CAPTURE(axis);
        CHECK(std::abs(door.proxy.joints().coordinate(axis)) < 2e-6);
    }
}

} // namespace

TEST_CASE("joints: a door turns about its hinge and nothing else, wherever the hand goes") {
    Door door;
    door.swing(0.0, 1.2, 600);
    CHECK(door.angle() == doctest::Approx(1.2).epsilon(1e-6));
    CHECK(glm::length(door.proxy.wrench().force_n) < 1e-3);
    check_on_its_hinge(door);
    // Pulled out of its hinge by 3 mm and up by 2 mm, it stays, and pulls back.
    const ToolPose there = door.device;
    ToolPose pulled = there;
    pulled.position_m += 0.003 * there.rotation[0] + Vec3(0.0, 0.002, 0.0);
    door.move_to(pulled, 100);
    check_on_its_hinge(door);
    const Wrench felt = door.proxy.wrench();
    CHECK(glm::dot(felt.force_n, there.rotation[0]) == doctest::Approx(-3.0).epsilon(1e-3));
    CHECK(felt.force_n.y == doctest::Approx(-2.0).epsilon(1e-3));
    CHECK(std::abs(door.moment_nm()) < 1e-6); // free about its hinge
    // And turned against it.
    pulled.rotation = rotation_exp(Vec3(0.0, 0.0, 0.1)) * there.rotation;
    pulled.position_m = there.position_m;
    door.move_to(pulled, 100);
    check_on_its_hinge(door);
    CHECK(door.proxy.wrench().moment_nm.z == doctest::Approx(-0.2).epsilon(0.02));
}

TEST_CASE("joints: torque against angle is the hinge's spring, and about its axis alone") {
    JointAxis hinge = JointAxis::free();
    hinge.stiffness = 0.8;
    hinge.rest = 0.2;
    Door door(hinge);
    for (const double angle : {0.5, -0.4, 1.5}) {
        door.swing(0.0, angle, 300);
        door.swing(angle, angle, 50);
        CAPTURE(angle);
        // The grip on its springs and the door's spring share the way.
        const double due = -0.8 * (door.angle() - 0.2);
        CHECK(door.moment_nm() == doctest::Approx(due).epsilon(1e-3));
        CHECK(door.angle() - 0.2 ==
              doctest::Approx((angle - 0.2) * kAboutHinge_nm_rad / (kAboutHinge_nm_rad + 0.8))
                  .epsilon(2e-3));
        check_on_its_hinge(door);
        door.swing(angle, 0.0, 300);
    }
}

TEST_CASE("joints: the hinge's damping is felt as damping times speed") {
    JointAxis hinge = JointAxis::free();
    hinge.damping = 0.3;
    Door door(hinge);
    door.swing(0.0, 1.0, 1000); // 1 rad/s
    CHECK(std::abs(door.moment_nm() + 0.3) < 3e-4);
    door.swing(1.0, 1.0, 2000);
    CHECK(std::abs(door.moment_nm()) < 1e-3);
}

TEST_CASE("joints: a limit stops the door, and lets go of it at once") {
    JointAxis hinge;
    hinge.lower = -0.3;
    hinge.upper = 0.9;
    Door door(hinge);
    double before = 0.0;
    for (int i = 1; i <= 1200; ++i) {
        door.swing(0.001 * (i - 1), 0.001 * i, 1);
        CHECK(door.angle() <= 0.9 + 1e-6);
        CHECK(std::abs(door.moment_nm() - before) < 0.01);
        before = door.moment_nm();
    }
    CHECK(door.moment_nm() == doctest::Approx(-0.3 * kAboutHinge_nm_rad).epsilon(0.02));
    door.swing(1.2, 0.85, 350);
    CHECK(std::abs(door.moment_nm()) < 1e-6);
    door.swing(0.85, -0.5, 900);
    CHECK(door.angle() == doctest::Approx(-0.3).epsilon(1e-6));
    check_on_its_hinge(door);
}

TEST_CASE(
    "joints: a door that something blocks stays where it is, and pushes along its way alone") {
    Door door;
    // A wall in front of the handle: the door turns towards -z.
    door.add(half_space(Vec3(0.0, 0.0, 1.0), -0.02));
    for (int i = 1; i <= 800; ++i) {
        door.swing(0.001 * (i - 1), 0.001 * i, 1);
        check_on_its_hinge(door);
    }
    const double handle_z = door.proxy.pose().position_m.z;
    CHECK(std::abs(handle_z - (-0.02 + 0.005)) < 1e-5);
    CHECK(door.moment_nm() < -0.2);
}

TEST_CASE("joints: a drawer slides along its rail, a knob turns on, a ball turns every way") {
    Door drawer;
    drawer.joint.axes = {};
    drawer.joint.axes[2].lower = -0.05;
    drawer.joint.axes[2].upper = 0.15;
    drawer.joint.id = 2;
    drawer.proxy.tie(drawer.tool, 0.0);
    ToolPose out;
    out.position_m = Vec3(0.004, 0.0, 0.2);
    drawer.move_to(out, 500);
    CHECK(drawer.proxy.pose().position_m.z == doctest::Approx(0.15).epsilon(1e-6));
    CHECK(drawer.proxy.wrench().force_n.x == doctest::Approx(-4.0).epsilon(1e-3));
    CHECK(drawer.proxy.wrench().force_n.z == doctest::Approx(-50.0).epsilon(1e-3));

    Door knob;
    knob.joint.base.origin_m = Vec3(0.0);
    knob.joint.in_grip.origin_m = Vec3(0.0);
    knob.joint.id = 3;
    knob.joint.axes[4].stiffness = 0.05;
    knob.proxy.tie(knob.tool, 0.0);
    for (int i = 1; i <= 4000; ++i) { // more than a whole turn
        knob.device.rotation = rotation_exp(Vec3(0.0, 0.002 * i, 0.0));
        knob.tick();
    }
    CHECK(knob.proxy.joints().coordinate(4) == doctest::Approx(8.0 * 2.0 / 2.05).epsilon(1e-3));
    CHECK(knob.proxy.wrench().moment_nm.y ==
          doctest::Approx(-0.05 * knob.proxy.joints().coordinate(4)).epsilon(1e-3));

    Door ball;
    ball.joint.id = 4;
    ball.joint.axes = {};
    for (const std::size_t axis : {3U, 4U, 5U}) {
        ball.joint.axes[axis] = JointAxis::free();
    }
    ball.proxy.tie(ball.tool, 0.0);
    ToolPose turned;
    turned.rotation = rotation_exp(Vec3(0.3, 0.5, -0.4));
    turned.position_m = Vec3(-kLever_m, 0.0, 0.0) + turned.rotation * Vec3(kLever_m, 0.0, 0.0);
    ball.move_to(turned, 400);
    CHECK(glm::length(ball.proxy.wrench().force_n) < 0.05);
    const Vec3 held =
        ball.proxy.pose().position_m + ball.proxy.pose().rotation * Vec3(-kLever_m, 0.0, 0.0);
    CHECK(glm::distance(held, Vec3(-kLever_m, 0.0, 0.0)) < 2e-6);
}

TEST_CASE(
    "joints: several turns: each limit holds, and each spring pulls as a gradient of its energy") {
    Door joint;
    joint.joint.id = 5;
    joint.joint.axes = {};
    for (const std::size_t axis : {3U, 4U, 5U}) {
        joint.joint.axes[axis].lower = -0.3;
        joint.joint.axes[axis].upper = 0.4;
    }
    joint.joint.base.origin_m = Vec3(0.0);
    joint.joint.in_grip.origin_m = Vec3(0.0);
    joint.proxy.tie(joint.tool, 0.0);
    ToolPose turned;
    turned.rotation = rotation_exp(Vec3(0.8, -0.7, 0.1));
    joint.move_to(turned, 800);
    CHECK(joint.proxy.joints().coordinate(3) == doctest::Approx(0.4).epsilon(1e-3));
    CHECK(joint.proxy.joints().coordinate(4) == doctest::Approx(-0.3).epsilon(1e-3));
}

TEST_CASE("joints: a motor moves the door at its speed, as hard as it is, and no harder") {
    JointAxis hinge = JointAxis::free();
    hinge.motor_speed = 0.5;
    hinge.motor_most = 0.2;
    Door door(hinge);
    for (int i = 0; i < 3000; ++i) {
        door.tick(); // the hand holds it
    }
    CHECK(door.moment_nm() == doctest::Approx(0.2).epsilon(1e-3));
    CHECK(std::abs(door.angle() - 0.2 / kAboutHinge_nm_rad) < 1e-4);
    // The hand goes along faster than the motor: it brakes.
    door.swing(0.0, 2.0, 1000);
    CHECK(door.moment_nm() == doctest::Approx(-0.2).epsilon(1e-2));
}

TEST_CASE("joints: two hinges of one door are one") {
    JointAxis hinge = JointAxis::free();
    hinge.stiffness = 0.4;
    Door door(hinge);
    ToolJoint &second = door.tool.joints[1];
    second = door.joint;
    second.id = 2;
    second.base.origin_m.y = 0.1;
    second.in_grip.origin_m.y = 0.1;
    second.axes[4].stiffness = 0.0;
    door.tool.joint_count = 2;
    door.proxy.tie(door.tool, 0.0);
    door.swing(0.0, 0.7, 400);
    door.swing(0.7, 0.7, 50);
    CHECK(door.moment_nm() == doctest::Approx(-0.4 * door.angle()).epsilon(1e-3));
    check_on_its_hinge(door);
}

TEST_CASE("joints: what is caught beside its place comes there without a blow") {
    Door door;
    door.joint.id = 7;
    door.joint.in_grip.origin_m += Vec3(0.0, 0.001, 0.0005);
    door.joint.in_grip.rotation = rotation_exp(Vec3(0.01, 0.0, 0.0));
    door.proxy.tie(door.tool, 0.0);
    Vec3 before = door.proxy.wrench().force_n;
    double step_n = 0.0;
    for (int i = 0; i < 1000; ++i) {
        door.tick();
        step_n = std::max(step_n, glm::length(door.proxy.wrench().force_n - before));
        before = door.proxy.wrench().force_n;
    }
    CHECK(step_n < 0.03);
    CHECK(door.proxy.wrench().force_n.y == doctest::Approx(-1.0).epsilon(0.02));
    check_on_its_hinge(door);
}

TEST_CASE("joints: a door in a wall that moves is carried along, and a scene that corrects it "
          "gives no blow") {
    Door door;
    double step_n = 0.0;
    Vec3 before(0.0);
    for (int i = 0; i < 1000; ++i) {
        if (i % 16 ==
            0) { // a game frame: the wall is up to half a millimetre from where it was expected
            door.joint.base.origin_m = Vec3(-kLever_m, 1e-4 * i + (i % 32 == 0 ? 5e-4 : 0.0), 0.0);
            door.joint.velocity_m_s = Vec3(0.0, 0.1, 0.0);
            door.proxy.tie(door.tool, 0.0);
        }
        door.device.position_m.y = 1e-4 * i;
        door.tick({Vec3(0.0, 0.1, 0.0), Vec3(0.0), 0.0});
        step_n = std::max(step_n, glm::length(door.proxy.wrench().force_n - before));
        before = door.proxy.wrench().force_n;
    }
    CHECK(step_n < 0.12);
    CHECK(door.proxy.pose().position_m.y == doctest::Approx(0.1).epsilon(0.01));
}

TEST_CASE("joints: a way round gives back what it took, and with a damper it only takes") {
    for (const double damping : {0.0, 0.05}) {
        JointAxis hinge = JointAxis::free();
        hinge.stiffness = 0.6;
        hinge.damping = damping;
        Door door(hinge);
        double work_j = 0.0;
        double most_j = 0.0;
        Wrench before = door.proxy.wrench();
        constexpr int kTicks = 8000;
        for (int i = 1; i <= kTicks; ++i) {
            const double phase = 2.0 * std::numbers::pi * i / kTicks;
            ToolPose next = Door::opened(0.6 * std::sin(phase) + 0.4 * std::sin(3.0 * phase));
            next.position_m += Vec3(0.002, 0.001, 0.0) * std::sin(2.0 * phase);
            const Displacement step = between(door.device, next);
            door.device = next;
            door.tick();
            const Wrench now = door.proxy.wrench();
            work_j += 0.5 * (glm::dot(now.force_n + before.force_n, step.linear_m) +
                             glm::dot(now.moment_nm + before.moment_nm, step.angular_rad));
            most_j = std::max(most_j, std::abs(work_j));
            before = now;
        }
        CAPTURE(damping);
        // Beside the damper of 1/1000 of a time step that solving implicitly costs.
        CHECK(work_j < 0.01 * most_j);
        if (damping == 0.0) {
            CHECK(work_j > -0.03 * most_j);
        } else {
            CHECK(work_j < -0.01);
        }
    }
}

TEST_CASE(
    "joints: two tools tied to each other by springs, a game's tick late, find the same place") {
    std::array<Door, 2> hands;
    for (Door &hand : hands) {
        hand.joint = ToolJoint();
        hand.joint.id = 9;
        for (std::size_t axis = 0; axis < 6; ++axis) {
            hand.joint.axes[axis] = JointAxis::free();
            hand.joint.axes[axis].stiffness = 2.0 * hand.settings.stiffness[axis];
        }
        hand.settings.damping_s = 0.0018;
        hand.start_at(ToolPose());
    }
    // Each holds its end of a bar, 70 mm from where the two are tied.
    hands[0].joint.in_grip.origin_m = Vec3(0.0, 0.0, 0.07);
    hands[1].joint.in_grip.origin_m = Vec3(0.0, 0.0, -0.07);
    // Each is drawn down by 1 N, as by half a weight, and apart.
    for (int tick = 0; tick < 60; ++tick) {
        const std::array<ToolPose, 2> poses{hands[0].proxy.pose(), hands[1].proxy.pose()};
        for (std::size_t k = 0; k < 2; ++k) {
            const double end_m = k == 0 ? -0.07 : 0.07; // of the other hand's
            hands[k].joint.base = {poses[1 - k].position_m +
                                       poses[1 - k].rotation * Vec3(0.0, 0.0, end_m),
                                   poses[1 - k].rotation};
            hands[k].proxy.tie(hands[k].tool, 0.0);
            const double aside_m = k == 0 ? -0.075 : 0.075;
            for (int cycle = 0; cycle < 16; ++cycle) {
                hands[k].device.position_m = Vec3(0.0, -0.001, aside_m);
                hands[k].tick();
            }
        }
    }
    CHECK(std::abs(hands[0].proxy.pose().position_m.y + 0.001) < 1e-5);
    CHECK(std::abs(hands[0].proxy.wrench().force_n.y) < 0.01);
    // Three springs in a row: 1000, 2000 and 1000 N/m over 10 mm.
    CHECK(hands[0].proxy.wrench().force_n.z == doctest::Approx(4.0).epsilon(0.01));
    CHECK(hands[1].proxy.wrench().force_n.z == doctest::Approx(-4.0).epsilon(0.01));
}

TEST_CASE("joints: a scene with senseless ones is refused") {
    TouchScene touch = FloorScene().touch;
    touch.tool.joint_count = 1;
    CHECK(validate(touch) == Status::ok);
    touch.tool.joints[0].axes[2].stiffness = -1.0;
    CHECK(validate(touch) == Status::invalid_request);
    touch.tool.joints[0].axes[2].stiffness = std::nan("");
    CHECK(validate(touch) == Status::not_finite);
    touch.tool.joints[0] = ToolJoint();
    touch.tool.joint_count = 3;
    CHECK(validate(touch) == Status::invalid_request);
}
