// The parts that watch the grip, each against a known answer.
#include <doctest/doctest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <set>
#include <string>
#include <thread>

#include <glm/geometric.hpp>

#include "device/safety/monitors/bounce_monitor.h"
#include "device/safety/safety_monitor.h"
#include "device/safety/zero_check.h"
#include "device/tracking/report_order.h"
#include "support/servo_fixture.h"

using namespace spidar;
using spidar::test::ideal_settings;
using spidar::test::kTick_s;

namespace {

constexpr double kPi = 3.14159265358979323846;

Twist along_x(double speed_m_s) {
    Twist twist;
    twist.linear_m_s.x = speed_m_s;
    return twist;
}

} // namespace

TEST_CASE(
    "heat: at a constant tension it approaches its square, with the winding's time constant") {
    SafetySettings safety;
    ThermalBudget heat;
    heat.configure(safety);
    StringArray tensions_n{};
    tensions_n[5] = 7.0; // twice the continuous tension: four budgets in the end
    double time_s = 0.0;
    while (heat.scale() >= 1.0) {
        heat.spend(tensions_n, kTick_s);
        time_s += kTick_s;
    }
    // 4 (1 - exp(-t / tau)) = 0.7
    CHECK(time_s ==
          doctest::Approx(-safety.thermal_time_s * std::log(1.0 - 0.7 / 4.0)).epsilon(0.01));
    CHECK(heat.warmest_string() == 5);
    while (heat.spent() < 0.85) {
        heat.spend(tensions_n, kTick_s);
    }
    CHECK(heat.scale() == doctest::Approx(0.5).epsilon(0.01));
    const double spent = heat.spent();
    for (int i = 0; i < 12000; ++i) {
        heat.spend({}, kTick_s);
    }
    CHECK(heat.spent() ==
          doctest::Approx(spent * std::exp(-1.0)).epsilon(0.01)); // cools as it warmed
    tensions_n.fill(std::numeric_limits<double>::quiet_NaN());
    heat.spend(tensions_n, kTick_s);
    CHECK(std::isfinite(heat.spent()));
}

TEST_CASE("shake: a swing of 30 Hz is halved, halved again, and called unstable; a hand's motion "
          "is not") {
    const auto swing = [](ShakeMonitor &monitor, double hz, double amplitude_m_s, double time_s) {
        for (int i = 0; i < static_cast<int>(time_s / kTick_s); ++i) {
            monitor.update(along_x(amplitude_m_s * std::sin(2.0 * kPi * hz * i * kTick_s)),
                           Wrench(), true, kTick_s);
        }
    };
    ShakeMonitor shaking;
    swing(shaking, 30.0, 0.2, 0.25);
    CHECK(shaking.scale() == 0.5);
    CHECK_FALSE(shaking.unstable());
    CHECK(shaking.swing_m_s() == doctest::Approx(0.2).epsilon(0.2));
    swing(shaking, 30.0, 0.2, 0.4);
    CHECK(shaking.scale() == 0.25);
    CHECK(shaking.unstable());
    for (int i = 0; i < 3500; ++i) { // calm: back within kCalm_s and one second
        shaking.update(Twist(), Wrench(), true, kTick_s);
    }
    CHECK(shaking.scale() == 1.0);
    CHECK_FALSE(shaking.unstable());

    ShakeMonitor hand;
    swing(hand, 5.0, 0.6, 5.0);   // fast waving, 19 mm to and fro
    swing(hand, 60.0, 0.04, 5.0); // a tremor of the rendering within what is allowed
    CHECK(hand.scale() == 1.0);

    ShakeMonitor tap; // a tap of 0.5 m/s rings out within a period and a half
    for (int i = 0; i < 3000; ++i) {
        const double t = (i % 500) * kTick_s;
        tap.update(along_x(0.5 * std::exp(-t / 0.02) * std::cos(2.0 * kPi * 20.0 * t)), Wrench(),
                   true, kTick_s);
    }
    CHECK(tap.scale() == 1.0);

    ShakeMonitor unforced; // without forces it is the hand's own doing
    for (int i = 0; i < 1000; ++i) {
        unforced.update(along_x(0.3 * std::sin(2.0 * kPi * 30.0 * i * kTick_s)), Wrench(), false,
                        kTick_s);
    }
    CHECK(unforced.scale() == 1.0);
}

