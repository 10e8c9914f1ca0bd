// The tool's proxy against answers in closed form: planes, edges, faces, jaws; nothing is passed at any speed.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <random>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "core/geometry/rotation_log.h"
#include "support/proxy_rig.h"

using namespace spidar;
using namespace spidar::test;

TEST_CASE("tool pose: between() is the inverse of moved()") {
    std::mt19937_64 random(3);
    std::normal_distribution<double> normal;
    for (int round = 0; round < 1000; ++round) {
        const auto draw = [&] { return Vec3(normal(random), normal(random), normal(random)); };
        const ToolPose from{draw(), rotation_exp(draw()), normal(random)};
        const Displacement by{draw(), 0.5 * draw(), normal(random)};
        const Displacement back = between(from, moved(from, by));
        CHECK(glm::distance(back.linear_m, by.linear_m) < 1e-12);
        CHECK(glm::distance(back.angular_rad, by.angular_rad) < 1e-9);
        CHECK(back.grasp_rad == doctest::Approx(by.grasp_rad));
    }
}

TEST_CASE("tool: how a point of it moves is the derivative of where it is") {
    std::mt19937_64 random(4);
    std::normal_distribution<double> normal;
    const Jaws jaws;
    for (int round = 0; round < 1000; ++round) {
        const auto draw = [&] { return Vec3(normal(random), normal(random), normal(random)); };
        const ToolMount mount = static_cast<ToolMount>(random() % 3);
        const ToolPart part{nullptr, mount, {0.05 * draw(), rotation_exp(draw())}, 0};
        const ToolPose pose{0.1 * draw(), rotation_exp(draw()), 0.3 * normal(random)};
        const Vec3 local_m = 0.02 * draw();
        const auto point_of = [&](const ToolPose &where) {
            const Placement placed = placement_of(part, jaws, where);
            return placed.origin_m + placed.rotation * local_m;
        };
        const Vec3 direction = glm::normalize(draw());
        const Displacement along = moves_along(part, jaws, pose, point_of(pose), direction);
        constexpr double kStep = 1e-6;
        const auto slope = [&](const Displacement &by) {
            const Displacement back{-by.linear_m, -by.angular_rad, -by.grasp_rad};
            return glm::dot(direction, point_of(moved(pose, by)) - point_of(moved(pose, back))) /
                   (2.0 * kStep);
        };
        for (int axis = 0; axis < 3; ++axis) {
            Vec3 unit(0.0);
            unit[axis] = kStep;
            CHECK(slope({unit, Vec3(0.0), 0.0}) ==
                  doctest::Approx(along.linear_m[axis]).epsilon(1e-6));
            CHECK(std::abs(slope({Vec3(0.0), unit, 0.0}) - along.angular_rad[axis]) < 1e-7);
        }
        CHECK(std::abs(slope({Vec3(0.0), Vec3(0.0), kStep}) - along.grasp_rad) < 1e-7);
    }
}

TEST_CASE("proxy: in free space it is where the device is, however fast, and nothing pushes") {
    ProxyRig rig;
    rig.add_tool(make_sphere(0.012));
    rig.add(box(Vec3(0.5, 0.1, 0.5)), {Vec3(0.0, -0.2, 0.0), Mat3(1.0)});
    rig.start_at(at(Vec3(0.0)));
    rig.device = at(Vec3(0.3, 0.2, 0.1));
    for (int i = 0; i < 200; ++i) {
        rig.tick();
        CHECK(glm::length(rig.proxy.wrench().force_n) == 0.0);
    }
    CHECK(glm::distance(rig.proxy.pose().position_m, rig.device.position_m) < 1e-12);
    CHECK(rig.proxy.queries() == 0);
}

TEST_CASE("proxy: a sphere on a plane is pushed by stiffness times depth, and stays on it") {
    ProxyRig rig;
    rig.add_tool(make_sphere(0.012));
    rig.add(cooked_half_space());
    rig.start_at(at(Vec3(0.0, 0.02, 0.0)));
    rig.move_to(at(Vec3(0.01, 0.007, 0.0)), 100);
    const Wrench wrench = rig.proxy.wrench();
    CHECK(wrench.force_n.y == doctest::Approx(1000.0 * 0.005).epsilon(1e-4));
    CHECK(std::abs(wrench.force_n.x) < 1e-4);
    CHECK(glm::length(wrench.moment_nm) < 1e-4);
    CHECK(rig.proxy.pose().position_m.y == doctest::Approx(0.012).epsilon(1e-4));
    CHECK(rig.proxy.pose().position_m.x == doctest::Approx(0.01));
    CHECK(rig.proxy.given()[0].force_n.y == doctest::Approx(-wrench.force_n.y));
}

