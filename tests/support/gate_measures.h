// What passivity_gates measures in one combination of hand, friction, latency and game rate, with the default gains.
#pragma once

#include <cstdio>
#include <numbers>
#include <string>
#include <vector>

#include <glm/geometric.hpp>

#include "support/wall_rig.h"

namespace spidar::test {

inline constexpr double kPlane_n_m = 350.0;
inline constexpr double kPlane_n_s_m = 2.0;
inline constexpr double kDragSpeed_m_s = 0.15;

struct Case {
    HandFirmness hand = HandFirmness::normal;
    double friction_n = 0.0;
    double latency_s = 0.001;
    double game_hz = 60.0;
    std::uint64_t seed = 1;

    [[nodiscard]] const char *hand_name() const {
        const char *const hands[] = {"light", "normal", "firm"};
        return hands[static_cast<int>(hand)];
    }
    [[nodiscard]] std::string name() const {
        char text[96];
        std::snprintf(text, sizeof text, "%s hand, friction %.1f N, latency %.2f ms, game %.0f Hz",
                      hand_name(), friction_n, 1e3 * latency_s, game_hz);
        return text;
    }
};

inline RigSettings rig_for(const Case &one) {
    RigSettings settings;
    settings.plant.firmness = one.hand;
    settings.plant.coulomb_friction_n = one.friction_n;
    settings.latency_s = one.latency_s;
    settings.game_hz = one.game_hz;
    settings.game_jitter = 0.3;
    settings.dropped_frames = 0.02;
    settings.seed = one.seed;
    return settings;
}

inline constexpr double kLost = 1e9; // a rig that faulted fails every gate

// The default gains of all walls; in all seven at once each has its share.
inline std::vector<ContactPlane> default_walls(int dof) {
    // The default stops are stiffer than the plane's equivalent at a pole's end.
    std::vector<ContactPlane> walls = walls_at_rest(dof, kPlane_n_m, kPlane_n_s_m);
    for (ContactPlane &wall : walls) {
        const double share = dof == kAllWalls ? 1.0 / kDofCount : 1.0;
        if (wall.target == ContactTarget::turn_stop) {
            wall.stiffness_n_m = 1.0;
            wall.damping_n_s_m = 0.003;
        } else if (wall.target == ContactTarget::grasp_stop) {
            wall.stiffness_n_m = 0.25;
            wall.damping_n_s_m = 0.00075;
        }
        wall.stiffness_n_m *= share;
        wall.damping_n_s_m *= share;
    }
    return walls;
}

// A coupling to a proxy at rest at home: the default gains, as many stiff DOFs as there are share them, x in full.
inline void give_coupling_at_home(const ServoSnapshot &seen, HapticCommand &command) {
    command.coupling = Coupling();
    command.coupling.dof_mask = kAllDof;
    for (std::size_t i = 0; i < command.coupling.stiffness.size(); ++i) {
        command.coupling.stiffness[i] /= kDofCount;
        command.coupling.damping[i] /= kDofCount;
    }
    command.coupling.stiffness[0] = kPlane_n_m;
    command.coupling.damping[0] = kPlane_n_s_m;
    command.coupling.state_time_s = seen.time_s;
    ++command.coupling_sequence;
}

// Work on the hand in one 2 Hz tap of the walls of `dof`, or of the coupling (-1), worst of four.
inline double tap_work(const Case &one, int dof) {
    HapticRig rig(rig_for(one));
    const bool coupled = dof < 0;
    const std::vector<ContactPlane> walls = default_walls(dof);
    rig.game = [&](const ServoSnapshot &seen, HapticCommand &command) {
        if (coupled) {
            give_coupling_at_home(seen, command);
        } else {
            give_contacts(command, walls);
        }
    };
    constexpr int kTaps = 5;
    constexpr int kParts = 100; // of one tap of half a second
    double worst_j = -1e300;
    for (int t = 0; t < kTaps; ++t) {
        const double before_j = rig.energy_to_hand_j();
        for (int i = 0; i < kParts; ++i) {
            const double part = -std::cos(2.0 * std::numbers::pi * i / kParts);
            rig.hand_to(press_target(coupled ? 0 : dof, dof == kAllWalls ? 0.5 * part : part));
            rig.run(0.5 / kParts);
        }
        if (t > 0) { // the first one is the way in
            worst_j = std::max(worst_j, rig.energy_to_hand_j() - before_j);
        }
    }
    return rig.active() ? worst_j : kLost;
}

inline PressResult press_default(const Case &one, int dof) {
    return press(rig_for(one), default_walls(dof), press_target(dof, dof == kAllWalls ? 0.5 : 1.0));
}

// The coupling, pulled by the hand.
inline PressResult hold_coupling(const Case &one) {
    HapticRig rig(rig_for(one));
    rig.game = give_coupling_at_home;
    rig.hand_to(press_target(0, 0.8));
    rig.run(1.5);
    Dither dither;
    rig.watch = [&dither](const ServoSnapshot &, const PlantTruth &truth) { dither.add(truth); };
    rig.run(1.0);
    return {dither.worst_m(), dither.worst_rad(), rig.active()};
}

// Mean force along the motion that a coupling commands when its proxy is the game's own copy of the grip.
inline double free_drag(const Case &one) {
    HapticRig rig(rig_for(one));
    rig.game = [](const ServoSnapshot &seen, HapticCommand &command) {
        command.coupling = Coupling();
        command.coupling.position_m = seen.grip.pose.position_m;
        command.coupling.rotation = seen.grip.frame.rotation;
        command.coupling.grasp_angle_rad = seen.grip.frame.grasp_angle_rad;
        command.coupling.twist = seen.grip.twist;
        command.coupling.state_time_s = seen.time_s;
        command.coupling.dof_mask = 0b111;
        ++command.coupling_sequence;
    };
    HandTarget target;
    target.position_m.x = -0.06;
    rig.hand_to(target);
    rig.run(0.6);
    double sum_n = 0.0;
    int count = 0;
    constexpr int kParts = 800; // of 1 ms: 0.12 m
    for (int i = 0; i < kParts; ++i) {
        target.position_m.x = -0.06 + 0.001 * kDragSpeed_m_s * i;
        rig.hand_to(target);
        rig.run(0.001);
        if (i > kParts / 4 && i < 3 * kParts / 4) {
            sum_n -= rig.now().requested.force_n.x;
            ++count;
        }
    }
    return rig.active() ? std::abs(sum_n / count) : kLost;
}

// The rms of the asked force's error, of the ideal's rms.
struct ForceError {
    double error_n2 = 0.0;
    double ideal_n2 = 0.0;

