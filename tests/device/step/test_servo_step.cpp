#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include <glm/geometric.hpp>

#include "device/step/tension_diagnosis.h"
#include "support/servo_fixture.h"

using namespace spidar;
using spidar::test::Bench;
using spidar::test::kTick_s;

TEST_CASE("step: before forces are enabled the grip is read and the motors are off") {
    Bench bench;
    REQUIRE(bench.started == Status::ok);
    CHECK(bench.now().state == DeviceState::closed);
    const GripPose pose = spidar::test::moved_by(bench.settings, Vec3(0.05, -0.03, 0.04), 0.3);
    bench.put(pose);
    bench.ask({Vec3(2.0, 0.0, 0.0), Vec3(0.0), 0.0}, 1.0);
    bench.tick(20);
    CHECK(bench.now().state == DeviceState::connected);
    CHECK(bench.motors_off());
    CHECK(bench.now().grip.status >= Status::ok);
    // Rounding to counts of 25 um is all that is lost.
    CHECK(glm::distance(bench.now().grip.pose.position_m, pose.position_m) < 5e-5);
    CHECK(std::abs(bench.now().grip.frame.grasp_angle_rad - 0.3) < 2e-3);
    CHECK(bench.now().counters.ticks == 20);
    CHECK(bench.now().counters.kinematics_skipped == 19);
}

TEST_CASE("step: arming raises pretension and wrench together over the arming time") {
    Bench bench;
    bench.command.forces_enabled = true;
    const Wrench asked{Vec3(0.0, 2.0, 0.0), Vec3(0.0), 0.0};
    bench.ask(asked, 2.0);
    bench.tick();
    CHECK(bench.now().state == DeviceState::arming);
    for (int ms = 2; ms <= 999; ++ms) {
        bench.tick();
        REQUIRE(bench.now().state == DeviceState::arming);
        REQUIRE(bench.now().force_scale == doctest::Approx(1e-3 * ms));
        REQUIRE(bench.now().requested.force_n.y == doctest::Approx(2e-3 * ms));
    }
    CHECK(bench.now().achieved.force_n.y == doctest::Approx(2.0).epsilon(0.01));
    bench.tick(2);
    CHECK(bench.now().state == DeviceState::active);
    CHECK(bench.drive.motors_on);
    for (const double tension_n : bench.now().tensions_n) {
        CHECK(tension_n >= bench.settings.tension.min_tension_n - 1e-12);
    }
}

TEST_CASE(
    "step: the achieved wrench is what is asked for, less the reported bias, in all seven DOF") {
    Bench bench;
    bench.activate();
    for (int dof = 0; dof < kDofCount; ++dof) {
        for (const double sign : {1.0, -1.0}) {
            PaperWrench q{};
            q[static_cast<std::size_t>(dof)] = sign * (dof < 3 ? 2.0 : 0.05);
            bench.ask(from_paper(q), 1.0);
            bench.tick(300);
            const PaperWrench requested = to_paper(bench.now().requested);
            const PaperWrench achieved = to_paper(bench.now().achieved);
            const PaperWrench bias = tension_report(bench.settings, bench.now()).bias();
            for (std::size_t k = 0; k < achieved.size(); ++k) {
                CAPTURE(dof);
                CAPTURE(k);
                CHECK(std::abs(requested[k] - q[k]) < 1e-12);
                // The request as newtons at the pole ends, and back to the unit of row k.
                const double d = bench.settings.grip.pole_half_length_m;
                const double size = (dof < 3 ? 2.0 : 0.05 / d) * (k < 3 ? 1.0 : d);
                CHECK(std::abs(achieved[k] - requested[k] - bias[k]) < 0.01 * size);
            }
        }
    }
}

TEST_CASE("step: a wrench is full at 49 ms, half at 75, gone at 101") {
    Bench bench;
    bench.activate();
    bench.ask({Vec3(0.0, 0.0, 2.0), Vec3(0.0), 0.0}, 0.050);
    bench.tick();
    const auto at = [&](int ms, int from) {
        bench.tick(ms - from);
        return bench.now().requested.force_n.z;
    };
    CHECK(at(49, 0) == doctest::Approx(2.0));
    CHECK(at(75, 49) == doctest::Approx(1.0));
    CHECK(at(101, 75) == 0.0);
    CHECK(bench.now().counters.expired_requests == 1);
    CHECK(bench.now().state == DeviceState::active); // pretension stays
    bench.tick(20);
    CHECK(glm::length(bench.now().achieved.force_n) < 0.01);
    CHECK(bench.now().tensions_n[0] > 0.0);
}