TEST_CASE("proxy: a face of four points pushes like one plane, with and without a turn") {
    ProxyRig rig;
    rig.add_tool(make_tool(*box(Vec3(0.02, 0.01, 0.03))));
    rig.add(cooked_half_space());
    rig.start_at(at(Vec3(0.0, 0.02, 0.0)));
    rig.move_to(at(Vec3(0.0, 0.006, 0.0)), 100);
    CHECK(rig.proxy.contact_count() == 4);
    CHECK(rig.proxy.wrench().force_n.y == doctest::Approx(4.0).epsilon(1e-3));
    CHECK(glm::length(rig.proxy.wrench().moment_nm) < 1e-3);
    for (int i = 0; i < 4; ++i) { // coplanar points share
        CHECK(rig.proxy.contact(i).push_n == doctest::Approx(1.0).epsilon(0.02));
    }
    // Turned a little while pressed: the face keeps it flat, and the moment is that of the turn's own stiffness.
    ToolPose turned = rig.device;
    turned.rotation = rotation_exp(Vec3(0.01, 0.0, 0.0));
    rig.move_to(turned, 50);
    CHECK(rig.proxy.wrench().force_n.y == doctest::Approx(4.0).epsilon(1e-2));
    CHECK(rig.proxy.wrench().moment_nm.x == doctest::Approx(-2.0 * 0.01).epsilon(1e-2));
}

TEST_CASE("proxy: a bar pressed on an edge far from the hand turns the hand") {
    for (const double lever_m : {0.075, 0.05, 0.0}) {
        for (const double side : {1.0, -1.0}) {
            ProxyRig rig;
            rig.add_tool(make_tool(*box(Vec3(0.1, 0.01, 0.01))));
            // A block from the lever outwards, its top at y = 0; about the middle: one wide block.
            const Vec3 half = lever_m > 0.0 ? Vec3(0.01, 0.02, 0.02) : Vec3(0.15, 0.02, 0.02);
            const double centre_m = lever_m > 0.0 ? side * (lever_m + half.x) : 0.0;
            rig.add(box(half), {Vec3(centre_m, -0.02, 0.0), Mat3(1.0)});
            rig.start_at(at(Vec3(0.0, 0.015, 0.0)));
            rig.move_to(at(Vec3(0.0, 0.005, 0.0)), 100);
            const Wrench wrench = rig.proxy.wrench();
            const double gives_m_n = 1.0 / 1000.0 + lever_m * lever_m / 2.0;
            const double force_n = 0.005 / gives_m_n;
            CAPTURE(lever_m);
            CAPTURE(side);
            CHECK(wrench.force_n.y == doctest::Approx(force_n).epsilon(0.02));
            CHECK(wrench.moment_nm.z ==
                  doctest::Approx(side * lever_m * force_n).epsilon(0.02).scale(0.01));
            CHECK(std::abs(wrench.moment_nm.x) < 0.002);
            CHECK(std::abs(wrench.moment_nm.y) < 0.002);
        }
    }
}

TEST_CASE("proxy: a body between the jaws stops the fingers, and what is pressed is felt as grasp "
          "torque") {
    ProxyRig rig;
    for (const ToolMount mount : {ToolMount::jaw_minus, ToolMount::jaw_plus}) {
        const double out = mount == ToolMount::jaw_plus ? 0.012 : -0.012;
        rig.add_tool(make_sphere(0.012), mount, {Vec3(out, 0.0, 0.0), Mat3(1.0)});
    }
    rig.add(box(Vec3(0.015, 0.03, 0.03)));
    rig.start_at(ToolPose());
    const double stop_rad = rig.tool.jaws.closed_rad * (1.0 - 0.03 / rig.tool.jaws.open_m);
    ToolPose closed;
    closed.grasp_rad = stop_rad + 0.1;
    rig.move_to(closed, 200);
    CHECK(rig.proxy.pose().grasp_rad == doctest::Approx(stop_rad).epsilon(1e-3));
    CHECK(rig.proxy.wrench().grasp_torque_nm == doctest::Approx(-0.4 * 0.1).epsilon(1e-2));
    CHECK(glm::length(rig.proxy.wrench().force_n) < 1e-3);
    // Each jaw presses with the torque over half the slope of the gap.
    const double slope_m_rad = rig.tool.jaws.open_m / rig.tool.jaws.closed_rad;
    for (int i = 0; i < rig.proxy.contact_count(); ++i) {
        CHECK(rig.proxy.contact(i).push_n == doctest::Approx(0.04 / slope_m_rad).epsilon(0.02));
    }
    // Off the middle the body pushes one jaw more: the hand is moved, not only stopped.
    closed.position_m.x = 0.0005;
    rig.move_to(closed, 50);
    CHECK(rig.proxy.wrench().force_n.x == doctest::Approx(-1000.0 * 0.0005).epsilon(2e-2));
}