    void add(const Vec3 &asked_n, const Vec3 &ideal_n) {
        const Vec3 error_n = asked_n - ideal_n;
        error_n2 += glm::dot(error_n, error_n);
        ideal_n2 += glm::dot(ideal_n, ideal_n);
    }
    [[nodiscard]] double share() const {
        return ideal_n2 > 0.0 ? std::sqrt(error_n2 / ideal_n2) : kLost;
    }
};

// How deep the true grip is in a wall of the default gains, and the damper as depth too.
inline double push_depth(const ContactPlane &wall, const PlantTruth &truth) {
    const double depth_m = wall.offset_m - glm::dot(wall.normal, truth.pose.position_m);
    const double closing_m_s = glm::dot(wall.normal, wall.velocity_m_s - truth.twist.linear_m_s);
    return depth_m > 0.0 ? std::max(0.0, depth_m + kPlane_n_s_m / kPlane_n_m * closing_m_s) : 0.0;
}

// A wall that swings to and fro, or turns about a point 50 mm beside the grip, against a hand that leans on it; the ideal
// is the wall itself, without game, delay and encoders.
inline double moving_wall_error(const Case &one, bool turning) {
    HapticRig rig(rig_for(one));
    constexpr double kPace_rad_s = 2.0 * std::numbers::pi; // 1 Hz
    constexpr double kSwing_m = 0.004;
    constexpr double kTurn_rad = 0.2;
    const auto wall_at = [turning](double t, const Vec3 &grip_m) {
        ContactPlane wall;
        const double s = std::sin(kPace_rad_s * t);
        const double c = kPace_rad_s * std::cos(kPace_rad_s * t);
        if (turning) {
            const double a = kTurn_rad * s;
            wall.normal = Vec3(std::cos(a), std::sin(a), 0.0);
            const Vec3 pivot(0.0, 0.05, 0.0);
            wall.offset_m = glm::dot(wall.normal, pivot);
            const Vec3 foot =
                grip_m + (wall.offset_m - glm::dot(wall.normal, grip_m)) * wall.normal;
            wall.velocity_m_s = glm::cross(Vec3(0.0, 0.0, kTurn_rad * c), foot - pivot);
        } else {
            wall.normal = Vec3(1.0, 0.0, 0.0);
            wall.offset_m = kSwing_m * s;
            wall.velocity_m_s.x = kSwing_m * c;
        }
        return wall;
    };
    rig.game = [&wall_at](const ServoSnapshot &seen, HapticCommand &command) {
        give_contacts(command, {wall_at(seen.time_s, seen.grip.pose.position_m)});
    };
    HandTarget target;
    target.position_m.x = turning ? -0.025 : -0.02;
    rig.hand_to(target);
    rig.run(1.0);
    ForceError error;
    rig.watch = [&](const ServoSnapshot &now, const PlantTruth &truth) {
        const ContactPlane wall = wall_at(now.time_s, truth.pose.position_m);
        error.add(now.requested.force_n, kPlane_n_m * push_depth(wall, truth) * wall.normal);
    };
    rig.run(2.0);
    return rig.active() ? error.share() : kLost;
}

// A hand that slides from one wall into the edge with another and on along that one; the ideal is the nearest point
// that both allow.
inline double edge_error(const Case &one) {
    HapticRig rig(rig_for(one));
    constexpr double kBetween_rad = 60.0 * std::numbers::pi / 180.0; // of the normals
    std::vector<ContactPlane> walls(2);
    walls[0].normal = Vec3(1.0, 0.0, 0.0);
    walls[1].normal = Vec3(std::cos(kBetween_rad), std::sin(kBetween_rad), 0.0);
    walls[1].id = 1;
    rig.game = [&walls](const ServoSnapshot &, HapticCommand &command) {
        give_contacts(command, walls);
    };
    constexpr double kPress_m = 0.02;
    const auto push_towards = [&rig](double angle_rad) {
        HandTarget target;
        target.position_m = -kPress_m * Vec3(std::cos(angle_rad), std::sin(angle_rad), 0.0);
        rig.hand_to(target);
    };
    // From 40 degrees beside the first normal to 40 beside the second: alone, both, alone.
    constexpr double kBeside_rad = 40.0 * std::numbers::pi / 180.0;
    push_towards(-kBeside_rad);
    rig.run(1.0);
    ForceError error;
    rig.watch = [&](const ServoSnapshot &now, const PlantTruth &truth) {
        const double a = push_depth(walls[0], truth);
        const double b = push_depth(walls[1], truth);
        const double c = glm::dot(walls[0].normal, walls[1].normal);
        // Of two one-sided springs in series with one point: both, unless one would have to pull.
        double first = (a - c * b) / (1.0 - c * c);
        double second = (b - c * a) / (1.0 - c * c);
        if (first < 0.0) {
            first = 0.0;
            second = b;
        } else if (second < 0.0) {
            first = a;
            second = 0.0;
        }
        error.add(now.requested.force_n,
                  kPlane_n_m * (first * walls[0].normal + second * walls[1].normal));
    };
    constexpr int kParts = 2000; // of 1 ms
    for (int i = 0; i < kParts; ++i) {
        push_towards(-kBeside_rad + (kBetween_rad + 2.0 * kBeside_rad) * i / kParts);
        rig.run(0.001);
    }
    return rig.active() ? error.share() : kLost;
}

// Force that the hand feels on one contact at the centre against four at the pole ends of the same plane.
inline double coplanar_difference(const Case &one) {
    double felt_n[2] = {0.0, 0.0};
    for (int round = 0; round < 2; ++round) {
        HapticRig rig(rig_for(one));
        std::vector<ContactPlane> walls;
        for (int i = round == 0 ? 0 : 1; i <= (round == 0 ? 0 : 4); ++i) {
            ContactPlane wall;
            wall.normal = Vec3(0.0, 0.0, 1.0);
            wall.target = static_cast<ContactTarget>(i);
            wall.id = i;
            walls.push_back(wall);
        }
        rig.game = [&walls](const ServoSnapshot &, HapticCommand &command) {
            give_contacts(command, walls);
        };
        rig.hand_to(press_target(2, 1.0));
        rig.run(1.5);
        double sum_n = 0.0;
        int count = 0;
        rig.watch = [&](const ServoSnapshot &, const PlantTruth &truth) {
            sum_n += truth.strings.force_n.z;
            ++count;
        };
        rig.run(0.5);
        felt_n[round] = rig.active() && count > 0 ? sum_n / count : 0.0;
    }
    return felt_n[0] > 0.0 && felt_n[1] > 0.0 ? std::abs(felt_n[1] / felt_n[0] - 1.0) : kLost;
}

} // namespace spidar::test
