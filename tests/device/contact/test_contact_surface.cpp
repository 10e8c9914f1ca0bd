#include <doctest/doctest.h>

#include <cmath>

#include <glm/geometric.hpp>

#include "device/contact/contact_surface.h"
#include "device/rendering/motion_filter.h"

using namespace spidar;

namespace {

constexpr double kTick_s = 0.001;

// A surface as the game sees it at a time, and the same rendered: looked at each frame, given a while later.
struct Game {
    int frame_ticks = 16;
    int late_ticks = 5;

    // Calls check(time, rendered) each cycle.
    template <typename At, typename Check>
    void play(At at, const Vec3 &pivot_m, int ticks, Check check) const {
        SurfaceTrack track;
        GameClock clock;
        double seen_s = -1.0;
        bool begun = false;
        for (int i = 0; i < ticks; ++i) {
            const double now_s = i * kTick_s;
            if (begun) {
                clock.advance(kTick_s);
            }
            if (i >= late_ticks && (i - late_ticks) % frame_ticks == 0) {
                const double state_s = now_s - late_ticks * kTick_s;
                const ContactPlane plane = at(state_s);
                if (begun) {
                    track.renew(plane, track.now(clock), state_s - seen_s, pivot_m);
                } else {
                    track.begin(plane);
                }
                clock.receive(state_s, now_s);
                begun = true;
                seen_s = state_s;
            }
            if (begun) {
                check(now_s, track.now(clock));
            }
        }
    }
};

} // namespace

TEST_CASE("contact surface: what moves steadily is where it is, at any frame rate and lateness") {
    constexpr double kSpeed_m_s = 0.2;
    const auto at = [](double t) {
        ContactPlane plane;
        plane.normal = Vec3(1.0, 0.0, 0.0);
        plane.offset_m = kSpeed_m_s * t;
        plane.velocity_m_s.x = kSpeed_m_s;
        return plane;
    };
    for (const int frame_ticks : {1, 4, 7, 16, 33}) {
        for (const int late_ticks : {0, 1, 3, 12}) {
            CAPTURE(frame_ticks);
            CAPTURE(late_ticks);
            double worst_m = 0.0;
            Game{frame_ticks, late_ticks}.play(
                at, Vec3(0.0), 800, [&](double t, const ContactSurface &now) {
                    if (t > 0.4) { // a slow game's frames have been learned
                        worst_m = std::max(worst_m, std::abs(now.offset_m - kSpeed_m_s * t));
                    }
                });
            CHECK(worst_m < 1e-12);
        }
    }
}

TEST_CASE("contact surface: a plane that turns steadily is carried on by its turn") {
    constexpr double kTurn_rad_s = 2.0;
    const Vec3 pivot(0.01, 0.02, 0.0);
    const auto at = [&pivot](double t) {
        ContactPlane plane;
        plane.normal = Vec3(std::cos(kTurn_rad_s * t), std::sin(kTurn_rad_s * t), 0.0);
        plane.offset_m = glm::dot(plane.normal, pivot);
        return plane;
    };
    double worst_rad = 0.0;
    double worst_m = 0.0;
    const Game game{16, 5};
    game.play(at, pivot, 400, [&](double t, const ContactSurface &now) {
        if (t > 0.1) { // three updates and the fades of the first
            const ContactPlane truth = at(t);
            worst_rad = std::max(worst_rad, glm::length(now.normal - truth.normal));
            worst_m = std::max(worst_m, std::abs(now.offset_m - truth.offset_m));
            CHECK(glm::length(now.normal) == doctest::Approx(1.0).epsilon(1e-12));
        }
    });
    CHECK(worst_rad < 1e-3); // not carried on: 0.04 on the way
    CHECK(worst_m < 2e-5);
}

TEST_CASE("contact surface: steady acceleration is carried on, a single jolt is not") {
    constexpr double kGravity_m_s2 = 9.8;
    const auto falling = [](double t) {
        ContactPlane plane;
        plane.normal = Vec3(0.0, 1.0, 0.0);
        plane.offset_m = -0.5 * kGravity_m_s2 * t * t;
        plane.velocity_m_s.y = -kGravity_m_s2 * t;
        return plane;
    };
    double worst_m = 0.0;
    Game{8, 2}.play(falling, Vec3(0.0), 300, [&](double t, const ContactSurface &now) {
        if (t > 0.2) { // the fades of the first updates are over
            worst_m = std::max(worst_m, std::abs(now.offset_m - falling(t).offset_m));
        }
    });
    CHECK(worst_m < 1e-8);

    // A push sets it off at once: the speed that it has is used, none that it might get.
    const auto pushed = [](double t) {
        ContactPlane plane;
        plane.normal = Vec3(0.0, 1.0, 0.0);
        const double since_s = std::max(0.0, t - 0.1);
        plane.offset_m = 0.1 * since_s;
        plane.velocity_m_s.y = t > 0.1 ? 0.1 : 0.0;
        return plane;
    };
    double ahead_m = 0.0;
    Game{16, 5}.play(pushed, Vec3(0.0), 400, [&](double t, const ContactSurface &now) {
        ahead_m = std::max(ahead_m, now.offset_m - pushed(t).offset_m);
    });
    CHECK(ahead_m < 1e-12);
}

TEST_CASE("contact surface: a normal that jumps once, as at an edge, does not swing beyond") {
    const auto edge = [](double t) {
        ContactPlane plane;
        const double angle = t < 0.1 ? 0.0 : 0.3;
        plane.normal = Vec3(std::cos(angle), std::sin(angle), 0.0);
        return plane;
    };
    double most_rad = 0.0;
    Game{16, 5}.play(edge, Vec3(0.0), 300, [&](double, const ContactSurface &now) {
        most_rad = std::max(most_rad, std::atan2(now.normal.y, now.normal.x));
    });
    CHECK(most_rad == doctest::Approx(0.3).epsilon(1e-12));
}

TEST_CASE("motion filter: its steady lead is what a steady motion shows") {
    for (const double rate_hz : {500.0, 1000.0, 4000.0}) {
        for (const double resonance_hz : {0.0, 112.0, 200.0}) {
            CAPTURE(rate_hz);
            CAPTURE(resonance_hz);
            RenderSettings settings;
            settings.string_resonance_hz = resonance_hz;
            MotionFilter filter;
            filter.configure(settings, rate_hz);
            constexpr double kSpeed_m_s = 0.3;
            Displacement moved;
            moved.linear_m.x = kSpeed_m_s / rate_hz;
            for (int i = 0; i < 4000; ++i) {
                filter.update(moved, 1.0 / rate_hz);
            }
            CHECK(filter.ahead().linear_m.x ==
                  doctest::Approx(kSpeed_m_s * filter.steady_lead_s()).epsilon(1e-6));
        }
    }
}
