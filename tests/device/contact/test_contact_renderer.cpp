#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <random>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/matrix.hpp>

#include "core/geometry/rotation_log.h"
#include "device/contact/contact_renderer.h"
#include "device/rendering/motion_filter.h"

using namespace spidar;

namespace {

constexpr double kTick_s = 0.001;
constexpr ContactTarget kEnds[] = {ContactTarget::pole1_plus, ContactTarget::pole1_minus,
                                   ContactTarget::pole2_plus, ContactTarget::pole2_minus};

GripState grip_at(const Vec3 &position_m, double grasp_angle_rad = 0.0) {
    GripState grip;
    grip.pose = make_pose(GripGeometry(), position_m, Mat3(1.0), grasp_angle_rad);
    grip.frame = frame_of(grip.pose, Mat3(1.0));
    return grip;
}

ContactPlane floor_plane(ContactTarget target = ContactTarget::centre, std::int32_t id = 1) {
    ContactPlane plane;
    plane.normal = Vec3(0.0, 0.0, 1.0);
    plane.target = target;
    plane.id = id;
    return plane;
}

ContactPlane stop_at(double angle_rad) {
    ContactPlane stop;
    stop.target = ContactTarget::grasp_stop;
    stop.normal = Vec3(-1.0, 0.0, 0.0);
    stop.offset_m = -angle_rad;
    stop.stiffness_n_m = 0.25;
    stop.damping_n_s_m = 0.001;
    return stop;
}

// Seen as it is: nothing filtered, nothing ahead.
GripMotion motion_of(const GripState &grip) {
    return {grip, Displacement(), grip.twist};
}

ContactPlane turn_stop(const Vec3 &axis, double angle_rad) {
    ContactPlane stop;
    stop.target = ContactTarget::turn_stop;
    stop.normal = axis;
    stop.offset_m = angle_rad;
    stop.stiffness_n_m = 0.5;
    stop.damping_n_s_m = 0.001;
    return stop;
}

struct Rig {
    ContactRenderer renderer;
    HapticCommand command;

    Rig() { renderer.configure(ServoSettings()); }
    void give(std::initializer_list<ContactPlane> planes) {
        command.contact_count = 0;
        for (const ContactPlane &plane : planes) {
            command.contacts[static_cast<std::size_t>(command.contact_count++)] = plane;
        }
        renderer.accept(command, 0.0);
    }
    Wrench tick(const GripState &grip, double scale = 1.0) {
        renderer.age(kTick_s);
        const Wrench wrench = renderer.render(motion_of(grip), kTick_s);
        renderer.integrate(scale, kTick_s);
        return wrench;
    }
    ContactReport report(int index = 0) {
        std::array<ContactReport, kMaxContacts> reports{};
        renderer.report(reports);
        return reports[static_cast<std::size_t>(index)];
    }
};

} // namespace

TEST_CASE("contact: force = stiffness x depth, along the normal; nothing outside") {
    Rig rig;
    rig.give({floor_plane()});
    const Wrench inside = rig.tick(grip_at(Vec3(0.0, 0.0, -0.004)));
    CHECK(glm::distance(inside.force_n, Vec3(0.0, 0.0, 350.0 * 0.004)) < 1e-9);
    CHECK(glm::length(inside.moment_nm) < 1e-15);
    CHECK(inside.grasp_torque_nm == 0.0);
    CHECK(rig.report().touching);
    const Wrench outside = rig.tick(grip_at(Vec3(0.0, 0.0, 1e-9)));
    CHECK(glm::length(outside.force_n) == 0.0);
    CHECK_FALSE(rig.report().touching);
}

TEST_CASE("contact: damping resists but never pulls") {
    Rig rig;
    rig.give({floor_plane()});
    for (const double speed : {-2.0, -0.3, 0.3, 0.699, 0.7, 5.0}) {
        GripState grip = grip_at(Vec3(0.0, 0.0, -0.004));
        grip.twist.linear_m_s.z = speed;
        const double known = std::max(0.0, 350.0 * 0.004 - 2.0 * speed);
        CAPTURE(speed);
        CHECK(rig.tick(grip).force_n.z == doctest::Approx(known));
    }
}

