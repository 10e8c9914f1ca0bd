// What a surface does beside pushing and rubbing: static friction, adhesion, magnets, textures.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "support/proxy_rig.h"
#include "support/relief_samples.h"

using namespace spidar;
using namespace spidar::test;

namespace {

constexpr double kStiffness_n_m = 1000.0; // ProxySettings

// A ball over a floor at y = 0.
struct BallOnFloor : ProxyRig {
    ScenePart &floor;
    BallOnFloor() : floor(add(cooked_half_space())) { add_tool(make_sphere(kBall_m)); }
    void press(double depth_m) {
        start_at(at(Vec3(0.0, kBall_m + 0.02, 0.0)));
        move_to(at(Vec3(0.0, kBall_m - depth_m, 0.0)), 200);
    }
    // Slides at this speed and returns the wrench's force in each cycle.
    std::vector<Vec3> slide(const Vec3 &speed_m_s, int ticks) {
        std::vector<Vec3> forces;
        for (int i = 0; i < ticks; ++i) {
            device.position_m += kProxyTick_s * speed_m_s;
            tick({speed_m_s, Vec3(0.0), 0.0});
            forces.push_back(proxy.wrench().force_n);
        }
        return forces;
    }
};

// Of a force that swings about its mean: how often a second it rises through it.
double frequency_of(const std::vector<Vec3> &forces, int axis) {
    double mean = 0.0;
    for (const Vec3 &force : forces) {
        mean += force[axis] / static_cast<double>(forces.size());
    }
    double first = -1.0;
    double last = -1.0;
    int rises = 0;
    for (std::size_t i = 1; i < forces.size(); ++i) {
        const double before = forces[i - 1][axis] - mean;
        const double after = forces[i][axis] - mean;
        if (before < 0.0 && after >= 0.0) {
            last = static_cast<double>(i) - after / (after - before);
            first = rises == 0 ? last : first;
            ++rises;
        }
    }
    return rises < 2 ? 0.0 : (rises - 1) / ((last - first) * kProxyTick_s);
}

} // namespace

TEST_CASE("traits: a contact holds to the static coefficient, then slips at the dynamic one") {
    BallOnFloor rig;
    rig.floor.friction = 0.3;
    rig.floor.traits.static_friction = 0.8;
    rig.press(0.002);
    CHECK(rig.proxy.wrench().force_n.y == doctest::Approx(2.0));
    double most_n = 0.0;
    for (const Vec3 &force : rig.slide(Vec3(0.02, 0.0, 0.0), 300)) {
        most_n = std::max(most_n, -force.x);
    }
    CHECK(most_n == doctest::Approx(0.8 * 2.0).epsilon(0.02));
    CHECK(-rig.proxy.wrench().force_n.x == doctest::Approx(0.3 * 2.0).epsilon(0.001));
    // Standing, it catches; back the other way it holds to the static coefficient again.
    rig.slide(Vec3(0.0), 20);
    most_n = 0.0;
    for (const Vec3 &force : rig.slide(Vec3(-0.02, 0.0, 0.0), 300)) {
        most_n = std::max(most_n, force.x);
    }
    CHECK(most_n == doctest::Approx(0.8 * 2.0).epsilon(0.02));
}

TEST_CASE("traits: a slip takes some cycles, and is no blow") {
    BallOnFloor rig;
    rig.floor.friction = 0.2;
    rig.floor.traits.static_friction = 1.0;
    rig.press(0.002);
    Vec3 last = rig.proxy.wrench().force_n;
    double step_n = 0.0;
    for (const Vec3 &force : rig.slide(Vec3(0.05, 0.0, 0.0), 300)) {
        step_n = std::max(step_n, std::abs(force.x - last.x));
        last = force;
    }
    CHECK(step_n < 0.25 * 0.8 * 2.0);
}

TEST_CASE("traits: what catches again creaks, as often as its way to the next slip says") {
    BallOnFloor rig;
    rig.floor.friction = 0.2;
    rig.floor.traits.static_friction = 0.8;
    rig.floor.traits.catches_again = true;
    rig.press(0.002);
    constexpr double kSpeed_m_s = 0.05;
    const std::vector<Vec3> forces = rig.slide(Vec3(kSpeed_m_s, 0.0, 0.0), 2000);
    const double way_m = 0.6 * 2.0 / kStiffness_n_m;
    const double period_s =
        way_m / kSpeed_m_s + 0.003 + 0.005; // the hold's end and the slip itself
    CHECK(frequency_of(forces, 0) == doctest::Approx(1.0 / period_s).epsilon(0.08));
}