TEST_CASE(
    "shake: a push that swings by 2 N is found where the grip hardly moves; a hand's push is not") {
    const auto push = [](double hz, double swing_n) { // on 4 N, for two seconds
        ShakeMonitor monitor;
        for (int i = 0; i < 2000; ++i) {
            const double angle = 2.0 * kPi * hz * i * kTick_s;
            monitor.update(
                along_x(0.05 * std::cos(angle)),
                {Vec3(std::max(0.0, 4.0 + swing_n * std::sin(angle)), 0.0, 0.0), Vec3(0.0), 0.0},
                true, kTick_s);
        }
        return monitor.scale();
    };
    CHECK(push(10.0, 3.5) < 1.0);
    CHECK(push(25.0, 8.0) < 1.0); // bounces: pushes and none
    CHECK(push(10.0, 1.5) == 1.0);
    CHECK(push(4.0, 8.0) == 1.0); // pressed and left by hand
}

TEST_CASE("speed: three milliseconds above the first limit fade, one sample above the second is "
          "too fast") {
    SpeedGuard guard;
    guard.configure(SafetySettings());
    guard.update(1.3, Twist(), kTick_s);
    guard.update(1.3, Twist(), kTick_s);
    CHECK_FALSE(guard.fast(kTick_s));
    guard.update(1.3, Twist(), kTick_s);
    CHECK(guard.fast(kTick_s));
    CHECK_FALSE(guard.too_fast());
    guard.update(1.1, Twist(), kTick_s);
    CHECK_FALSE(guard.fast(kTick_s));
    guard.update(2.1, Twist(), kTick_s);
    CHECK(guard.too_fast());
    Twist turning;
    turning.angular_rad_s.y = 31.0;
    guard.update(0.0, turning, kTick_s);
    CHECK(guard.too_fast());
    guard.update(std::numeric_limits<double>::quiet_NaN(), Twist(), kTick_s);
    CHECK(guard.too_fast());
}

TEST_CASE(
    "report order: gaps counted, repeated and late reports refused, wrap and restart survived") {
    ReportOrder order;
    CHECK(order.accept(65534));
    CHECK(order.accept(65535));
    CHECK(order.accept(0)); // wraps
    CHECK(order.missed() == 0);
    CHECK(order.accept(4));
    CHECK(order.missed() == 3);
    CHECK_FALSE(order.accept(4));
    CHECK_FALSE(order.accept(2));
    CHECK(order.accept(5));
    int refused = 0;
    while (!order.accept(static_cast<std::uint16_t>(1 + refused))) { // a device that counts anew
        ++refused;
        REQUIRE(refused < 100);
    }
    CHECK(refused <= ReportOrder::kAnew);
    ReportOrder unnumbered;
    for (int i = 0; i < 50; ++i) {
        CHECK(unnumbered.accept(0));
    }
}

TEST_CASE("hand presence: a grip that never moves has none, one that moved lately has, and then it "
          "lapses") {
    SafetySettings safety;
    HandPresence hand;
    hand.configure(safety);
    const GripGeometry grip;
    GripPose pose = rest_pose(grip);
    for (int i = 0; i < 100; ++i) {
        hand.update(pose, kTick_s);
    }
    CHECK_FALSE(hand.present());
    pose.position_m.x += 0.0006;
    hand.update(pose, kTick_s);
    CHECK(hand.present());
    for (int i = 0; i < 4990; ++i) {
        hand.update(pose, kTick_s);
    }
    CHECK(hand.present());
    for (int i = 0; i < 20; ++i) {
        hand.update(pose, kTick_s);
    }
    CHECK_FALSE(hand.present());
    safety.hand_presence_s = 0.0; // not asked for
    hand.configure(safety);
    CHECK(hand.present());
}

TEST_CASE(
    "zero check: confirmed after enough agreeing motion, refused after 20 ms of disagreement") {
    GripPose pose;
    ZeroCheck check;
    check.begin();
    double travelled_m = 0.0;
    ZeroCheck::Verdict verdict = ZeroCheck::Verdict::pending;
    for (int i = 0; i < 2000 && verdict == ZeroCheck::Verdict::pending; ++i) {
        const Vec3 before = pose.position_m;
        pose.position_m.x = 0.05 * std::sin(0.01 * i);
        travelled_m += std::abs(pose.position_m.x - before.x);
        verdict = check.update(pose, 0.0004, kTick_s);
    }
    CHECK(verdict == ZeroCheck::Verdict::confirmed);
    CHECK(travelled_m == doctest::Approx(ZeroCheck::kTravel_m).epsilon(0.05));

    check.begin();
    for (int i = 0; i < 2000; ++i) { // jitter in place is travel, but no reach
        pose.position_m.x = i % 2 == 0 ? 0.001 : 0.0;
        CHECK(check.update(pose, 0.0004, kTick_s) == ZeroCheck::Verdict::pending);
    }
    check.begin();
    int ms = 0;
    while (check.update(pose, 0.002, kTick_s) == ZeroCheck::Verdict::pending) {
        ++ms;
        REQUIRE(ms < 100);
    }
    CHECK(ms == 19);
}

