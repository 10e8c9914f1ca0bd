// Walls of real shapes pressed and tapped by the simulated hand: what passivity_gates measures of scenes.
#pragma once

#include "support/gate_measures.h"
#include "support/touch_scenes.h"

namespace spidar::test {

// What a hand presses, each with an automatic stiffness: a face of four corners on a floor, the end of a bar on a floor, a box
// between the pads, a peg that fills a hole; a face on a floor with all that a material can have, on which the hand also
// slides, and a door on a hinge with a spring and a limit.
enum class TouchWall { face, bar, width, peg, material, door };
inline constexpr int kStiffWalls = 4; // those that have a limit of their stiffness
inline constexpr int kTouchWalls = 6;

inline constexpr double kFloor_m = -0.01; // below the grip's centre

inline Mat3 turned_about_z(double angle_rad) {
    return glm::mat3_cast(glm::angleAxis(angle_rad, Vec3(0.0, 0.0, 1.0)));
}

// Along the grip's x axis: a pad's disc has its axis along its own y.
inline Placement pad_placement(double outward) {
    return {Vec3(0.003 * outward, 0.0, 0.0), turned_about_z(-1.5707963267948966)};
}

inline void add_pads(TouchScene &touch) {
    add_tool(touch, make_pad(0.012, 0.003, 0.003), ToolMount::jaw_minus, pad_placement(-1.0));
    add_tool(touch, make_pad(0.012, 0.003, 0.003), ToolMount::jaw_plus, pad_placement(1.0));
}

inline ToolResult box_tool(const Vec3 &half_extents_m) {
    return make_tool(*box(half_extents_m));
}

inline TouchScene scene_of(TouchWall wall) {
    TouchScene touch;
    switch (wall) {
    case TouchWall::face:
        add_tool(touch, box_tool({0.03, 0.01, 0.02}));
        add(touch, cooked_half_space(), {Vec3(0.0, kFloor_m, 0.0), Mat3(1.0)});
        break;
    case TouchWall::bar:
        add_tool(touch, box_tool({0.1, 0.01, 0.01}));
        add(touch, cooked_half_space(), {Vec3(0.0, kFloor_m, 0.0), Mat3(1.0)});
        break;
    case TouchWall::width:
        add_pads(touch);
        add(touch, box({0.04, 0.03, 0.03}));
        break;
    case TouchWall::peg: {
        add_tool(touch, box_tool({0.01, 0.03, 0.01}));
        constexpr double kThick_m = 0.02;
        constexpr double kHole_m = 0.0105;
        const auto block = box({kThick_m, 0.05, 0.06});
        const auto other = box({0.06, 0.05, kThick_m});
        add(touch, block, {Vec3(kHole_m + kThick_m, 0.0, 0.0), Mat3(1.0)});
        add(touch, block, {Vec3(-kHole_m - kThick_m, 0.0, 0.0), Mat3(1.0)});
        add(touch, other, {Vec3(0.0, 0.0, kHole_m + kThick_m), Mat3(1.0)});
        add(touch, other, {Vec3(0.0, 0.0, -kHole_m - kThick_m), Mat3(1.0)});
        add(touch, cooked_half_space(), {Vec3(0.0, -0.03, 0.0), Mat3(1.0)});
        break;
    }
    case TouchWall::material: {
        add_tool(touch, box_tool({0.03, 0.01, 0.02}));
        ScenePart &floor = add(touch, cooked_half_space(), {Vec3(0.0, kFloor_m, 0.0), Mat3(1.0)});
        floor.friction = 0.3;
        // Without stick-slip, which creaks under a hand that pulls: by itself that is no dither.
        floor.traits = {0.8, false, 0.5, 0.5, 0.005, {0.003, 0.0002, Vec3(0.0)}};
        break;
    }
    case TouchWall::door: {
        add_tool(touch, box_tool({0.01, 0.02, 0.01}));
        ToolJoint &joint = touch.tool.joints[0];
        joint.id = 1;
        joint.base.origin_m = Vec3(-0.08, 0.0, 0.0);
        joint.in_grip.origin_m = Vec3(-0.08, 0.0, 0.0);
        joint.axes[4] = {-0.1, 0.1, 0.5};
        touch.tool.joint_count = 1;
        break;
    }
    }
    return touch;
}

// Behind the wall by this part of a usual press.
inline HandTarget touch_target(TouchWall wall, double part) {
    HandTarget target;
    switch (wall) {
    case TouchWall::face:
        target.position_m.y = -0.01 * part;
        break;
    case TouchWall::bar:
        target.position_m.y = -0.002 * part;
        target.rotation = turned_about_z(-0.15 * part);
        break;
    case TouchWall::width:
        target.grasp_angle_rad = 0.3 * part;
        break;
    case TouchWall::peg:
        target.position_m = Vec3(0.004, -0.008, 0.003) * part;
        target.rotation = turned_about_z(0.1 * part);
        break;
    case TouchWall::material:
        target.position_m = Vec3(0.006, -0.004, 0.004) * part;
        break;
    case TouchWall::door:
        // Past its limit, and out of its hinge.
        target.position_m = Vec3(0.0015, 0.001, -0.011) * part;
        target.rotation = glm::mat3_cast(glm::angleAxis(0.14 * part, Vec3(0.0, 1.0, 0.0)));
        break;
    }
    return target;
}

inline double touch_tap_work(const Case &one, TouchWall wall) {
    HapticRig rig(rig_for(one));
    TouchGame scene(scene_of(wall));
    rig.game = [&scene](const ServoSnapshot &seen, HapticCommand &command) {
        scene.publish(seen, command);
    };
    constexpr int kTaps = 5;
    constexpr int kParts = 100; // of one tap of half a second
    double worst_j = -1e300;
    for (int t = 0; t < kTaps; ++t) {
        const double before_j = rig.energy_to_hand_j();
        for (int i = 0; i < kParts; ++i) {
            const double part = -std::cos(2.0 * std::numbers::pi * i / kParts);
            rig.hand_to(touch_target(wall, part));
            rig.run(0.5 / kParts);
        }
        if (t > 0) { // the first one is the way in
            worst_j = std::max(worst_j, rig.energy_to_hand_j() - before_j);
        }
    }
    return rig.active() ? worst_j : kLost;
}

inline PressResult touch_press(const RigSettings &settings, const TouchScene &touch,
                               const HandTarget &target) {
    HapticRig rig(settings);
    TouchGame scene(touch);
    rig.game = [&scene](const ServoSnapshot &seen, HapticCommand &command) {
        scene.publish(seen, command);
    };
    rig.run(0.05);
    rig.hand_to(target);
    rig.run(1.5);
    Dither dither;
    rig.watch = [&dither](const ServoSnapshot &, const PlantTruth &truth) { dither.add(truth); };
    if (rig.active()) {
        rig.run(1.0);
    }
    return {dither.worst_m(), dither.worst_rad(), rig.active()};
}

// Force for the depth that the encoders tell, on a face of four corners against that on a ball.
inline double touch_face_difference(const Case &one) {
    double felt_n_m[2] = {0.0, 0.0};
    for (int round = 0; round < 2; ++round) {
        HapticRig rig(rig_for(one));
        TouchScene touch = scene_of(TouchWall::face);
        if (round == 1) {
            touch.tool.count = 0;
            add_tool(touch, make_sphere(-kFloor_m));
        }
        TouchGame scene(std::move(touch));
        rig.game = [&scene](const ServoSnapshot &seen, HapticCommand &command) {
            scene.publish(seen, command);
        };
        rig.hand_to(touch_target(TouchWall::face, 3.0));
        rig.run(1.5);
        double sum_n = 0.0;
        double depth_m = 0.0;
        rig.watch = [&](const ServoSnapshot &now, const PlantTruth &) {
            sum_n += now.requested.force_n.y;
            depth_m -= now.grip.pose.position_m.y;
        };
        rig.run(0.5);
        felt_n_m[round] = rig.active() && depth_m > 0.0 ? sum_n / depth_m : 0.0;
    }
    return felt_n_m[0] > 0.0 && felt_n_m[1] > 0.0 ? std::abs(felt_n_m[0] / felt_n_m[1] - 1.0)
                                                  : kLost;
}

// A floor that swings to and fro under a hand that leans on it; the ideal is the floor itself.
inline double touch_moving_error(const Case &one) {
    HapticRig rig(rig_for(one));
    constexpr double kPace_rad_s = 2.0 * std::numbers::pi; // 1 Hz
    constexpr double kSwing_m = 0.004;
    constexpr double kStiffness_n_m = kPlane_n_m;
    TouchScene touch = scene_of(TouchWall::face);
    touch.tool.count = 0;
    add_tool(touch, make_sphere(-kFloor_m));
    for (std::size_t dof = 0; dof < 3; ++dof) {
        touch.stiffness[dof] = kStiffness_n_m;
    }
    TouchGame scene(std::move(touch));
    rig.game = [&](const ServoSnapshot &seen, HapticCommand &command) {
        ScenePart &floor = scene.scene.scene.parts[0];
        floor.at.origin_m.y = kFloor_m + kSwing_m * std::sin(kPace_rad_s * seen.time_s);
        floor.velocity_m_s.y = kSwing_m * kPace_rad_s * std::cos(kPace_rad_s * seen.time_s);
        scene.publish(seen, command);
    };
    HandTarget target;
    target.position_m.y = -0.02;
    rig.hand_to(target);
    rig.run(1.0);
    ForceError error;
    rig.watch = [&](const ServoSnapshot &now, const PlantTruth &truth) {
        const double depth_m =
            kSwing_m * std::sin(kPace_rad_s * now.time_s) - truth.pose.position_m.y;
        const double closing_m_s =
            kSwing_m * kPace_rad_s * std::cos(kPace_rad_s * now.time_s) - truth.twist.linear_m_s.y;
        const double ideal_n =
            depth_m > 0.0 ? std::max(0.0, kStiffness_n_m * depth_m + 2.0 * closing_m_s) : 0.0;
        error.add(now.requested.force_n, Vec3(0.0, ideal_n, 0.0));
    };
    rig.run(2.0);
    return rig.active() ? error.share() : kLost;
}

} // namespace spidar::test
