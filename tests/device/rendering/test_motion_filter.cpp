#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "device/rendering/motion_filter.h"

using namespace spidar;

namespace {

constexpr double kTick_s = 0.001;

Displacement along_x(double move_m) {
    Displacement moved;
    moved.linear_m.x = move_m;
    return moved;
}

// Greatest filtered excursion of a motion of 1 m at this frequency.
double gain_at(double hz) {
    RenderSettings settings;
    settings.delay_compensation_s = 0.0;
    MotionFilter filter;
    filter.configure(settings, 1.0 / kTick_s);
    double most = 0.0;
    for (int i = 1; i < 4000; ++i) {
        const auto at = [hz](int tick) {
            return std::sin(2.0 * std::numbers::pi * hz * kTick_s * tick);
        };
        filter.update(along_x(at(i) - at(i - 1)), kTick_s);
        if (i > 2000) {
            most = std::max(most, std::abs(at(i) + filter.ahead().linear_m.x));
        }
    }
    return most;
}

} // namespace

TEST_CASE("motion filter: slow motion passes, the strings' resonance does not") {
    CHECK(gain_at(1.0) == doctest::Approx(1.0).epsilon(0.01));
    CHECK(gain_at(RenderSettings().string_resonance_hz) < 0.15);
    CHECK(gain_at(135.0) < 0.3); // the stiffest of the seven DOF
}

TEST_CASE("motion filter: of a steady motion it knows the speed, and where the grip will be") {
    for (const double lead_s : {0.0, 0.003}) {
        RenderSettings settings;
        settings.delay_compensation_s = lead_s;
        MotionFilter filter;
        filter.configure(settings, 1.0 / kTick_s);
        for (int i = 0; i < 300; ++i) {
            Displacement moved;
            moved.linear_m = Vec3(1e-4, -2e-4, 0.0);
            moved.angular_rad.z = 3e-4;
            moved.grasp_rad = -1e-4;
            filter.update(moved, kTick_s);
        }
        const Twist v = filter.velocity();
        CHECK(v.linear_m_s.x == doctest::Approx(0.1));
        CHECK(v.linear_m_s.y == doctest::Approx(-0.2));
        CHECK(v.angular_rad_s.z == doctest::Approx(0.3));
        CHECK(v.grasp_rate_rad_s == doctest::Approx(-0.1));
        // The notch of width 1 and depth 0.12 lags by 2 (1 - 0.12) / w, w corrected by the bilinear transform.
        const double w = 2.0 * std::numbers::pi * settings.string_resonance_hz;
        const double lag_s = 2.0 * (1.0 - 0.12) * kTick_s * 0.5 / std::tan(0.5 * w * kTick_s);
        CHECK(filter.ahead().linear_m.x == doctest::Approx(0.1 * (lead_s - lag_s)).epsilon(0.06));
    }
}

TEST_CASE("motion filter: at rest it is exactly at rest") {
    MotionFilter filter;
    filter.configure(RenderSettings(), 1.0 / kTick_s);
    CHECK(filter.at_rest());
    filter.update(along_x(1e-3), kTick_s);
    CHECK_FALSE(filter.at_rest());
    int ticks = 0;
    while (!filter.at_rest() && ticks < 1000) {
        filter.update(Displacement(), kTick_s);
        ++ticks;
    }
    CHECK(ticks < 200);
    CHECK(filter.ahead().linear_m.x == 0.0);
    CHECK(filter.velocity().linear_m_s.x == 0.0);
}

TEST_CASE("motion filter: after reset() in the middle of a motion it is as a new one") {
    MotionFilter fresh;
    fresh.configure(RenderSettings(), 1.0 / kTick_s);
    MotionFilter used = fresh;
    for (int i = 0; i < 7; ++i) {
        used.update(along_x(3e-4), kTick_s);
    }
    used.reset();
    CHECK(used.ahead().linear_m.x == 0.0);
    for (int i = 0; i < 20; ++i) {
        fresh.update(along_x(1e-4), kTick_s);
        used.update(along_x(1e-4), kTick_s);
        CHECK(used.ahead().linear_m.x == fresh.ahead().linear_m.x);
        CHECK(used.velocity().linear_m_s.x == fresh.velocity().linear_m_s.x);
    }
}

TEST_CASE("motion filter: time steps of any length give the motion of even ones") {
    MotionFilter even;
    even.configure(RenderSettings(), 1.0 / kTick_s);
    MotionFilter odd = even;
    for (int i = 0; i < 400; ++i) { // 0.1 m/s, seen each millisecond, and at 0.4 and 1.6 ms in turn
        even.update(along_x(1e-4), kTick_s);
        const double step_s = i % 2 == 0 ? 0.4e-3 : 1.6e-3;
        odd.update(along_x(0.1 * step_s), step_s);
    }
    CHECK(odd.velocity().linear_m_s.x == doctest::Approx(0.1).epsilon(1e-3));
    CHECK(odd.ahead().linear_m.x == doctest::Approx(even.ahead().linear_m.x).epsilon(0.02));
}

TEST_CASE("motion filter: a resonance beyond the rate, or none, leaves the pose as measured") {
    for (const double hz : {0.0, 60.0}) {
        RenderSettings settings;
        settings.string_resonance_hz = hz;
        settings.delay_compensation_s = 0.0;
        MotionFilter filter;
        filter.configure(settings, 100.0); // 60 Hz is above the Nyquist frequency
        for (int i = 0; i < 50; ++i) {
            filter.update(along_x(1e-3 * std::sin(0.7 * i)), 0.01);
            CHECK(filter.ahead().linear_m.x == 0.0);
        }
    }
}