TEST_CASE("step: 0 to 8 N rises within the slew limit") {
    Bench bench;
    bench.activate();
    bench.ask({Vec3(8.0, 0.0, 0.0), Vec3(0.0), 0.0}, 1.0);
    StringArray last = bench.now().tensions_n;
    int rise_ms = 0;
    for (int ms = 1; ms <= 200; ++ms) {
        bench.tick();
        for (std::size_t i = 0; i < last.size(); ++i) {
            REQUIRE(std::abs(bench.now().tensions_n[i] - last[i]) <= 1.0 + 1e-12);
        }
        last = bench.now().tensions_n;
        if (rise_ms == 0 && bench.now().achieved.force_n.x > 0.9 * 8.0) {
            rise_ms = ms;
        }
    }
    CHECK(bench.now().counters.slewed_ticks > 0);
    CHECK(rise_ms >= 2); // eight strings share 8 N: each needs a few newtons
    CHECK(rise_ms <= 16);
    CHECK(bench.now().achieved.force_n.x == doctest::Approx(8.0).epsilon(0.01));
}

TEST_CASE("step: malformed requests are counted once and change nothing") {
    constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
    Bench bench;
    bench.activate();
    bench.ask({Vec3(0.0, 2.0, 0.0), Vec3(0.0), 0.0}, 0.050);
    bench.tick(10);
    bench.ask({Vec3(kNan, 0.0, 0.0), Vec3(0.0), 0.0}, 0.050);
    bench.tick(10);
    CHECK(bench.now().counters.rejected_requests == 1);
    CHECK(bench.now().requested.force_n.y ==
          doctest::Approx(2.0)); // the last good one, until it expires
    bench.tick(100);
    CHECK(glm::length(bench.now().requested.force_n) == 0.0);
    ++bench.command.contacts_sequence;
    bench.command.contact_count = 99;
    bench.tick(5);
    CHECK(bench.now().counters.rejected_requests == 2);
    CHECK(bench.now().contact_count == 0);
    bench.ask({Vec3(100.0, 0.0, 0.0), Vec3(0.0), 0.0}, 0.050);
    bench.tick();
    CHECK(bench.now().requested.force_n.x == doctest::Approx(bench.settings.safety.max_force_n));
    CHECK(bench.now().counters.clamped_requests == 1);
}

TEST_CASE("step: requests together keep the limit too") {
    Bench bench;
    bench.activate();
    bench.put(spidar::test::moved_by(bench.settings, Vec3(0.0, 0.0, 0.0)));
    ContactPlane plane;
    plane.offset_m = 0.03; // 350 N/m * 3 cm = 10.5 N
    bench.command.contacts[0] = plane;
    bench.command.contact_count = 1;
    ++bench.command.contacts_sequence;
    bench.ask({Vec3(6.0, 0.0, 0.0), Vec3(0.0), 0.0}, 1.0);
    bench.tick(10);
    const Vec3 force = bench.now().requested.force_n;
    CHECK(glm::length(force) == doctest::Approx(bench.settings.safety.max_force_n));
    CHECK(force.y / force.x == doctest::Approx(10.5 / 6.0));
    CHECK(bench.now().counters.clamped_requests >= 1);
    const double impulse = bench.now().contacts[0].impulse_ns.y;
    bench.tick(10); // the impulse is of the force given, not of the force before the limit
    CHECK(bench.now().contacts[0].impulse_ns.y - impulse ==
          doctest::Approx(10 * kTick_s * force.y));
}

TEST_CASE("step: twist from poses, filtered, falls to zero at rest") {
    Bench bench;
    const double speed_m_s = 0.2;
    const double rate_rad_s = 1.0;
    Vec3 p(-0.05, 0.0, 0.0);
    double grasp = -0.2;
    for (int i = 0; i < 300; ++i) {
        p.x += speed_m_s * kTick_s;
        grasp += rate_rad_s * kTick_s;
        bench.put(
            make_pose(bench.settings.grip, p,
                      Mat3(Vec3(std::cos(2e-3 * i), std::sin(2e-3 * i), 0.0),
                           Vec3(-std::sin(2e-3 * i), std::cos(2e-3 * i), 0.0), Vec3(0.0, 0.0, 1.0)),
                      grasp));
        bench.tick();
    }
    // 25 um counts at 1 kHz are 25 mm/s of noise before the filter.
    CHECK(bench.now().grip.twist.linear_m_s.x == doctest::Approx(speed_m_s).epsilon(0.05));
    CHECK(std::abs(bench.now().grip.twist.linear_m_s.y) < 0.02);
    CHECK(bench.now().grip.twist.angular_rad_s.z == doctest::Approx(2.0).epsilon(0.1));
    CHECK(bench.now().grip.twist.grasp_rate_rad_s == doctest::Approx(rate_rad_s).epsilon(0.3));
    bench.tick(100);
    CHECK(glm::length(bench.now().grip.twist.linear_m_s) < 1e-9);
    CHECK(std::abs(bench.now().grip.twist.grasp_rate_rad_s) < 1e-9);
}

TEST_CASE("step: bad time steps count as one period") {
    Bench bench;
    for (const double bad : {0.0, -1.0, 5e-324, 0.0500001, std::numeric_limits<double>::quiet_NaN(),
                             std::numeric_limits<double>::infinity()}) {
        const double before = bench.now().time_s;
        bench.tick(1, bad);
        CHECK(bench.now().time_s - before == doctest::Approx(kTick_s));
    }
    CHECK(bench.now().counters.bad_time_steps == 6);
}