TEST_CASE(
    "traits: a magnet pulls on its surface as hard as it says, linearly less in its range, and "
    "nothing beyond") {
    BallOnFloor rig;
    rig.floor.traits.magnet_n = 1.5;
    rig.floor.traits.magnet_range_m = 0.010;
    rig.start_at(at(Vec3(0.0, kBall_m + 0.02, 0.0)));
    for (const double gap_m : {0.015, 0.0101, 0.009, 0.005, 0.002, 0.0005}) {
        rig.move_to(at(Vec3(0.0, kBall_m + gap_m, 0.0)), 100);
        CAPTURE(gap_m);
        CHECK(-rig.proxy.wrench().force_n.y ==
              doctest::Approx(1.5 * std::max(0.0, 1.0 - gap_m / 0.010)).epsilon(0.001));
        CHECK(rig.proxy.given()[0].force_n.y == doctest::Approx(-rig.proxy.wrench().force_n.y));
    }
    // Pressed in by 3 mm, the wall pushes and the magnet pulls.
    rig.move_to(at(Vec3(0.0, kBall_m - 0.003, 0.0)), 100);
    CHECK(rig.proxy.wrench().force_n.y == doctest::Approx(3.0 - 1.5).epsilon(0.001));
}

TEST_CASE("traits: a face of four points is drawn as one") {
    ProxyRig rig;
    ScenePart &floor = rig.add(cooked_half_space());
    rig.add_tool(make_tool(*box(Vec3(0.01))));
    floor.traits.magnet_n = 2.0;
    floor.traits.magnet_range_m = 0.02;
    rig.start_at(at(Vec3(0.0, 0.015, 0.0)));
    rig.tick();
    CHECK(rig.proxy.contact_count() == 4);
    CHECK(rig.proxy.wrench().force_n.y == doctest::Approx(-1.5));
    CHECK(glm::length(rig.proxy.wrench().moment_nm) < 1e-9);
}

TEST_CASE("traits: adhesion holds what has touched, up to its pull, and nothing that has not") {
    BallOnFloor rig;
    rig.floor.traits.adhesion_n = 1.0;
    rig.start_at(at(Vec3(0.0, kBall_m + 0.02, 0.0)));
    rig.move_to(at(Vec3(0.0, kBall_m + 0.0005, 0.0)), 200);
    CHECK(rig.proxy.wrench().force_n.y == 0.0);
    rig.move_to(at(Vec3(0.0, kBall_m - 0.001, 0.0)), 50);
    CHECK(rig.proxy.wrench().force_n.y == doctest::Approx(1.0));
    double most_n = 0.0;
    Vec3 last = rig.proxy.wrench().force_n;
    double step_n = 0.0;
    for (const Vec3 &force : rig.slide(Vec3(0.0, 0.02, 0.0), 400)) {
        most_n = std::max(most_n, -force.y);
        step_n = std::max(step_n, std::abs(force.y - last.y));
        last = force;
    }
    CHECK(most_n == doctest::Approx(1.0).epsilon(0.02));
    CHECK(step_n < 0.03);
    CHECK(last.y == 0.0);
    // Torn off, it is free.
    rig.move_to(at(Vec3(0.0, kBall_m + 0.0005, 0.0)), 100);
    CHECK(rig.proxy.wrench().force_n.y == 0.0);
}

TEST_CASE("traits: a texture is felt at speed over wavelength, along its grooves not at all") {
    for (const bool grooves : {true, false}) {
        for (const double speed_m_s : {0.02, 0.08, 0.15}) {
            BallOnFloor rig;
            rig.floor.traits.texture = {0.004, 0.0002, grooves ? Vec3(1.0, 0.0, 0.0) : Vec3(0.0)};
            rig.press(0.001);
            const std::vector<Vec3> forces = rig.slide(Vec3(speed_m_s, 0.0, 0.0), 3000);
            CAPTURE(grooves);
            CAPTURE(speed_m_s);
            CHECK(frequency_of(forces, 0) == doctest::Approx(speed_m_s / 0.004).epsilon(0.02));
            CHECK(frequency_of(forces, 1) == doctest::Approx(speed_m_s / 0.004).epsilon(0.02));
        }
    }
    BallOnFloor rig;
    rig.floor.traits.texture = {0.004, 0.0002, Vec3(1.0, 0.0, 0.0)};
    rig.press(0.001);
    const Vec3 still = rig.proxy.wrench().force_n;
    for (const Vec3 &force : rig.slide(Vec3(0.0, 0.0, 0.05), 500)) {
        CHECK(glm::length(force - still) < 1e-9);
    }
}

