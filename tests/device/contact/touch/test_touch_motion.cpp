// Defining equations of the proxy under any scene, and what must hold however hand and scene move: nothing is passed.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "core/geometry/rotation_log.h"
#include "device/contract/dof_lanes.h"
#include "support/case_random.h"
#include "support/touch_gates.h"
#include "support/touch_rig.h"

using namespace spidar;
using namespace spidar::test;

namespace {

Vec3 unit(CaseRandom &random) {
    const Vec3 v = random.vector(1.0) + Vec3(1e-9);
    return v / glm::length(v);
}

} // namespace

TEST_CASE("touch: at rest the springs pull with what the contacts push, none pulls, and none is "
          "entered") {
    CaseRandom random(21, 0);
    int touching = 0;
    for (int round = 0; round < 150; ++round) {
        CAPTURE(round);
        TouchRig rig;
        TouchScene touch;
        touch.damping_n_s_m = 0.0;
        if (round % 2 == 0) {
            add_pads(touch);
        }
        if (round % 3 != 0) {
            ToolPart &bar = add_tool(touch, box_tool({random.between(0.03, 0.15), 0.01, 0.008}));
            bar.at = {random.vector(0.01), rotation_exp(random.vector(0.5))};
        } else {
            add_tool(touch, make_sphere(0.015));
        }
        const int walls = 1 + static_cast<int>(random.bits() % 4);
        for (int i = 0; i < walls; ++i) {
            const Vec3 normal = unit(random);
            // A half space's surface is at its origin, its normal +y.
            const Vec3 axis = glm::cross(Vec3(0.0, 1.0, 0.0), normal);
            const double angle = std::atan2(glm::length(axis), normal.y);
            add(touch, cooked_half_space(),
                {-0.08 * normal, rotation_exp(angle / glm::length(axis) * axis)});
        }
        add(touch, box({0.05, 0.02, 0.03}),
            {Vec3(0.0, -0.08, 0.0), rotation_exp(random.vector(1.0))});
        rig.give(touch);
        rig.tick();
        // Into something, slowly enough for a hand, then still.
        const Vec3 way_m = 0.08 * unit(random);
        const Vec3 turn_rad = 0.3 * unit(random);
        for (int i = 1; i <= 300; ++i) {
            const double part = std::min(1.0, i / 200.0);
            rig.motion.grip.pose.position_m = part * way_m;
            rig.motion.grip.frame.rotation = rotation_exp(part * turn_rad);
            rig.motion.grip.frame.grasp_angle_rad = part * 0.5;
            if (i % 16 == 0) {
                rig.give(touch);
            }
            rig.tick();
        }
        const TouchReport told = rig.report();
        const ToolPose proxy{told.position_m, told.rotation, told.grasp_rad};
        const DofLanes pull = lanes(between(rig.device(), proxy));
        const DofLanes felt = lanes(told.wrench);
        for (std::size_t dof = 0; dof < pull.size(); ++dof) {
            const double size = dof < 3 ? 0.02 : dof < 6 ? 0.002 : 0.0005;
            CHECK(std::abs(told.stiffness[dof] * pull[dof] - felt[dof]) <
                  size + 0.02 * std::abs(felt[dof]));
        }
        double power = 0.0;
        for (int i = 0; i < told.point_count; ++i) {
            const TouchPointReport &point = told.points[static_cast<std::size_t>(i)];
            const double push_n = glm::dot(point.force_n, point.normal);
            CHECK(push_n >= 0.0);
            CHECK(point.gap_m > -2e-6);
            CHECK(push_n * point.gap_m < 2e-6); // N m: what does not touch does not push
            touching += push_n > 0.0 ? 1 : 0;
            power += push_n;
        }
        CHECK(std::isfinite(power));
    }
    CHECK(touching > 100);
}

TEST_CASE(
    "touch: a plate that moves into a resting hand never passes it, whatever the game's rate") {
    CaseRandom random(22, 0);
    for (int round = 0; round < 1000; ++round) {
        CAPTURE(round);
        TouchRig rig;
        TouchScene touch;
        add_pads(touch);
        const double half_m = random.between(0.0005, 0.01);
        ScenePart &plate = add(touch, box({0.15, half_m, 0.15}));
        const double speed_m_s = random.between(0.05, 2.0);
        const int ticks =
            4 + static_cast<int>(random.bits() % 30); // of the servo loop in a frame: 240 to 30 Hz
        plate.velocity_m_s.y = speed_m_s;
        rig.motion.grip.frame.rotation = rotation_exp(random.vector(1.0));
        constexpr double kStart_m = -0.06;
        double entered_m = 0.0;
        for (int i = 0; kStart_m + speed_m_s * rig.time_s < 0.03; ++i) {
            if (i % ticks == 0) {
                plate.at.origin_m.y = kStart_m + speed_m_s * rig.time_s;
                rig.give(touch);
            }
            const Wrench wrench = rig.tick();
            const double top_m = kStart_m + speed_m_s * rig.time_s + half_m;
            const TouchReport told = rig.report();
            // The pads' middle is above the plate, and once it was reached it pushes up.
            for (int p = 0; p < told.point_count; ++p) {
                CHECK(told.points[static_cast<std::size_t>(p)].gap_m > -1e-5);
            }
            entered_m = std::max(entered_m, top_m - told.position_m.y - 0.003);
            if (top_m > 0.0) {
                CHECK(wrench.force_n.y > 0.0);
            }
        }
        CHECK(entered_m < 0.001);
    }
}

