// Walls pressed and tapped by the simulated hand: what the stiffness limits and the passivity gates measure.
#pragma once

#include <array>
#include <vector>

#include <glm/gtc/quaternion.hpp>

#include "support/haptic_rig.h"

namespace spidar::test {

// A wall in one DOF (0-6: x, y, z, turns about x, y, z, grasp) or in all seven.
inline constexpr int kAllWalls = 7;

// Stiffness of a wall in N/m; of turns and grasp as the same wall would have at the pole's end, in N m/rad.
inline double turn_of(double stiffness_n_m) {
    return stiffness_n_m * kPaperPoleHalfLength_m * kPaperPoleHalfLength_m;
}
inline double grasp_of(double stiffness_n_m) {
    return 0.25 * turn_of(stiffness_n_m); // grasp_angle turns each pole by half
}

inline std::vector<ContactPlane> walls_at_rest(int dof, double stiffness_n_m,
                                               double damping_n_s_m) {
    std::vector<ContactPlane> walls;
    for (int i = 0; i < kDofCount; ++i) {
        if (dof != i && dof != kAllWalls) {
            continue;
        }
        ContactPlane wall;
        wall.id = i;
        wall.normal = Vec3(0.0);
        wall.stiffness_n_m = stiffness_n_m;
        wall.damping_n_s_m = damping_n_s_m;
        if (i < 3) {
            wall.normal[i] = 1.0;
        } else if (i < 6) {
            wall.target = ContactTarget::turn_stop;
            wall.normal[i - 3] = 1.0;
            wall.stiffness_n_m = turn_of(stiffness_n_m);
            wall.damping_n_s_m = turn_of(damping_n_s_m);
        } else {
            wall.target = ContactTarget::grasp_stop;
            wall.normal.x = 1.0;
            wall.stiffness_n_m = grasp_of(stiffness_n_m);
            wall.damping_n_s_m = grasp_of(damping_n_s_m);
        }
        walls.push_back(wall);
    }
    return walls;
}

// Where a hand presses these walls: behind each by this much of a usual press (10 mm, 0.15 rad, 0.3 rad of grasp).
inline HandTarget press_target(int dof, double part) {
    HandTarget target;
    for (int i = 0; i < kDofCount; ++i) {
        if (dof != i && dof != kAllWalls) {
            continue;
        }
        if (i < 3) {
            target.position_m[i] = -0.01 * part;
        } else if (i < 6) {
            Vec3 axis(0.0);
            axis[i - 3] = 1.0;
            target.rotation = glm::mat3_cast(glm::angleAxis(-0.15 * part, axis)) * target.rotation;
        } else {
            target.grasp_angle_rad = -0.3 * part;
        }
    }
    return target;
}

// Peak-to-peak motion of the true grip.
struct Dither {
    std::array<Extent, 3> position_m;
    std::array<Extent, 3> turn_rad;
    Extent grasp_rad;

    void add(const PlantTruth &truth) {
        const Mat3 &r = truth.frame.rotation;
        for (int k = 0; k < 3; ++k) {
            const auto i = static_cast<std::size_t>(k);
            position_m[i].add(truth.pose.position_m[k]);
            turn_rad[i].add(0.5 * (r[(k + 1) % 3][(k + 2) % 3] - r[(k + 2) % 3][(k + 1) % 3]));
        }
        grasp_rad.add(truth.frame.grasp_angle_rad);
    }
    [[nodiscard]] double worst_m() const {
        return std::max({position_m[0].size(), position_m[1].size(), position_m[2].size()});
    }
    [[nodiscard]] double worst_rad() const {
        return std::max(
            {turn_rad[0].size(), turn_rad[1].size(), turn_rad[2].size(), grasp_rad.size()});
    }
};

struct PressResult {
    double dither_m = 0.0;
    double dither_rad = 0.0;
    bool active = false; // no fault, no diverged physics
};

// Presses for 1.5 s, then watches for a second.
inline PressResult press(const RigSettings &settings, const std::vector<ContactPlane> &walls,
                         const HandTarget &target) {
    HapticRig rig(settings);
    rig.game = [&walls](const ServoSnapshot &, HapticCommand &command) {
        give_contacts(command, walls);
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

// Nothing but the renderer's own limits: what is stable, not what is allowed.
inline void lift_caps(RenderSettings &render) {
    render.caps_from_latency = false;
    render.max_stiffness_n_m = 1e5;
    render.max_turn_stiffness_nm_rad = 1e3;
    render.max_grasp_stiffness_nm_rad = 1e3;
    render.max_damping_n_s_m = 1e3;
    render.max_turn_damping_nm_s_rad = 10.0;
    render.max_grasp_damping_nm_s_rad = 10.0;
}

// As it was before the motion filter: pose as measured, velocity by a 60 Hz filter, no look ahead.
inline RenderSettings plain_spring_damper() {
    RenderSettings render;
    render.string_resonance_hz = 0.0;
    render.velocity_cutoff_hz = 60.0;
    render.delay_compensation_s = 0.0;
    return render;
}

} // namespace spidar::test
