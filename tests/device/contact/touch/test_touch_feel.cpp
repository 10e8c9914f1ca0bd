// Settings that a game changes while the hand touches: how much of it is felt in one cycle, and what is felt in the end.
#include <doctest/doctest.h>

#include <algorithm>
#include <functional>
#include <string>
#include <vector>

#include <glm/geometric.hpp>

#include "support/touch_rig.h"

using namespace spidar;
using namespace spidar::test;

namespace {

constexpr double kDepth_m = 0.002;
constexpr double kSpeed_m_s = 0.03;
constexpr int kTicksAFrame = 16;
// Without a fade the largest of the changes below steps by 1.5 N in a cycle.
constexpr double kMostStep_n = 0.1;

using Change = std::function<void(TouchScene &)>;

// A ball that slides over a floor, its game at 60 frames a second.
struct Slide {
    TouchRig rig;
    FloorScene scene{0.0, 800.0};
    std::vector<Vec3> forces;

    Slide() {
        rig.motion.grip.pose.position_m = Vec3(0.0, kBall_m - kDepth_m, 0.0);
        rig.motion.velocity.linear_m_s = Vec3(kSpeed_m_s, 0.0, 0.0);
        scene.touch.scene.parts[0].friction = 0.3;
        scene.touch.scene.parts[0].stiffness_n_m = 700.0;
    }
    void frames(int count) {
        for (int i = 0; i < count; ++i) {
            rig.give(scene.touch);
            for (int tick = 0; tick < kTicksAFrame; ++tick) {
                rig.motion.grip.pose.position_m.x += kSpeed_m_s * kTick_s;
                forces.push_back(rig.tick().force_n);
            }
        }
    }
};

double most_step_n(const std::vector<Vec3> &forces, std::size_t from) {
    double most = 0.0;
    for (std::size_t i = std::max<std::size_t>(from, 1); i < forces.size(); ++i) {
        most = std::max(most, glm::length(forces[i] - forces[i - 1]));
    }
    return most;
}

ScenePart &floor_of(TouchScene &touch) {
    return touch.scene.parts[0];
}

struct Named {
    const char *name;
    Change change;
};

std::vector<Named> changes() {
    return {
        {"hand stiffness",
         [](TouchScene &touch) {
             for (std::size_t dof = 0; dof < 3; ++dof) {
                 touch.stiffness[dof] = 200.0;
             }
         }},
        {"hand damping", [](TouchScene &touch) { touch.damping_n_s_m = 0.2; }},
        {"stiffness", [](TouchScene &touch) { floor_of(touch).stiffness_n_m = 150.0; }},
        {"from soft to rigid", [](TouchScene &touch) { floor_of(touch).stiffness_n_m = 0.0; }},
        {"damping", [](TouchScene &touch) { floor_of(touch).damping_n_s_m = 1.0; }},
        {"friction", [](TouchScene &touch) { floor_of(touch).friction = 1.2; }},
        {"static friction",
         [](TouchScene &touch) { floor_of(touch).traits.static_friction = 1.0; }},
        {"adhesion", [](TouchScene &touch) { floor_of(touch).traits.adhesion_n = 1.5; }},
        {"magnet",
         [](TouchScene &touch) {
             floor_of(touch).traits.magnet_n = 1.5;
             floor_of(touch).traits.magnet_range_m = 0.01;
         }},
        {"texture",
         [](TouchScene &touch) {
             floor_of(touch).traits.texture = {0.006, 0.0001, Vec3(1.0, 0.0, 0.0)};
         }},
    };
}

} // namespace

TEST_CASE("touch feel: what a game changes while the hand slides is felt within 0.1 s, without a "
          "jolt") {
    for (const Named &one : changes()) {
        CAPTURE(std::string(one.name));
        Slide slide;
        slide.frames(30);
        const std::size_t changed = slide.forces.size();
        one.change(slide.scene.touch);
        slide.frames(6); // 0.1 s
        Slide fresh;
        one.change(fresh.scene.touch);
        fresh.frames(36);
        CHECK(most_step_n(slide.forces, changed) < kMostStep_n);
        CHECK(glm::length(slide.forces.back() - fresh.forces.back()) < 0.01);
        // And back again.
        const std::size_t back = slide.forces.size();
        slide.scene = FloorScene{0.0, 800.0};
        floor_of(slide.scene.touch).friction = 0.3;
        floor_of(slide.scene.touch).stiffness_n_m = 700.0;
        slide.frames(12);
        CHECK(most_step_n(slide.forces, back) < kMostStep_n);
        CHECK(glm::length(slide.forces.back() - slide.forces[changed - 1]) < 0.02);
    }
}

TEST_CASE("touch feel: another texture comes when the old one has become flat") {
    Slide slide;
    floor_of(slide.scene.touch).traits.texture = {0.006, 0.0001, Vec3(1.0, 0.0, 0.0)};
    slide.frames(30);
    const double usual_n = most_step_n(slide.forces, 100);
    const std::size_t changed = slide.forces.size();
    floor_of(slide.scene.touch).traits.texture = {0.009, 0.0001, Vec3(1.0, 0.0, 0.0)};
    slide.frames(6);
    CHECK(most_step_n(slide.forces, changed) < 2.0 * usual_n);
}

TEST_CASE("touch feel: a change before anything is touched is there at once") {
    Slide slide;
    slide.frames(1);
    Slide other;
    other.scene.touch.stiffness[1] = 300.0;
    other.frames(1);
    CHECK(other.forces[0].y < 0.7 * slide.forces[0].y);
}

TEST_CASE("touch feel: what is soft because the push moves it becomes rigid at once") {
    Slide slide;
    floor_of(slide.scene.touch).stiffness_at_once = true;
    floor_of(slide.scene.touch).stiffness_n_m = 50.0;
    slide.frames(30);
    const std::size_t changed = slide.forces.size();
    floor_of(slide.scene.touch).stiffness_n_m = 0.0;
    slide.frames(1);
    CHECK(slide.forces[changed].y > 5.0 * slide.forces[changed - 1].y);
}

TEST_CASE("touch feel: a slider that moves in every frame is followed") {
    Slide slide;
    slide.frames(10);
    const std::size_t from = slide.forces.size();
    for (int frame = 0; frame < 60; ++frame) {
        floor_of(slide.scene.touch).stiffness_n_m = 700.0 - 10.0 * frame;
        slide.frames(1);
    }
    slide.frames(6);
    Slide fresh;
    floor_of(fresh.scene.touch).stiffness_n_m = 110.0;
    fresh.frames(76);
    CHECK(most_step_n(slide.forces, from) < 0.02);
    CHECK(glm::length(slide.forces.back() - fresh.forces.back()) < 0.01);
}