TEST_CASE("traits: a texture is conservative: a way there and back gives nothing") {
    BallOnFloor rig;
    rig.floor.traits.texture = {0.004, 0.0002, Vec3(0.0)};
    rig.press(0.0005);
    double work_j = 0.0;
    double most_j = 0.0;
    Vec3 before = rig.proxy.wrench().force_n;
    for (int i = 0; i < 4000; ++i) {
        const double phase = 2.0 * std::numbers::pi * i / 4000.0;
        const Vec3 to(0.011 * std::sin(phase), kBall_m - 0.0005 - 0.0003 * std::sin(2.0 * phase),
                      0.007 * (1.0 - std::cos(phase)));
        const Vec3 step_m = to - rig.device.position_m;
        rig.device.position_m = to;
        rig.tick();
        const Vec3 now = rig.proxy.wrench().force_n;
        work_j += glm::dot(0.5 * (now + before), step_m);
        most_j = std::max(most_j, std::abs(work_j));
        before = now;
    }
    CHECK(std::abs(work_j) < 0.02 * most_j);
}

TEST_CASE("traits: ridges of an image are felt as ridges, at any number of pixels") {
    for (const int columns : {32, 64, 256}) {
        const auto image = cooked(relief_waves(columns, columns, 4, 0));
        for (const double speed_m_s : {0.02, 0.08}) {
            BallOnFloor rig;
            rig.floor.traits.texture = {0.016, 0.0002, Vec3(0.0), image.get()};
            rig.press(0.001);
            const std::vector<Vec3> forces = rig.slide(Vec3(speed_m_s, 0.0, 0.0), 3000);
            BallOnFloor smooth;
            smooth.floor.traits.texture = {0.004, 0.0002, Vec3(1.0, 0.0, 0.0)};
            smooth.press(0.001);
            const std::vector<Vec3> wanted = smooth.slide(Vec3(speed_m_s, 0.0, 0.0), 3000);
            const auto swing = [](const std::vector<Vec3> &of) {
                const auto [low, high] = std::ranges::minmax(of, {}, &Vec3::y);
                return high.y - low.y;
            };
            CAPTURE(columns);
            CAPTURE(speed_m_s);
            CHECK(frequency_of(forces, 0) == doctest::Approx(speed_m_s / 0.004).epsilon(0.02));
            CHECK(swing(forces) == doctest::Approx(swing(wanted)).epsilon(0.25));
            // Along the ridges there is nothing.
            rig.slide(Vec3(0.0), 20);
            const Vec3 stands = rig.proxy.wrench().force_n;
            for (const Vec3 &force : rig.slide(Vec3(0.0, 0.0, 0.02), 200)) {
                CHECK(glm::length(force - stands) < 1e-3);
            }
        }
    }
}

TEST_CASE("traits: an image lies on each side of a part, and never steps at its edges") {
    const auto image = cooked(relief_waves(64, 64, 4, 0));
    ProxyRig rig;
    ScenePart &ball = rig.add(round_shape(ShapeKind::sphere, 0.05));
    rig.add_tool(make_sphere(kBall_m));
    ball.traits.texture = {0.016, 0.0002, Vec3(0.0), image.get()};
    const double reach_m = 0.05 + kBall_m - 0.001;
    rig.start_at(at(Vec3(0.0, reach_m + 0.01, 0.0)));
    rig.move_to(at(Vec3(0.0, reach_m, 0.0)), 100);
    Vec3 before = rig.proxy.wrench().force_n;
    double most_n = 0.0;
    for (int i = 1; i < 6000; ++i) { // over the pole, down the side and around it
        const double turn = 0.0005 * i;
        const Vec3 to = reach_m * Vec3(std::sin(turn) * std::cos(0.7 * turn), std::cos(turn),
                                       std::sin(turn) * std::sin(0.7 * turn));
        rig.device.position_m = to;
        rig.tick();
        most_n = std::max(most_n, glm::length(rig.proxy.wrench().force_n - before));
        before = rig.proxy.wrench().force_n;
        REQUIRE(glm::length(before) > 0.3);
    }
    CHECK(most_n < 0.05);
}