TEST_CASE("proxy: friction holds within the cone and slips at it; a face holds a turn too") {
    ProxyRig rig;
    rig.add_tool(make_tool(*box(Vec3(0.02, 0.01, 0.02))));
    rig.add(cooked_half_space()).friction = 0.5;
    rig.start_at(at(Vec3(0.0, 0.02, 0.0)));
    rig.move_to(at(Vec3(0.0, 0.006, 0.0)), 100); // 4 N
    rig.move_to(at(Vec3(0.001, 0.006, 0.0)), 100);
    CHECK(rig.proxy.wrench().force_n.x == doctest::Approx(-1.0).epsilon(0.02)); // sticks: 1000 N/m
    rig.move_to(at(Vec3(0.02, 0.006, 0.0)), 400);
    CHECK(rig.proxy.wrench().force_n.x == doctest::Approx(-2.0).epsilon(0.02)); // slips: 0.5 * 4 N
    rig.move_to(at(Vec3(0.0185, 0.006, 0.0)), 100);
    CHECK(rig.proxy.wrench().force_n.x ==
          doctest::Approx(-0.5).epsilon(0.1)); // and sticks on the way back
    ToolPose turned = rig.device;
    rig.start_at(at(Vec3(0.0, 0.02, 0.0)));
    rig.move_to(at(Vec3(0.0, 0.006, 0.0)), 100);
    turned = rig.device;
    turned.rotation = rotation_exp(Vec3(0.0, 0.02, 0.0));
    rig.move_to(turned, 100);
    // Four points at 28 mm, each with a quarter of 1000 N/m: 0.8 N m/rad.
    CHECK(rig.proxy.wrench().moment_nm.y == doctest::Approx(-0.02 * 0.0008 * 1000.0).epsilon(0.1));
    turned.rotation = rotation_exp(Vec3(0.0, 0.3, 0.0));
    rig.move_to(turned, 300);
    const double most_nm = 0.5 * 4.0 * std::sqrt(0.0008);
    CHECK(rig.proxy.wrench().moment_nm.y == doctest::Approx(-most_nm).epsilon(0.1));
}

TEST_CASE("proxy: nothing is passed by throws, and force rises to the end") {
    std::mt19937_64 random(11);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    for (int round = 0; round < 200; ++round) {
        ProxyRig rig;
        rig.add_tool(make_pad(0.012, 0.003, 0.001));
        const double thickness_m = 0.001 + 0.019 * 0.5 * (1.0 + uniform(random));
        const double top_m = 0.0;
        rig.add(box(Vec3(0.1, 0.5 * thickness_m, 0.1)),
                {Vec3(0.0, top_m - 0.5 * thickness_m, 0.0), Mat3(1.0)});
        const Vec3 start(0.03 * uniform(random), 0.05, 0.03 * uniform(random));
        ToolPose from = at(start);
        from.rotation = rotation_exp(1.5 * Vec3(uniform(random), uniform(random), uniform(random)));
        rig.start_at(from);
        const double speed_m_s = 0.1 + 1.9 * 0.5 * (1.0 + uniform(random));
        const Vec3 along = glm::normalize(Vec3(0.3 * uniform(random), -1.0, 0.3 * uniform(random)));
        double worst_m = 1.0;
        for (int i = 0; start.y + i * kProxyTick_s * speed_m_s * along.y > -0.05; ++i) {
            rig.device.position_m = start + (i * kProxyTick_s * speed_m_s) * along;
            rig.tick();
            worst_m = std::min(worst_m, rig.proxy.pose().position_m.y - top_m);
        }
        CAPTURE(round);
        CHECK(worst_m > 0.0);
        CHECK(rig.proxy.wrench().force_n.y > 30.0);
    }
}