TEST_CASE("contact: one, two, four or eight coplanar contacts feel the same") {
    const Vec3 p(0.0, 0.0, -0.004);
    GripState moving = grip_at(p);
    moving.twist.linear_m_s.z = -0.1;
    const double still_n = 350.0 * 0.004;
    const double moving_n = still_n + 2.0 * 0.1; // damping is shared as well
    for (const int count : {1, 2, 4, 8}) {
        Rig same;   // all at one point
        Rig spread; // at opposite pole ends
        for (int i = 0; i < count; ++i) {
            const auto k = static_cast<std::size_t>(i);
            same.command.contacts[k] = floor_plane(ContactTarget::centre, i);
            spread.command.contacts[k] =
                floor_plane(count == 1 ? ContactTarget::centre : kEnds[i % 4], i);
        }
        for (Rig *rig : {&same, &spread}) {
            rig->command.contact_count = count;
            rig->renderer.accept(rig->command, 0.0);
            CAPTURE(count);
            CHECK(rig->tick(grip_at(p)).force_n.z == doctest::Approx(still_n));
            CHECK(rig->tick(moving).force_n.z == doctest::Approx(moving_n));
        }
    }
}

TEST_CASE("contact: one at a pole's end turns the grip, and gives way by that") {
    Rig rig;
    rig.give({floor_plane(ContactTarget::pole2_plus)});
    const double r = kPaperPoleHalfLength_m;
    const double k = 1.0 / (1.0 / 350.0 + r * r / kGodObjectTurnStiffness_nm_rad);
    const Wrench wrench = rig.tick(grip_at(Vec3(0.0, 0.0, -0.004)));
    CHECK(wrench.force_n.z == doctest::Approx(k * 0.004));
    CHECK(wrench.moment_nm.y == doctest::Approx(-r * k * 0.004)); // r2 = +x, force +z
}

TEST_CASE("contact: in a wedge the force leads to the nearest allowed point") {
    for (const double degrees : {5.0, 30.0, 60.0, 90.0, 120.0}) {
        Rig rig;
        const double a = degrees * kDegree_rad;
        ContactPlane left = floor_plane(ContactTarget::centre, 1);
        ContactPlane right = floor_plane(ContactTarget::centre, 2);
        right.normal = Vec3(std::sin(a), 0.0, std::cos(a));
        rig.give({left, right});
        // Both planes pass through the origin; below both, the nearest allowed point is the edge or on a plane.
        for (const Vec3 &p : {Vec3(-0.002, 0.0, -0.004), Vec3(-0.004, 0.0, -0.001),
                              Vec3(0.003, 0.0, -0.004), Vec3(-0.0001, 0.0, -0.003)}) {
            Vec3 nearest(0.0);
            double least_m = 1.0;
            const Vec3 candidates[] = {Vec3(0.0, p.y, 0.0),
                                       p - glm::dot(left.normal, p) * left.normal,
                                       p - glm::dot(right.normal, p) * right.normal};
            for (const Vec3 &q : candidates) {
                const bool allowed =
                    glm::dot(left.normal, q) > -1e-12 && glm::dot(right.normal, q) > -1e-12;
                if (allowed && glm::distance(p, q) < least_m) {
                    least_m = glm::distance(p, q);
                    nearest = q;
                }
            }
            CAPTURE(degrees);
            CHECK(glm::distance(rig.tick(grip_at(p)).force_n, 350.0 * (nearest - p)) < 1e-6);
        }
    }
}

