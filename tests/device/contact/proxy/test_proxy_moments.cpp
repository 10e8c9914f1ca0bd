// What the hand feels of one touch anywhere, in seven DOF: the answer of springs in series. A point that gives way by C = J K^-1 J^T
// pushes with depth / C, and its wrench is J^T times that.
#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <string>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "core/geometry/rotation_log.h"
#include "device/contract/dof_lanes.h"
#include "support/case_random.h"
#include "support/proxy_rig.h"
#include "support/shape_samples.h"

using namespace spidar;
using namespace spidar::test;

namespace {

// So that an edge that slides on it by what the springs give turns the normal little.
constexpr double kBallRadius_m = 0.05;
constexpr double kDepth_m = 0.0005;
constexpr double kSame = 0.05;

// A point of the tool and the way out of it there, in the grip's frame.
struct Touched {
    std::size_t part = 0;
    Vec3 point_m{0.0};
    Vec3 out{0.0};
};

// How far the point moves along -out per unit of each DOF: by differences of where the part is, not by the code under test.
DofLanes jacobian(const ProxyRig &rig, const Touched &touched, const ToolPose &pose) {
    const ToolPart &part = rig.tool.parts[touched.part];
    const Placement now = placement_of(part, rig.tool.jaws, pose);
    const Vec3 point_m = pose.position_m + pose.rotation * touched.point_m;
    const Vec3 local_m = glm::transpose(now.rotation) * (point_m - now.origin_m);
    DofLanes row{};
    for (std::size_t dof = 0; dof < 7; ++dof) {
        constexpr double kStep = 1e-6;
        DofLanes step{};
        step[dof] = kStep;
        const Placement then =
            placement_of(part, rig.tool.jaws, moved(pose, of_lanes<Displacement>(step)));
        const Vec3 by_m = then.origin_m + then.rotation * local_m - point_m;
        row[dof] = glm::dot(by_m, -(pose.rotation * touched.out)) / kStep;
    }
    return row;
}

// A ball stands where it touches the tool; the hand moves against it.
void check_touch(ProxyRig &rig, const Touched &touched, const ToolPose &start) {
    const Vec3 out = start.rotation * touched.out;
    rig.add(round_shape(ShapeKind::sphere, kBallRadius_m),
            {start.position_m + start.rotation * touched.point_m + kBallRadius_m * out, Mat3(1.0)});
    ToolPose apart = start;
    apart.position_m -= 0.001 * out;
    ToolPose pressed = start;
    pressed.position_m += kDepth_m * out;
    rig.start_at(apart);
    rig.move_to(pressed, 40);

    const DofLanes row = jacobian(rig, touched, start);
    double gives_m_n = 0.0;
    for (std::size_t dof = 0; dof < 7; ++dof) {
        gives_m_n += row[dof] * row[dof] / rig.settings.stiffness[dof];
    }
    const double push_n = kDepth_m / gives_m_n;
    DofLanes due{};
    for (std::size_t dof = 0; dof < 7; ++dof) {
        due[dof] = push_n * row[dof];
    }
    const auto expected = of_lanes<Wrench>(due);
    const Wrench &felt = rig.proxy.wrench();
    CHECK(glm::distance(felt.force_n, expected.force_n) < kSame * push_n);
    CHECK(glm::distance(felt.moment_nm, expected.moment_nm) <
          kSame * glm::length(expected.moment_nm) + 1e-4);
    CHECK(std::abs(felt.grasp_torque_nm - expected.grasp_torque_nm) <
          kSame * std::abs(expected.grasp_torque_nm) + 2e-4);
}

ToolPose random_pose(CaseRandom &random) {
    ToolPose pose;
    pose.position_m = random.vector(0.05);
    pose.rotation = rotation_exp(random.vector(1.5));
    return pose;
}

} // namespace

TEST_CASE("moments: a held bar of 10 to 30 cm, pressed on any face, edge and corner") {
    CaseRandom random(31, 0);
    for (int round = 0; round < 300; ++round) {
        const int faces =
            1 + round % 3; // that meet where it is touched: 1 a face, 2 an edge, 3 a corner
        const Vec3 half_m(random.between(0.05, 0.15), random.between(0.005, 0.02),
                          random.between(0.005, 0.02));
        const Vec3 middle_m(random.between(-0.8, 0.8) * half_m.x, 0.0, 0.0); // it is held anywhere
        ProxyRig rig;
        rig.add_tool(make_tool(*box(half_m)), ToolMount::grip, {middle_m, Mat3(1.0)});
        Touched touched;
        const int first = static_cast<int>(random.bits() % 3);
        for (int axis = 0; axis < 3; ++axis) {
            const bool at_face = (axis - first + 3) % 3 < faces;
            const double side = random.bits() % 2 == 0 ? 1.0 : -1.0;
            touched.point_m[axis] =
                (half_m[axis] - kDefaultSkin_m) * (at_face ? side : random.between(-0.9, 0.9)) +
                middle_m[axis];
            touched.out[axis] = at_face ? side * random.between(0.5, 1.0) : 0.0;
        }
        touched.out = glm::normalize(touched.out);
        touched.point_m += kDefaultSkin_m * touched.out; // its edges are rounded by that
        CAPTURE(round);
        check_touch(rig, touched, random_pose(random));
    }
}