TEST_CASE("workspace: nothing inside, 300 N/m beyond the margin, no more than 3 N an axis") {
    ServoSettings settings = ideal_settings();
    WorkspaceGuard guard;
    guard.configure(settings);
    GripState grip;
    grip.conditioning = 0.5;
    CHECK(glm::length(guard.wall(grip).force_n) == 0.0);
    CHECK(WorkspaceGuard::scale(grip) == 1.0);
    grip.pose.position_m = Vec3(0.195, -0.2, 0.0); // the wall begins at 0.24 - 0.04 - 0.01
    CHECK(guard.wall(grip).force_n.x == doctest::Approx(-1.5));
    CHECK(guard.wall(grip).force_n.y == doctest::Approx(3.0));
    CHECK(guard.beyond_m(grip) == doctest::Approx(0.010));
    grip.pose.position_m = Vec3(0.0, 0.0, 5.0);
    CHECK(guard.wall(grip).force_n.z == doctest::Approx(-3.0));
    grip.conditioning = 0.0;
    CHECK(WorkspaceGuard::scale(grip) == 0.0);
    grip.conditioning = std::numeric_limits<double>::quiet_NaN();
    CHECK(WorkspaceGuard::scale(grip) == 0.0);
}

TEST_CASE("events: every kind has its own name, a sentence and, above info, a remedy") {
    std::set<std::string> names;
    for (int i = 0; i < kDeviceEventKinds; ++i) {
        const EventDescription &what = describe(static_cast<DeviceEventKind>(i));
        CAPTURE(what.name);
        CHECK(names.insert(what.name).second);
        REQUIRE(what.message != nullptr);
        CHECK(what.message[std::strlen(what.message) - 1] == '.');
        CHECK(std::strlen(what.category) > 0);
        if (what.level == EventLevel::fault) {
            CHECK(std::strlen(what.remedy) > 0);
        }
    }
    CHECK(std::string(describe(static_cast<DeviceEventKind>(200)).name) == "unknown");
}

TEST_CASE("events: a kind is told once a second, faults always; the rest is counted; at most eight "
          "a cycle") {
    EventLog log;
    int told = 0;
    for (int ms = 0; ms < 2500; ++ms) {
        log.begin_cycle(ms * kTick_s);
        log.tell(DeviceEventKind::reports_missed, -1, 1.0);
        told += static_cast<int>(log.events().size());
        if (!log.events().empty() && ms > 0) {
            CHECK(log.events()[0].repeated == 999);
        }
    }
    CHECK(told == 3);
    log.begin_cycle(2.5);
    log.tell(DeviceEventKind::count_jump, 3);
    log.begin_cycle(2.501);
    log.tell(DeviceEventKind::count_jump, 3);
    CHECK(log.events().size() == 1);
    log.begin_cycle(10.0);
    for (int i = 0; i < kDeviceEventKinds; ++i) {
        log.tell(static_cast<DeviceEventKind>(i));
    }
    CHECK(log.events().size() == EventLog::kMostAtOnce);
}

TEST_CASE("bounce monitor: bounces that leave faster than they came, three in a row, are found") {
    // A hand that flies at a wall, is pushed for 20 ms, and comes back after 100 ms; restitution: leaving to coming.
    const auto bounces = [](double restitution, int count, int touch_ms, int flight_ms) {
        BounceMonitor monitor;
        int found = 0;
        for (int i = 0; i < count; ++i) {
            Twist twist;
            twist.linear_m_s = Vec3(0.4, -0.2, 0.0); // along the wall it may move as it likes
            for (int ms = 0; ms < flight_ms; ++ms) {
                found += monitor.update(twist, Wrench(), 0.001) ? 1 : 0;
            }
            Wrench push;
            push.force_n.y = 3.0;
            for (int ms = 0; ms < touch_ms; ++ms) {
                found += monitor.update(twist, push, 0.001) ? 1 : 0;
            }
            twist.linear_m_s.y *= -restitution;
            for (int ms = 0; ms < flight_ms; ++ms) {
                found += monitor.update(twist, Wrench(), 0.001) ? 1 : 0;
            }
        }
        return found;
    };
    CHECK(bounces(1.3, 2, 20, 50) == 0);
    CHECK(bounces(1.3, 3, 20, 50) == 1);
    CHECK(bounces(0.9, 50, 20, 50) == 0);  // taps lose
    CHECK(bounces(1.3, 50, 200, 50) == 0); // pressed and pulled away by the hand
    CHECK(bounces(1.3, 50, 20, 300) == 0); // now and then
}