TEST_CASE("contact: both sides of a slot that is too narrow push by depth, not without bound") {
    Rig rig;
    ContactPlane floor = floor_plane();
    ContactPlane ceiling = floor_plane(ContactTarget::centre, 2);
    ceiling.normal = -ceiling.normal;
    for (ContactPlane *plane : {&floor, &ceiling}) {
        plane->offset_m = 0.002; // 2 mm beyond the middle
        plane->damping_n_s_m = 0.0;
    }
    rig.give({floor, ceiling});
    const double stiffness_n_m = floor.stiffness_n_m;
    for (const double off_m : {0.0, 0.0005, -0.0015}) {
        const Wrench wrench = rig.tick(grip_at(Vec3(0.0, 0.0, off_m)));
        CAPTURE(off_m);
        CHECK(wrench.force_n.z * off_m <= 0.0); // back to the middle
        CHECK(std::abs(wrench.force_n.z) <= 4.0 * stiffness_n_m * std::abs(off_m) + 1e-6);
    }
    for (const int side : {0, 1}) {
        const double impulse_ns = glm::length(rig.report(side).impulse_ns);
        CHECK(impulse_ns > 0.0);
        CHECK(impulse_ns <= 3.0 * kTick_s * 3.0 * stiffness_n_m * 0.0035);
    }
}

TEST_CASE("contact: a closed path in contact gains no energy from several planes") {
    Rig rig;
    rig.give({floor_plane(ContactTarget::pole1_plus, 1), floor_plane(ContactTarget::pole2_plus, 2),
              floor_plane(ContactTarget::centre, 3)});
    const auto pose_at = [](double t) {
        const Mat3 turn(std::cos(0.05 * std::sin(t)), 0.0, -std::sin(0.05 * std::sin(t)), 0.0, 1.0,
                        0.0, std::sin(0.05 * std::sin(t)), 0.0, std::cos(0.05 * std::sin(t)));
        GripState grip;
        grip.pose = make_pose(GripGeometry(), Vec3(0.0, 0.0, -0.002 + 0.002 * std::cos(t)), turn,
                              0.1 * std::sin(2.0 * t));
        grip.frame = frame_of(grip.pose, turn);
        return grip;
    };
    constexpr int kSteps = 20000;
    double work_j = 0.0;
    double passed_j = 0.0;
    for (int i = 0; i < kSteps; ++i) {
        const double t0 = 2.0 * 3.14159265358979 * i / kSteps;
        const double t1 = 2.0 * 3.14159265358979 * (i + 1) / kSteps;
        const GripState a = pose_at(t0);
        const GripState b = pose_at(t1);
        Rig still;
        still.give({floor_plane(ContactTarget::pole1_plus, 1),
                    floor_plane(ContactTarget::pole2_plus, 2),
                    floor_plane(ContactTarget::centre, 3)});
        const Wrench w = still.tick(pose_at(0.5 * (t0 + t1)));
        const double step_j =
            glm::dot(w.force_n, b.pose.position_m - a.pose.position_m) +
            glm::dot(w.moment_nm,
                     rotation_log(b.frame.rotation * glm::transpose(a.frame.rotation))) +
            w.grasp_torque_nm * (b.frame.grasp_angle_rad - a.frame.grasp_angle_rad);
        work_j += step_j;
        passed_j += std::abs(step_j);
    }
    CHECK(passed_j > 1e-3); // the path is felt
    CHECK(std::abs(work_j) < 1e-3 * passed_j);
}

TEST_CASE("turn stop: keeps the turn about its axis, wherever the others are") {
    Rig rig;
    const double angle = 0.3;
    for (int axis = 0; axis < 3; ++axis) {
        Vec3 unit(0.0);
        unit[axis] = 1.0;
        rig.give({turn_stop(-unit, -0.2)}); // turns up to 0.2 rad are free
        GripState grip;
        const Mat3 turn(glm::mat3_cast(glm::angleAxis(angle, unit)));
        grip.pose = make_pose(GripGeometry(), Vec3(0.01, 0.0, 0.02), turn, 0.1);
        grip.frame = frame_of(grip.pose, turn);
        const Wrench wrench = rig.tick(grip);
        CHECK(glm::distance(wrench.moment_nm, -0.5 * 0.1 * unit) < 1e-9);
        CHECK(glm::length(wrench.force_n) == 0.0);
        CHECK(wrench.grasp_torque_nm == 0.0);
        grip.twist.angular_rad_s = 2.0 * unit;
        CHECK(rig.tick(grip).moment_nm[axis] == doctest::Approx(-0.5 * 0.1 - 0.001 * 2.0));
        grip.twist.angular_rad_s = -1000.0 * unit;
        CHECK(rig.tick(grip).moment_nm[axis] == 0.0);
        CHECK(rig.tick(grip_at(Vec3(0.0))).moment_nm[axis] == 0.0);
    }
}