TEST_CASE("proxy: a plate that moves into a resting tool pushes it along") {
    for (const double speed_m_s : {0.05, 0.2, 0.5, 1.0, 2.0}) {
        for (const double thickness_m : {0.001, 0.005, 0.02}) {
            ProxyRig rig;
            rig.add_tool(make_sphere(0.012));
            ScenePart &plate =
                rig.add(box(Vec3(0.1, 0.5 * thickness_m, 0.1)), {Vec3(0.0, -0.1, 0.0), Mat3(1.0)});
            plate.velocity_m_s.y = speed_m_s;
            rig.start_at(at(Vec3(0.003, 0.0, 0.001)));
            double felt_n = 0.0;
            while (rig.scene.parts[0].at.origin_m.y < 0.04) {
                rig.tick();
                const double above_m = rig.proxy.pose().position_m.y - 0.012 -
                                       (rig.scene.parts[0].at.origin_m.y + 0.5 * thickness_m);
                CHECK(above_m > -1e-4);
                felt_n = rig.proxy.wrench().force_n.y;
            }
            CAPTURE(speed_m_s);
            CAPTURE(thickness_m);
            CHECK(felt_n ==
                  doctest::Approx(1000.0 * (0.04 + 0.012 + 0.5 * thickness_m)).epsilon(0.05));
        }
    }
}

namespace {

struct Slider {
    std::string name;
    ToolResult tool;
    double height_m;
    Mat3 turn;
};

std::vector<Slider> sliders() {
    const Mat3 on_its_rim = rotation_exp(Vec3(0.0, 0.0, 0.5 * std::numbers::pi));
    return {{"ball", make_sphere(0.012), 0.012, Mat3(1.0)},
            {"pad", make_pad(0.012, 0.003, 0.003), 0.003, Mat3(1.0)},
            {"pad on its rim", make_pad(0.012, 0.003, 0.003), 0.012, on_its_rim},
            {"sharp pad on its rim", make_pad(0.012, 0.003, 0.0005), 0.012, on_its_rim},
            {"box", make_tool(*box(Vec3(0.03, 0.01, 0.02))), 0.01, Mat3(1.0)}};
}

// Presses the slider with 4 N on what the rig has at height 0, beginning at this x.
void press(ProxyRig &rig, const Slider &slider, double x_m) {
    rig.add_tool(slider.tool, ToolMount::grip, {Vec3(0.0), slider.turn});
    rig.start_at(at(Vec3(x_m, slider.height_m + 0.002, -0.01)));
    rig.move_to(at(Vec3(x_m, slider.height_m - 0.004, -0.01)), 20);
}

} // namespace

TEST_CASE("proxy: seams between bodies are not felt: no ripple, nothing sideways, no turn") {
    for (const Slider &slider : sliders()) {
        for (const double speed_m_s : {0.1, 0.4}) {
            // Tiles at float32 coordinates lie flush within some 1e-8 m.
            for (const double uneven_m : {0.0, 3e-8}) {
                CAPTURE(slider.name);
                CAPTURE(speed_m_s);
                CAPTURE(uneven_m);
                ProxyRig rig;
                const auto tile = box(Vec3(0.02));
                for (int i = -3; i < 4; ++i) {
                    for (int j = -1; j < 2; ++j) {
                        const Vec3 off_m = uneven_m * Vec3(i % 2, (i + 2 * j) % 3, j % 2);
                        rig.add(tile, {Vec3(0.04 * i + 0.013, -0.02, 0.04 * j + 0.007) + off_m,
                                       Mat3(1.0)});
                    }
                }
                press(rig, slider, -0.06);
                const int ticks = static_cast<int>(0.12 / speed_m_s / kProxyTick_s);
                double off_n = 0.0;
                double turned_nm = 0.0;
                for (int i = 0; i < ticks; ++i) {
                    rig.device.position_m += Vec3(1.0, 0.0, 0.3) * (speed_m_s * kProxyTick_s);
                    rig.tick();
                    const Wrench felt = rig.proxy.wrench();
                    off_n = std::max(off_n, glm::distance(felt.force_n, Vec3(0.0, 4.0, 0.0)));
                    turned_nm = std::max(turned_nm, glm::length(felt.moment_nm));
                }
                CHECK(off_n < 1e-3);
                CHECK(turned_nm < 1e-4);
            }
        }
    }
}

TEST_CASE("proxy: a wall and a step are no seam: a tool that slides on the floor stops there") {
    for (const Slider &slider : sliders()) {
        for (const double step_m : {2e-5, 1e-3, 0.1}) {
            // Beside the floor, or on it.
            for (const double foot_m : {-0.04, 0.0}) {
                CAPTURE(slider.name);
                CAPTURE(step_m);
                CAPTURE(foot_m);
                ProxyRig rig;
                const double floor_end_m = foot_m < 0.0 ? 0.0 : 0.2;
                rig.add(box(Vec3(0.1, 0.02, 0.1)),
                        {Vec3(floor_end_m - 0.1, -0.02, 0.0), Mat3(1.0)});
                const double half_m = 0.5 * (step_m - foot_m);
                rig.add(box(Vec3(0.05, half_m, 0.1)),
                        {Vec3(0.05, foot_m + half_m, 0.0), Mat3(1.0)});
                press(rig, slider, -0.06);
                double most_n = 0.0;
                for (int i = 0; i < 1000; ++i) {
                    rig.device.position_m.x += 1e-4;
                    rig.tick();
                    most_n = std::max(most_n, -rig.proxy.wrench().force_n.x);
                }
                // A round rim climbs a low step.
                const bool is_wall = step_m > slider.height_m;
                CHECK(most_n > (is_wall ? 30.0 : 0.1));
                CHECK((!is_wall || rig.proxy.pose().position_m.x < 0.0));
            }
        }
    }
}