TEST_CASE(
    "moments: a pad of an open grip, pressed on its outer face and its rim: grasp torque too") {
    CaseRandom random(32, 0);
    constexpr double kRadius_m = 0.012;
    constexpr double kThick_m = 0.006;
    for (int round = 0; round < 300; ++round) {
        ProxyRig rig;
        const Mat3 axis_along_x = rotation_exp(Vec3(0.0, 0.0, -0.5 * std::numbers::pi));
        for (const double side : {-1.0, 1.0}) {
            rig.add_tool(make_pad(kRadius_m, 0.5 * kThick_m, 0.5 * kThick_m),
                         side < 0.0 ? ToolMount::jaw_minus : ToolMount::jaw_plus,
                         {Vec3(0.5 * side * kThick_m, 0.0, 0.0), axis_along_x});
        }
        ToolPose start = random_pose(random);
        start.grasp_rad = random.between(0.0, 0.6);
        Touched touched;
        touched.part = random.bits() % 2;
        const double side = touched.part == 0 ? -1.0 : 1.0;
        const double inner_m = 0.5 * rig.tool.jaws.gap_m(start.grasp_rad);
        const double angle_rad = random.between(0.0, 2.0 * std::numbers::pi);
        const Vec3 radial(0.0, std::cos(angle_rad), std::sin(angle_rad));
        const bool on_rim = round % 2 == 0;
        touched.out = on_rim ? radial : Vec3(side, 0.0, 0.0);
        touched.point_m = Vec3(side * (inner_m + (on_rim ? 0.5 : 1.0) * kThick_m), 0.0, 0.0) +
                          (on_rim ? kRadius_m : random.between(0.0, 0.008)) * radial;
        CAPTURE(round);
        CAPTURE(on_rim);
        check_touch(rig, touched, start);
    }
}

TEST_CASE(
    "moments: a key in a slot with 1 mm of play turns freely as far as that, and then stiffly") {
    constexpr Vec3 kHalf_m(0.02, 0.01, 0.003);
    constexpr double kPlay_m = 0.001;
    for (int axis = 0; axis < 3; ++axis) {
        for (const double sign : {-1.0, 1.0}) {
            ProxyRig rig;
            rig.add_tool(make_tool(*box(kHalf_m)));
            for (const double side : {-1.0, 1.0}) {
                rig.add(box(Vec3(0.1, 0.1, 0.02)),
                        {Vec3(0.0, 0.0, side * (kHalf_m.z + 0.5 * kPlay_m + 0.02)), Mat3(1.0)});
            }
            ToolPose turned;
            constexpr double kTurn_rad = 0.15;
            Vec3 turn_rad(0.0);
            turn_rad[axis] = sign * kTurn_rad;
            turned.rotation = rotation_exp(turn_rad);
            rig.start_at(ToolPose());
            rig.move_to(turned, 200);
            // Where two corners touch: reach * sin(turn) + half thickness * cos(turn) = half the slot, each less the skin.
            const double reach_m = (axis == 0   ? kHalf_m.y
                                    : axis == 1 ? kHalf_m.x
                                                : 0.0) -
                                   kDefaultSkin_m;
            const double thick_m = kHalf_m.z - kDefaultSkin_m;
            const double slot_m = thick_m + 0.5 * kPlay_m;
            const double free_rad = axis < 2 ? std::asin(slot_m / std::hypot(reach_m, thick_m)) -
                                                   std::atan2(thick_m, reach_m)
                                             : kTurn_rad;
            const double due_nm = -sign * rig.settings.stiffness[3] * (kTurn_rad - free_rad);
            CAPTURE(axis);
            CAPTURE(sign);
            CHECK(rig.proxy.wrench().moment_nm[axis] ==
                  doctest::Approx(due_nm).epsilon(0.01).scale(1e-3));
            CHECK(glm::length(rig.proxy.wrench().force_n) < 0.02);
        }
    }
}