TEST_CASE("contact: the push acts on where the grip will be, surface and all") {
    ContactRenderer renderer;
    renderer.configure(ServoSettings());
    HapticCommand command;
    command.contact_count = 1;
    command.contacts[0] = floor_plane();
    command.contacts[0].damping_n_s_m = 0.0;
    command.contacts[0].velocity_m_s = Vec3(0.0, 0.0, 0.2);
    renderer.accept(command, 0.0);
    GripMotion motion = motion_of(grip_at(Vec3(0.0, 0.0, -0.004)));
    motion.ahead.linear_m.z = -0.001;
    motion.lead_s = 0.003;
    CHECK(renderer.render(motion, kTick_s).force_n.z ==
          doctest::Approx(350.0 * (0.004 + 0.001 + 0.003 * 0.2)));
}

TEST_CASE("contact: a second coplanar contact comes in without a jump") {
    Rig rig;
    ContactPlane late = floor_plane(ContactTarget::pole2_plus, 2);
    late.offset_m = -0.004 - 2e-3;
    rig.give({floor_plane(ContactTarget::pole1_plus, 1), late});
    double last_n = rig.tick(grip_at(Vec3(0.0, 0.0, -0.004))).force_n.z;
    for (int i = 0; i <= 400; ++i) { // the second plane rises through its pole end
        late.offset_m = -0.004 + 1e-5 * i - 2e-3;
        Rig fresh;
        fresh.give({floor_plane(ContactTarget::pole1_plus, 1), late});
        const double force_n = fresh.tick(grip_at(Vec3(0.0, 0.0, -0.004))).force_n.z;
        REQUIRE(std::abs(force_n - last_n) < 2.0 * 350.0 * 1e-5);
        last_n = force_n;
    }
}

TEST_CASE("contact: friction holds inside the cone, slips on it, never drives") {
    Rig rig;
    ContactPlane plane = floor_plane();
    plane.friction = 0.5;
    plane.damping_n_s_m = 0.0;
    rig.give({plane});
    const double normal_n = 350.0 * 0.004;
    rig.tick(grip_at(Vec3(0.0, 0.0, -0.004)));
    // Sticks: the spring pulls back towards where it touched.
    const Wrench stuck = rig.tick(grip_at(Vec3(0.001, 0.0, -0.004)));
    CHECK(stuck.force_n.x == doctest::Approx(-350.0 * 0.001));
    CHECK(stuck.force_n.z == doctest::Approx(normal_n));
    // Slips: exactly the cone.
    double work_j = 0.0;
    Vec3 last(0.001, 0.0, -0.004);
    for (int i = 1; i <= 60; ++i) {
        rig.give({plane});
        const double angle = 0.1 * i;
        const Vec3 p(0.02 * std::cos(angle), 0.02 * std::sin(angle), -0.004);
        const Vec3 force = rig.tick(grip_at(p)).force_n;
        CHECK(std::hypot(force.x, force.y) <= 0.5 * normal_n * (1.0 + 1e-12));
        if (i > 2) {
            CHECK(std::hypot(force.x, force.y) == doctest::Approx(0.5 * normal_n));
        }
        work_j += glm::dot(force, p - last);
        last = p;
    }
    CHECK(work_j < 0.0); // on the hand: friction takes, never gives
    // A new touch starts without stretch.
    rig.tick(grip_at(Vec3(0.0, 0.0, 0.01)));
    CHECK(rig.tick(grip_at(Vec3(0.03, 0.0, -0.004))).force_n.x == 0.0);
}

