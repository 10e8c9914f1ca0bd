#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "device/rendering/passivity.h"

using namespace spidar;

namespace {

constexpr double kTick_s = 0.001;
constexpr double kMass_kg = 0.15;

// A hand of one DOF bounces a mass on a wall that a game computes at 60 Hz. Returns the work that
// the wall did in all (J).
double tap(bool controlled) {
    PassivityController controller;
    DofGains most{};
    if (controlled) {
        most[0] = 10.0;
    }
    controller.configure(most);
    EnergyObserver observer;
    double x = 0.01;
    double v = -0.2;
    double held_n = 0.0;
    for (int i = 0; i < 1000; ++i) {
        if (i % 16 == 0) {
            held_n = x < 0.0 ? -300.0 * x : 0.0;
        }
        Displacement moved;
        moved.linear_m.x = kTick_s * v;
        x += kTick_s * v;
        observer.update(moved);
        Wrench asked;
        asked.force_n.x = held_n;
        Twist twist;
        twist.linear_m_s.x = v;
        const Wrench given = controller.correct(asked, moved, twist, kTick_s);
        observer.hold(given);
        v += kTick_s * given.force_n.x / kMass_kg;
        if (x > 0.01 && v > 0.0) {
            break; // away again
        }
    }
    return observer.injected_j()[0];
}

} // namespace

TEST_CASE("passivity: the observer counts force times move, in the DOF where it acts") {
    EnergyObserver observer;
    Wrench held;
    held.force_n = Vec3(1.0, -2.0, 0.0);
    held.grasp_torque_nm = 0.1;
    observer.hold(held);
    Displacement moved;
    moved.linear_m = Vec3(0.01, 0.01, 0.5);
    moved.grasp_rad = -0.2;
    observer.update(moved);
    observer.update(moved);
    CHECK(observer.injected_j()[0] == doctest::Approx(0.02));
    CHECK(observer.injected_j()[1] == doctest::Approx(-0.04));
    CHECK(observer.injected_j()[2] == 0.0);
    CHECK(observer.injected_j()[6] == doctest::Approx(-0.04));
}

TEST_CASE("passivity: a wall held between frames gives energy; controlled it does not") {
    const double free_j = tap(false);
    CHECK(free_j > 1e-3);
    CHECK(tap(true) < 0.25 * free_j);
}

TEST_CASE("passivity: a weight is left alone") {
    PassivityController controller;
    DofGains most{};
    most.values.fill(5.0);
    controller.configure(most);
    Wrench weight;
    weight.force_n.y = -1.0;
    Displacement moved;
    Twist twist;
    double away_n = 0.0;
    for (int i = 0; i < 3000; ++i) {
        // Carried up and down at up to 0.15 m/s.
        twist.linear_m_s.y = 0.15 * std::sin(0.005 * i);
        moved.linear_m.y = kTick_s * twist.linear_m_s.y;
        const Wrench given = controller.correct(weight, moved, twist, kTick_s);
        if (i > 1500) {
            away_n = std::max(away_n, std::abs(given.force_n.y - weight.force_n.y));
        }
    }
    CHECK(away_n < 0.01);
}

TEST_CASE("passivity: settles to exactly nothing") {
    PassivityController controller;
    DofGains most{};
    most.values.fill(5.0);
    controller.configure(most);
    Wrench push;
    push.force_n.x = 1.0;
    controller.correct(push, Displacement(), Twist(), kTick_s);
    CHECK_FALSE(controller.settled());
    int ticks = 0;
    while (!controller.settled() && ticks < 5000) {
        controller.correct(Wrench(), Displacement(), Twist(), kTick_s);
        ++ticks;
    }
    CHECK(ticks < 3000);
}