TEST_CASE("proxy: a way round in contact without friction gives back what it took") {
    ProxyRig rig;
    rig.add_tool(make_tool(*box(Vec3(0.05, 0.01, 0.02))));
    rig.add(box(Vec3(0.04, 0.02, 0.04)), {Vec3(0.0, -0.02, 0.0), Mat3(1.0)});
    rig.start_at(at(Vec3(0.0, 0.02, 0.0)));
    rig.move_to(at(Vec3(0.01, 0.006, 0.0)), 200);
    double work_j = 0.0;
    double turned_over_j = 0.0;
    constexpr int kSteps = 4000;
    for (int i = 0; i <= kSteps; ++i) {
        const double turn = 2.0 * std::numbers::pi * i / kSteps;
        const ToolPose before = rig.device;
        rig.device = at(Vec3(0.01 * std::cos(turn), 0.006 + 0.002 * std::sin(2.0 * turn),
                             0.005 * std::sin(turn)));
        rig.device.rotation = rotation_exp(
            Vec3(0.05 * std::sin(turn), 0.1 * std::sin(turn), 0.05 * (std::cos(turn) - 1.0)));
        const Wrench held = rig.proxy.wrench();
        rig.tick();
        const Wrench now = rig.proxy.wrench();
        const Displacement by = between(before, rig.device);
        const double step_j = 0.5 * (glm::dot(held.force_n + now.force_n, by.linear_m) +
                                     glm::dot(held.moment_nm + now.moment_nm, by.angular_rad));
        work_j += step_j;
        turned_over_j += std::abs(step_j);
    }
    CHECK(turned_over_j > 0.01);
    CHECK(std::abs(work_j) < 0.02 * turned_over_j);
}

TEST_CASE("proxy: another shape under the same id is looked at anew") {
    const auto field = [](int cells, double height_m) {
        ShapeDescription description;
        description.kind = ShapeKind::height_map;
        description.columns = cells + 1;
        description.rows = cells + 1;
        description.spacing_x_m = 0.2 / cells;
        description.spacing_z_m = 0.2 / cells;
        description.heights_m.assign(static_cast<std::size_t>((cells + 1) * (cells + 1)),
                                     static_cast<float>(height_m));
        return cook(std::move(description)).shape;
    };
    ProxyRig rig;
    rig.add_tool(make_sphere(0.012));
    rig.add(field(100, 0.0)); // triangle numbers up to 20,000
    rig.start_at(at(Vec3(0.09, 0.02, 0.09)));
    rig.move_to(at(Vec3(0.09, 0.007, 0.09)), 100);
    CHECK(rig.proxy.wrench().force_n.y == doctest::Approx(5.0).epsilon(1e-3));
    const auto coarse = field(4, -0.001);
    rig.keep.push_back(coarse);
    rig.scene.parts[0].shape = coarse.get(); // 32 triangles
    rig.tick();
    rig.tick();
    CHECK(rig.proxy.wrench().force_n.y == doctest::Approx(4.0).epsilon(1e-3));
    ProxyMemory memory;
    CHECK(memory.of(rig.tool.parts[0], rig.scene.parts[0]).slack_m < 0.0);
}

TEST_CASE("proxy: what is not finite pushes nothing, and the proxy waits") {
    ProxyRig rig;
    rig.add_tool(make_sphere(0.012));
    rig.add(cooked_half_space());
    rig.start_at(at(Vec3(0.0, 0.02, 0.0)));
    rig.move_to(at(Vec3(0.0, 0.007, 0.0)), 100);
    const ToolPose waits = rig.proxy.pose();
    rig.device.position_m.x = std::numeric_limits<double>::quiet_NaN();
    rig.tick();
    CHECK(glm::length(rig.proxy.wrench().force_n) == 0.0);
    CHECK(rig.proxy.pose().position_m == waits.position_m);
    rig.device = at(Vec3(0.0, 0.007, 0.0));
    rig.tick();
    CHECK(rig.proxy.wrench().force_n.y == doctest::Approx(5.0).epsilon(1e-3));
}