TEST_CASE("contact: friction holds to a moving surface") {
    Rig rig;
    ContactPlane plane = floor_plane();
    plane.friction = 1.0;
    plane.damping_n_s_m = 0.0;
    plane.velocity_m_s = Vec3(0.1, 0.0, 0.0);
    rig.give({plane});
    rig.tick(grip_at(Vec3(0.0, 0.0, -0.004)));
    Wrench wrench;
    for (int i = 0; i < 10; ++i) {
        wrench = rig.tick(grip_at(Vec3(0.0, 0.0, -0.004)));
    }
    CHECK(wrench.force_n.x == doctest::Approx(350.0 * 0.1 * 0.010)); // carried along with it
}

TEST_CASE("contact: planes move on by their velocity for 30 ms, then stand") {
    Rig rig;
    ContactPlane plane = floor_plane();
    plane.damping_n_s_m = 0.0;
    plane.velocity_m_s = Vec3(0.0, 0.0, 0.2);
    rig.give({plane});
    for (int ms = 1; ms <= 60; ++ms) {
        const double force_n = rig.tick(grip_at(Vec3(0.0, 0.0, -0.001))).force_n.z;
        CHECK(force_n == doctest::Approx(350.0 * (0.001 + 0.2e-3 * std::min(ms, 30))));
    }
}

TEST_CASE("contact: a plane that says when it was computed is moved on from then") {
    Rig rig;
    ContactPlane plane = floor_plane();
    plane.damping_n_s_m = 0.0;
    plane.velocity_m_s = Vec3(0.0, 0.0, 0.2);
    rig.command.contacts[0] = plane;
    rig.command.contact_count = 1;
    rig.command.contacts_state_time_s = 7.0;
    rig.renderer.accept(rig.command, 7.008); // 8 ms old
    const double force_n = rig.tick(grip_at(Vec3(0.0, 0.0, -0.001))).force_n.z;
    CHECK(force_n == doctest::Approx(350.0 * (0.001 + 0.2 * 0.009)));
}

TEST_CASE("contact: full to 100 ms, half at 200 ms, gone at 300 ms, and back gradually") {
    Rig rig;
    rig.give({floor_plane()});
    const GripState grip = grip_at(Vec3(0.0, 0.0, -0.004));
    const double full_n = 350.0 * 0.004;
    for (int ms = 1; ms <= 310; ++ms) {
        const double force_n = rig.tick(grip).force_n.z;
        const double left = ms <= 100 ? 1.0 : ms >= 300 ? 0.0 : (300 - ms) / 200.0;
        CAPTURE(ms);
        CHECK(std::abs(force_n - full_n * left) < 1e-9);
    }
    rig.give({floor_plane()});
    double last_n = 0.0;
    for (int ms = 1; ms <= 60; ++ms) {
        const double force_n = rig.tick(grip).force_n.z;
        CHECK(force_n - last_n <= full_n / 50.0 + 1e-9);
        last_n = force_n;
    }
    CHECK(last_n == doctest::Approx(full_n));
}

TEST_CASE("contact: a plane that persists cross-fades over one game period, a new one does not") {
    Rig rig;
    const GripState grip = grip_at(Vec3(0.0, 0.0, -0.004));
    rig.give({floor_plane()});
    rig.tick(grip);
    ContactPlane raised = floor_plane();
    raised.offset_m = 0.004;
    rig.give({raised});
    for (int ms = 1; ms <= 20; ++ms) {
        const double part = std::min(1.0, ms / 16.0);
        CHECK(rig.tick(grip).force_n.z == doctest::Approx(350.0 * (0.004 + 0.004 * part)));
    }
    raised.id = 2;
    rig.give({raised});
    CHECK(rig.tick(grip).force_n.z == doctest::Approx(350.0 * 0.008));
}