TEST_CASE("traits: a noisy image gives no work for nothing, and is not stiffer than its share") {
    const auto image = cooked(relief_noise(128, 128, 3));
    BallOnFloor rig;
    rig.floor.traits.texture = {0.02, 0.0005, Vec3(0.0), image.get()};
    rig.press(0.002);
    double work_j = 0.0;
    double most_n_m = 0.0;
    Vec3 before = rig.proxy.wrench().force_n;
    for (int i = 0; i < 20000; ++i) {
        const double phase = 2.0 * std::numbers::pi * i / 20000.0;
        const Vec3 to(0.03 * std::sin(phase), kBall_m - 0.002,
                      0.02 * (1.0 - std::cos(3.0 * phase)));
        const Vec3 step_m = to - rig.device.position_m;
        rig.device.position_m = to;
        rig.tick({step_m / kProxyTick_s, Vec3(0.0), 0.0});
        const Vec3 now = rig.proxy.wrench().force_n;
        work_j += glm::dot(0.5 * (now + before), step_m);
        const Vec3 along = (now - before) * Vec3(1.0, 0.0, 1.0);
        most_n_m = std::max(most_n_m, glm::length(along) / glm::length(step_m));
        before = now;
    }
    CHECK(work_j < 1e-5); // of the wrench on the hand: the surface gives none
    CHECK(most_n_m < 0.6 * kStiffness_n_m);
    CHECK(most_n_m > 0.05 * kStiffness_n_m);
}

TEST_CASE("traits: crests too fast for the servo cycle are gone, and no texture is stiffer than "
          "its share") {
    BallOnFloor fast;
    fast.floor.traits.texture = {0.001, 0.0002, Vec3(1.0, 0.0, 0.0)};
    fast.press(0.002);
    for (const Vec3 &force : fast.slide(Vec3(0.3, 0.0, 0.0), 200)) {
        CHECK(force.x == 0.0);
        CHECK(force.y == doctest::Approx(2.0));
    }
    BallOnFloor hard;
    hard.floor.traits.texture = {0.001, 0.0003, Vec3(1.0, 0.0, 0.0)};
    hard.press(0.003);
    double stiffest_n_m = 0.0;
    Vec3 last = hard.proxy.wrench().force_n;
    for (const Vec3 &force : hard.slide(Vec3(0.01, 0.0, 0.0), 500)) {
        stiffest_n_m = std::max(stiffest_n_m, std::abs(force.x - last.x) / 1e-5);
        last = force;
    }
    CHECK(stiffest_n_m < 0.6 * kStiffness_n_m);
    CHECK(stiffest_n_m > 0.2 * kStiffness_n_m);
}

TEST_CASE("traits: a surface damps by its own damping, however soft it is") {
    for (const double stiffness_n_m : {0.0, 300.0, 150.0}) {
        BallOnFloor rig;
        rig.floor.stiffness_n_m = stiffness_n_m;
        rig.floor.damping_n_s_m = 4.0;
        rig.press(0.004);
        const double still_n = rig.proxy.wrench().force_n.y;
        rig.tick({Vec3(0.0, -0.05, 0.0), Vec3(0.0), 0.0}); // it is there, and moves
        CAPTURE(stiffness_n_m);
        CHECK(std::abs(rig.proxy.wrench().force_n.y - still_n - 4.0 * 0.05) < 1e-6);
    }
}

TEST_CASE("traits: a scene with senseless ones is refused") {
    TouchScene touch = FloorScene().touch;
    CHECK(validate(touch) == Status::ok);
    SurfaceTraits &traits = touch.scene.parts[0].traits;
    traits.texture.depth_m = 0.001;
    CHECK(validate(touch) == Status::invalid_request); // without a wavelength
    traits.texture.wavelength_m = 0.004;
    CHECK(validate(touch) == Status::ok);
    traits.texture.relief = touch.scene.parts[0].shape; // a solid is no relief
    CHECK(validate(touch) == Status::invalid_request);
    const auto image = cooked(relief_waves(32, 32, 4, 0));
    traits.texture.relief = image.get();
    CHECK(validate(touch) == Status::ok);
    const CookedShape *const floor = touch.scene.parts[0].shape;
    touch.scene.parts[0].shape = image.get(); // and a relief no solid
    CHECK(validate(touch) == Status::invalid_request);
    touch.scene.parts[0].shape = floor;
    traits.texture.relief = nullptr;
    traits.magnet_n = -1.0;
    CHECK(validate(touch) == Status::invalid_request);
    traits.magnet_n = std::nan("");
    CHECK(validate(touch) == Status::not_finite);
}