TEST_CASE("touch: thrown and pressed 50 mm deep at plates, meshes, corners and slots, a hand "
          "passes nothing") {
    CaseRandom random(23, 0);
    const auto sheet = [](bool two_sided) {
        // A flat mesh of 20 mm triangles, front up.
        ShapeDescription mesh;
        mesh.kind = ShapeKind::mesh;
        mesh.two_sided = two_sided;
        constexpr int kCells = 10;
        constexpr double kCell_m = 0.02;
        for (int z = 0; z <= kCells; ++z) {
            for (int x = 0; x <= kCells; ++x) {
                mesh.points_m.emplace_back((x - 5) * kCell_m, 0.0, (z - 5) * kCell_m);
            }
        }
        for (int z = 0; z < kCells; ++z) {
            for (int x = 0; x < kCells; ++x) {
                const auto a = static_cast<std::uint32_t>(z * (kCells + 1) + x);
                const std::uint32_t b = a + 1;
                const std::uint32_t c = a + kCells + 1;
                const std::uint32_t d = c + 1;
                for (const std::uint32_t index : {a, c, b, b, c, d}) {
                    mesh.indices.push_back(index);
                }
            }
        }
        return cooked(std::move(mesh));
    };
    const auto one_sided = sheet(false);
    const auto both_sides = sheet(true);
    ShapeDescription field;
    field.kind = ShapeKind::height_map;
    field.columns = 11;
    field.rows = 11;
    field.spacing_x_m = 0.02;
    field.spacing_z_m = 0.02;
    field.heights_m.assign(121, 0.0F);
    const auto map = cooked(std::move(field));
    for (int round = 0; round < 1000; ++round) {
        CAPTURE(round);
        TouchRig rig;
        TouchScene touch;
        add_pads(touch);
        switch (round % 5) {
        case 0: {
            const double half_m = random.between(0.0005, 0.01);
            add(touch, box({0.1, half_m, 0.1}), {Vec3(0.0, -half_m, 0.0), Mat3(1.0)});
            break;
        }
        case 1:
            add(touch, one_sided);
            break;
        case 2:
            add(touch, both_sides);
            break;
        case 3:
            add(touch, map);
            break;
        default: // a corner of three plates
            add(touch, box({0.1, 0.002, 0.1}), {Vec3(0.0, -0.002, 0.0), Mat3(1.0)});
            add(touch, box({0.002, 0.1, 0.1}), {Vec3(-0.102, 0.05, 0.0), Mat3(1.0)});
            add(touch, box({0.1, 0.1, 0.002}), {Vec3(0.0, 0.05, -0.102), Mat3(1.0)});
            break;
        }
        const int frame = 4 + static_cast<int>(random.bits() % 30);
        rig.motion.grip.frame.rotation = rotation_exp(random.vector(1.5));
        rig.motion.grip.frame.grasp_angle_rad =
            random.between(0.5, 0.8); // the pads' middles 5 to 35 mm apart
        const Vec3 start_m(random.between(-0.03, 0.03), 0.06, random.between(-0.03, 0.03));
        const double speed_m_s = random.between(0.1, 2.0);
        const Vec3 along =
            glm::normalize(Vec3(random.between(-0.2, 0.2), -1.0, random.between(-0.2, 0.2)));
        double lowest_m = 1.0;
        double gone_m = 0.0;
        for (int i = 0; start_m.y + gone_m * along.y > -0.05; ++i) {
            gone_m = i * kTick_s * speed_m_s;
            rig.motion.grip.pose.position_m = start_m + gone_m * along;
            if (i % frame == 0) {
                rig.give(touch);
            }
            (void)rig.tick();
            lowest_m = std::min(lowest_m, rig.report().position_m.y);
        }
        CHECK(lowest_m > 0.0);
        // It may still tip over an edge, and then stays.
        double least_n = 1e9;
        double most_n = 0.0;
        for (int i = 0; i < 300; ++i) {
            if (i % frame == 0) {
                rig.give(touch);
            }
            const double push_n = rig.tick().force_n.y;
            least_n = i < 200 ? least_n : std::min(least_n, push_n);
            most_n = i < 200 ? most_n : std::max(most_n, push_n);
        }
        CHECK(least_n > 3.0);
        CHECK(most_n - least_n < 0.02 * most_n);
    }
}