TEST_CASE("contact: a plane that moves as announced is not dragged back by its updates") {
    Rig rig;
    ContactPlane plane = floor_plane();
    plane.damping_n_s_m = 0.0;
    plane.velocity_m_s = Vec3(0.0, 0.0, 0.1);
    const GripState grip = grip_at(Vec3(0.0, 0.0, -0.01));
    for (int ms = 0; ms < 160; ++ms) {
        if (ms % 16 == 0) {
            plane.offset_m = 0.1e-3 * ms;
            rig.renderer.age(kTick_s);
            rig.give({plane});
        } else {
            rig.renderer.age(kTick_s);
        }
        const double depth = rig.renderer.render(motion_of(grip), kTick_s).force_n.z / 350.0;
        CHECK(std::abs(depth - (0.01 + 0.1e-3 * ms)) < 1e-9);
    }
}

TEST_CASE("contact: impulse = integral of the force given, kept as long as the id lives") {
    Rig rig;
    rig.give({floor_plane()});
    const GripState grip = grip_at(Vec3(0.0, 0.0, -0.004));
    for (int i = 0; i < 10; ++i) {
        rig.tick(grip, 0.5);
    }
    rig.give({floor_plane(ContactTarget::centre, 9), floor_plane()});
    CHECK(rig.report(1).impulse_ns.z == doctest::Approx(10 * 0.001 * 0.5 * 350.0 * 0.004));
    CHECK(rig.report(0).impulse_ns.z == 0.0);
    rig.give({floor_plane(ContactTarget::centre, 9)});
    rig.give({floor_plane()});
    CHECK(rig.report(0).impulse_ns.z == 0.0); // a new life of the id
}

TEST_CASE("grasp stop: opens a grip that is closed past the width, leaves others alone") {
    Rig rig;
    rig.give({stop_at(0.4)});
    CHECK(rig.tick(grip_at(Vec3(0.0), 0.5)).grasp_torque_nm == doctest::Approx(-0.25 * 0.1));
    CHECK(glm::length(rig.tick(grip_at(Vec3(0.0), 0.5)).force_n) == 0.0);
    CHECK(rig.tick(grip_at(Vec3(0.0), 0.3)).grasp_torque_nm == 0.0);
    GripState closing = grip_at(Vec3(0.0), 0.5);
    closing.twist.grasp_rate_rad_s = 2.0;
    CHECK(rig.tick(closing).grasp_torque_nm == doctest::Approx(-0.25 * 0.1 - 0.001 * 2.0));
    closing.twist.grasp_rate_rad_s = -1000.0;
    CHECK(rig.tick(closing).grasp_torque_nm == 0.0); // never pulls closed
    ContactPlane other_side = stop_at(0.4);
    other_side.normal.x = 1.0;
    other_side.offset_m = 0.4; // keeps grasp_angle >= 0.4
    rig.give({other_side});
    CHECK(rig.tick(grip_at(Vec3(0.0), 0.3)).grasp_torque_nm == doctest::Approx(0.25 * 0.1));
    rig.give({stop_at(0.4)});
    CHECK(rig.tick(grip_at(Vec3(0.0), 0.5)).grasp_torque_nm == doctest::Approx(-0.25 * 0.1));
    const double before = rig.report().grasp_impulse_nms;
    rig.tick(grip_at(Vec3(0.0), 0.5), 0.5);
    CHECK(rig.report().grasp_impulse_nms - before == doctest::Approx(-0.5 * 0.001 * 0.25 * 0.1));
}

TEST_CASE("contact: caps of stiffness and damping, reported") {
    Rig rig;
    ContactPlane plane = floor_plane();
    plane.stiffness_n_m = 1e6;
    plane.damping_n_s_m = 1e6;
    rig.command.contacts[0] = plane;
    rig.command.contact_count = 1;
    const GainCaps caps = gain_caps(RenderSettings(), ServoSettings().rate_hz);
    const GainClamp clamp = rig.renderer.accept(rig.command, 0.0);
    CHECK(clamp.gain == GainClamp::Gain::stiffness);
    CHECK(clamp.asked == 1e6);
    CHECK(clamp.given == caps.stiffness_n_m);
    CHECK(clamp.from_latency);
    GripState grip = grip_at(Vec3(0.0, 0.0, -0.004));
    grip.twist.linear_m_s.z = -0.1;
    CHECK(rig.tick(grip).force_n.z ==
          doctest::Approx(caps.stiffness_n_m * 0.004 + caps.damping_n_s_m * 0.1));
    ContactPlane stop = stop_at(0.0);
    stop.stiffness_n_m = 100.0;
    rig.command.contacts[0] = stop;
    CHECK(rig.renderer.accept(rig.command, 0.0).gain == GainClamp::Gain::grasp_stiffness);
    CHECK(rig.tick(grip_at(Vec3(0.0), 0.1)).grasp_torque_nm ==
          doctest::Approx(-caps.grasp_stiffness_nm_rad * 0.1));
    rig.command.contacts[0] = floor_plane();
    CHECK(rig.renderer.accept(rig.command, 0.0).gain == GainClamp::Gain::none);
}