TEST_CASE("step: bad settings are refused by kind, and the old ones stand") {
    Bench bench;
    bench.activate();
    const auto refused = [&bench](auto change) {
        ServoSettings settings = spidar::test::ideal_settings();
        change(settings);
        return bench.step.configure(settings);
    };
    constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
    CHECK(refused([&](ServoSettings &s) { s.frame.motors_m[3].x = kNan; }) ==
          Status::invalid_geometry);
    CHECK(refused([](ServoSettings &s) { s.grip.pole_half_length_m = 0.0; }) ==
          Status::invalid_geometry);
    CHECK(refused([](ServoSettings &s) { s.strings.scale_m_per_count[2] = 0.0; }) ==
          Status::invalid_calibration);
    CHECK(refused([](ServoSettings &s) { s.motors.torque_constant_nm_a[0] = 0.0; }) ==
          Status::invalid_calibration);
    CHECK(refused([](ServoSettings &s) { s.rate_hz = 0.0; }) == Status::invalid_settings);
    CHECK(refused([](ServoSettings &s) { s.tension.min_tension_n = -1.0; }) ==
          Status::invalid_settings);
    CHECK(bench.now().state == DeviceState::active);
    bench.tick();
    CHECK(bench.drive.motors_on);
}

TEST_CASE("step: a weak motor lowers the limit of the solver, so no current is cut unseen") {
    Bench bench;
    bench.settings.motors.max_current_a.fill(0.5); // 0.5 A * 0.0438 / 0.008 = 2.74 N
    bench.start();
    REQUIRE(bench.started == Status::ok);
    bench.activate();
    bench.ask({Vec3(8.0, 0.0, 0.0), Vec3(0.0), 0.0}, 1.0);
    bench.tick(100);
    const double most_n = max_tensions(bench.settings.motors)[0];
    for (std::size_t i = 0; i < kStringCount; ++i) {
        CHECK(bench.now().tensions_n[i] <= most_n + 1e-12);
        CHECK(bench.drive.currents_a[i] <= 0.5 + 1e-12);
    }
    CHECK(bench.now().tension_status == Status::wrench_limited);
    CHECK(bench.now().counters.saturated_ticks > 0);
    const StringArray per_ampere_n_a = motor_scale(bench.settings.motors).tension_per_ampere_n_a;
    for (std::size_t i = 0; i < kStringCount; ++i) {
        const double pulled_n = bench.drive.currents_a[i] * per_ampere_n_a[i];
        CHECK(pulled_n == doctest::Approx(bench.now().tensions_n[i]));
    }
}

TEST_CASE("step: what was asked before acknowledge() does not act after it") {
    Bench bench;
    bench.simulated = false;
    bench.command.forces_enabled = true;
    bench.command.arm_count = 7;
    bench.command.wrench_sequence = 3;
    bench.command.wrench = {Vec3(1.0), Vec3(0.0), 0.0};
    bench.command.wrench_duration_s = 1.0;
    bench.step.acknowledge(bench.command);
    bench.tick(50);
    CHECK(bench.now().state == DeviceState::connected);
    ++bench.command.arm_count;
    bench.tick(50);
    CHECK(bench.now().state == DeviceState::arming);
    CHECK(glm::length(bench.now().requested.force_n) == 0.0);
}

TEST_CASE("step: limits change while forces are on; limits that make no sense do not") {
    Bench bench;
    bench.put(rest_pose(bench.settings.grip));
    bench.activate();
    bench.ask({Vec3(0.0, 6.0, 0.0), Vec3(0.0), 0.0}, 10.0);
    bench.tick(100);
    CHECK(bench.now().requested.force_n.y == doctest::Approx(6.0));
    const LiveLimits lower{2.0, 0.4, 0.4, 500.0, 1.0, 0.25};
    bench.command.limits = lower;
    bench.tick(10);
    CHECK(bench.now().requested.force_n.y == doctest::Approx(6.0)); // not without its number
    ++bench.command.limits_sequence;
    bench.tick(100);
    CHECK(bench.now().requested.force_n.y == doctest::Approx(2.0));
    CHECK(bench.now().state == DeviceState::active);
    const std::uint64_t refused = bench.now().counters.rejected_requests;
    for (double *const field :
         {&bench.command.limits.max_force_n, &bench.command.limits.max_moment_nm,
          &bench.command.limits.max_stiffness_n_m}) {
        for (const double bad : {-1.0, std::numeric_limits<double>::quiet_NaN(),
                                 std::numeric_limits<double>::infinity()}) {
            bench.command.limits = lower;
            *field = bad;
            ++bench.command.limits_sequence;
            bench.tick(2);
        }
    }
    CHECK(bench.now().counters.rejected_requests == refused + 9);
    CHECK(bench.now().requested.force_n.y == doctest::Approx(2.0));

    // Caps of gains hold for what is asked from now on.
    bench.command.limits = lower;
    ++bench.command.limits_sequence;
    bench.command.contact_count = 1;
    bench.command.contacts[0].stiffness_n_m = 900.0;
    ++bench.command.contacts_sequence;
    bench.tick(1);
    CHECK(bench.now().clamp.given == doctest::Approx(500.0));
}