TEST_CASE("contact: every valid set, however absurd, gives a finite wrench that never pulls") {
    std::mt19937_64 random(3);
    const double sizes[] = {0.0, 1e-320, 1e-3, 0.01, 1.0, 1e6, 1e300, 1.7e308};
    const auto odd = [&] {
        const double size = sizes[random() % 8];
        return random() % 2 == 0 ? size : -size;
    };
    Rig rig;
    for (int round = 0; round < 20000; ++round) {
        for (int i = 0; i < kMaxContacts; ++i) {
            ContactPlane plane;
            plane.target = static_cast<ContactTarget>(random() % 7);
            plane.normal = Vec3(0.0);
            const auto axis =
                static_cast<int>(plane.target == ContactTarget::grasp_stop ? 0 : random() % 3);
            plane.normal[axis] = random() % 2 == 0 ? 1.0 : -1.0;
            plane.offset_m = odd();
            plane.velocity_m_s = Vec3(odd(), odd(), odd());
            plane.stiffness_n_m = std::abs(odd());
            plane.damping_n_s_m = std::abs(odd());
            plane.friction = std::abs(odd());
            plane.id = static_cast<std::int32_t>(random() % 4);
            REQUIRE(validate_contact(plane) == Status::ok);
            rig.command.contacts[static_cast<std::size_t>(i)] = plane;
        }
        rig.command.contact_count = static_cast<int>(random() % (kMaxContacts + 1));
        if (random() % 3 == 0) {
            rig.renderer.accept(rig.command, 0.0);
        }
        GripState grip = grip_at(Vec3(0.01, -0.02, 0.03), 0.1);
        grip.twist.linear_m_s = Vec3(0.5, -0.5, 1.0);
        const Wrench wrench = rig.tick(grip);
        for (const double value : to_paper(wrench)) {
            REQUIRE(std::isfinite(value));
        }
    }
}

TEST_CASE("contacts: a wall and a hand that move together feel like both at rest") {
    MotionFilter filter;
    filter.configure(RenderSettings(), 1.0 / kTick_s);
    constexpr double kSpeed_m_s = 0.2;
    constexpr double kDepth_m = 0.005;
    Rig rig;
    rig.command.contacts_state_time_s = 0.0;
    ContactPlane wall = floor_plane();
    wall.velocity_m_s.z = kSpeed_m_s;
    rig.give({wall});
    Displacement moved;
    moved.linear_m.z = kSpeed_m_s * kTick_s;
    double force_n = 0.0;
    for (int i = 1; i <= 28; ++i) { // as long as a plane is carried on
        rig.renderer.age(kTick_s);
        for (int settle = i == 1 ? 200 : 1; settle > 0; --settle) {
            filter.update(moved, kTick_s);
        }
        GripMotion motion;
        motion.grip = grip_at(Vec3(0.0, 0.0, kSpeed_m_s * kTick_s * i - kDepth_m));
        motion.ahead = filter.ahead();
        motion.velocity = filter.velocity();
        motion.lead_s = filter.steady_lead_s();
        force_n = rig.renderer.render(motion, kTick_s).force_n.z;
        CHECK(force_n == doctest::Approx(wall.stiffness_n_m * kDepth_m).epsilon(1e-6));
    }
}
