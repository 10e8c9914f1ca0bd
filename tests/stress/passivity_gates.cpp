// Gates of the default gains in simulated time: three hands, strings without and with friction, three latencies, games
// at 30 to 144 Hz with jitter and dropped frames. In each: the work of a tap, dither while pressing a plane, a turn stop,
// a grasp stop, all seven and a coupling, the drag of a coupling in free space, walls that move and turn, and one or
// four coplanar contacts.
//   passivity_gates [--cases N] [--seed S]     N of the combinations, at random; all of them without --cases
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <numbers>
#include <string>

#include <glm/geometric.hpp>

#include "support/wall_rig.h"

using namespace spidar;
using namespace spidar::test;

namespace {

constexpr double kPlane_n_m = 350.0;
constexpr double kPlane_n_s_m = 2.0;
// Of a tap; above rounding, and far below what a hand feels.
constexpr double kMostWork_j = 1e-5;
constexpr double kStill_m = 0.2e-3;
constexpr double kStill_rad = 0.05 * std::numbers::pi / 180.0;
constexpr double kMostDrag_n = 0.25;
constexpr double kDragSpeed_m_s = 0.15;
constexpr double kSameFeel = 0.05;
// A moving wall's force against the ideal one's, of the ideal one's rms.
constexpr double kWallError = 0.10;
// A normal is not carried on between frames: at 72 degrees a second it lags by up to 5 degrees.
constexpr double kTurningError = 0.20;

struct Case {
    HandFirmness hand = HandFirmness::normal;
    double friction_n = 0.0;
    double latency_s = 0.001;
    double game_hz = 60.0;
    std::uint64_t seed = 1;

    [[nodiscard]] std::string name() const {
        const char *const hands[] = {"light", "normal", "firm"};
        char text[96];
        std::snprintf(text, sizeof text, "%s hand, friction %.1f N, latency %.2f ms, game %.0f Hz",
                      hands[static_cast<int>(hand)], friction_n, 1e3 * latency_s, game_hz);
        return text;
    }
};

RigSettings rig_for(const Case &one) {
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

// The worst of all cases, and where.
struct Gate {
    const char *name;
    double limit;
    const char *unit;
    double scale; // to that unit
    double worst = -1e300;
    std::string where;

    void add(double value, const Case &one) {
        if (!(value <= worst)) { // NaN is worst of all
            worst = value;
            where = one.name();
        }
    }
    [[nodiscard]] bool good() const { return worst <= limit; }
};

constexpr double kLost = 1e9; // a rig that faulted fails every gate

// Work on the hand in one 2 Hz tap, worst of four.
double tap_work(const Case &one) {
    HapticRig rig(rig_for(one));
    const std::vector<ContactPlane> walls = walls_at_rest(0, kPlane_n_m, kPlane_n_s_m);
    rig.game = [&](const ServoSnapshot &, HapticCommand &command) {
        give_contacts(command, walls);
    };
    constexpr int kTaps = 5;
    constexpr int kParts = 100; // of one tap of half a second
    double worst_j = -1e300;
    for (int t = 0; t < kTaps; ++t) {
        const double before_j = rig.energy_to_hand_j();
        for (int i = 0; i < kParts; ++i) {
            HandTarget target;
            target.position_m.x = 0.01 * std::cos(2.0 * std::numbers::pi * i / kParts);
            rig.hand_to(target);
            rig.run(0.5 / kParts);
        }
        if (t > 0) { // the first one is the way in
            worst_j = std::max(worst_j, rig.energy_to_hand_j() - before_j);
        }
    }
    return rig.active() ? worst_j : kLost;
}

PressResult press_default(const Case &one, int dof) {
    // The default stops are stiffer than the plane's equivalent at a pole's end; all seven share by their number.
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
    return press(rig_for(one), walls, press_target(dof, dof == kAllWalls ? 0.5 : 1.0));
}

// A coupling to a proxy at rest, pulled by the hand.
PressResult hold_coupling(const Case &one) {
    HapticRig rig(rig_for(one));
    rig.game = [](const ServoSnapshot &seen, HapticCommand &command) {
        command.coupling = Coupling();
        command.coupling.dof_mask = kAllDof;
        // As many stiff DOFs as there are share the default gains.
        for (std::size_t i = 0; i < command.coupling.stiffness.size(); ++i) {
            command.coupling.stiffness[i] /= kDofCount;
            command.coupling.damping[i] /= kDofCount;
        }
        command.coupling.stiffness[0] = kPlane_n_m;
        command.coupling.damping[0] = kPlane_n_s_m;
        command.coupling.state_time_s = seen.time_s;
        ++command.coupling_sequence;
    };
    rig.hand_to(press_target(0, 0.8));
    rig.run(1.5);
    Dither dither;
    rig.watch = [&dither](const ServoSnapshot &, const PlantTruth &truth) { dither.add(truth); };
    rig.run(1.0);
    return {dither.worst_m(), dither.worst_rad(), rig.active()};
}

// Mean force along the motion that a coupling commands when its proxy is the game's own copy of the grip.
double free_drag(const Case &one) {
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

// A wall that swings to and fro, or turns, against a hand that leans on it: rms of the force's error against the
// wall without game and delay, of the rms force.
double moving_wall_error(const Case &one, bool turning) {
    HapticRig rig(rig_for(one));
    constexpr double kPace_rad_s = 2.0 * std::numbers::pi; // 1 Hz
    constexpr double kSwing_m = 0.004;
    constexpr double kTurn_rad = 0.2;
    const auto wall_at = [turning](double t) {
        ContactPlane wall;
        const double s = std::sin(kPace_rad_s * t);
        const double c = kPace_rad_s * std::cos(kPace_rad_s * t);
        if (turning) { // about a point 50 mm beside the grip
            const double a = kTurn_rad * s;
            wall.normal = Vec3(std::cos(a), std::sin(a), 0.0);
            const Vec3 pivot(0.0, 0.05, 0.0);
            wall.offset_m = glm::dot(wall.normal, pivot);
            const Vec3 spin(0.0, 0.0, kTurn_rad * c);
            wall.velocity_m_s = glm::cross(spin, Vec3(0.0) - pivot);
        } else {
            wall.normal = Vec3(1.0, 0.0, 0.0);
            wall.offset_m = kSwing_m * s;
            wall.velocity_m_s.x = kSwing_m * c;
        }
        return wall;
    };
    rig.game = [&wall_at](const ServoSnapshot &seen, HapticCommand &command) {
        give_contacts(command, {wall_at(seen.time_s)});
    };
    HandTarget target;
    target.position_m.x = turning ? -0.025 : -0.02;
    rig.hand_to(target);
    rig.run(1.0);
    double error_n2 = 0.0;
    double ideal_n2 = 0.0;
    rig.watch = [&](const ServoSnapshot &now, const PlantTruth &truth) {
        const ContactPlane wall = wall_at(now.time_s);
        const double depth_m = wall.offset_m - glm::dot(wall.normal, truth.pose.position_m);
        const double closing_m_s =
            glm::dot(wall.normal, wall.velocity_m_s - truth.twist.linear_m_s);
        const double push_n = std::max(0.0, kPlane_n_m * depth_m + kPlane_n_s_m * closing_m_s);
        const Vec3 ideal_n = push_n * wall.normal;
        const Vec3 error = now.requested.force_n - ideal_n;
        error_n2 += glm::dot(error, error);
        ideal_n2 += glm::dot(ideal_n, ideal_n);
    };
    rig.run(2.0);
    return rig.active() && ideal_n2 > 0.0 ? std::sqrt(error_n2 / ideal_n2) : kLost;
}

// Force that the hand feels on one contact at the centre against four at the pole ends of the same plane.
double coplanar_difference(const Case &one) {
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

} // namespace

int main(int argc, char **argv) {
    long wanted = 0;
    std::uint64_t seed = 1;
    for (int i = 1; i < argc; ++i) {
        if (std::strcmp(argv[i], "--cases") == 0 && i + 1 < argc) {
            wanted = std::atol(argv[++i]);
        } else if (std::strcmp(argv[i], "--seed") == 0 && i + 1 < argc) {
            seed = static_cast<std::uint64_t>(std::atoll(argv[++i]));
        } else {
            std::fprintf(stderr, "usage: passivity_gates [--cases N] [--seed S]\n");
            return 2;
        }
    }
    std::vector<Case> cases;
    for (const HandFirmness hand :
         {HandFirmness::light, HandFirmness::normal, HandFirmness::firm}) {
        for (const double friction_n : {0.0, 0.1}) {
            for (const double latency_s : {0.00025, 0.001, 0.002}) {
                for (const double game_hz : {30.0, 60.0, 120.0, 144.0}) {
                    cases.push_back({hand, friction_n, latency_s, game_hz, seed});
                }
            }
        }
    }
    if (wanted > 0 && static_cast<std::size_t>(wanted) < cases.size()) {
        std::mt19937_64 random(seed);
        std::shuffle(cases.begin(), cases.end(), random);
        cases.resize(static_cast<std::size_t>(wanted));
    }
    Gate work{"work on the hand per tap", kMostWork_j, "mJ", 1e3, -1e300, {}};
    Gate plane{"dither, plane", kStill_m, "mm", 1e3, -1e300, {}};
    Gate turn{"dither, turn stop", kStill_rad, "deg", 180.0 / std::numbers::pi, -1e300, {}};
    Gate grasp{"dither, grasp stop", kStill_rad, "deg", 180.0 / std::numbers::pi, -1e300, {}};
    Gate all_m{"dither, all seven", kStill_m, "mm", 1e3, -1e300, {}};
    Gate all_rad{"dither, all seven", kStill_rad, "deg", 180.0 / std::numbers::pi, -1e300, {}};
    Gate held_m{"dither, coupling", kStill_m, "mm", 1e3, -1e300, {}};
    Gate held_rad{"dither, coupling", kStill_rad, "deg", 180.0 / std::numbers::pi, -1e300, {}};
    Gate drag{"drag in free space", kMostDrag_n, "N", 1.0, -1e300, {}};
    Gate swinging{"moving wall's error", kWallError, "%", 100.0, -1e300, {}};
    Gate turning{"turning wall's error", kTurningError, "%", 100.0, -1e300, {}};
    Gate coplanar{"one or four coplanar", kSameFeel, "%", 100.0, -1e300, {}};
    Gate *const gates[] = {&work,   &plane,    &turn, &grasp,    &all_m,   &all_rad,
                           &held_m, &held_rad, &drag, &swinging, &turning, &coplanar};
    for (const Case &one : cases) {
        work.add(tap_work(one), one);
        const auto add = [&one](const PressResult &result, Gate *metres, Gate *radians) {
            if (metres != nullptr) {
                metres->add(result.active ? result.dither_m : kLost, one);
            }
            if (radians != nullptr) {
                radians->add(result.active ? result.dither_rad : kLost, one);
            }
        };
        add(press_default(one, 0), &plane, nullptr);
        add(press_default(one, 5), nullptr, &turn);
        add(press_default(one, 6), nullptr, &grasp);
        add(press_default(one, kAllWalls), &all_m, &all_rad);
        add(hold_coupling(one), &held_m, &held_rad);
        drag.add(free_drag(one), one);
        swinging.add(moving_wall_error(one, false), one);
        turning.add(moving_wall_error(one, true), one);
        coplanar.add(coplanar_difference(one), one);
    }
    int failed = 0;
    std::printf("%zu combinations, seed %llu; the worst of each gate\n", cases.size(),
                static_cast<unsigned long long>(seed));
    for (const Gate *gate : gates) {
        failed += gate->good() ? 0 : 1;
        std::printf("%-6s %-26s %10.4f %-4s (at most %g)  %s\n", gate->good() ? "good" : "FAILED",
                    gate->name, gate->scale * gate->worst, gate->unit, gate->scale * gate->limit,
                    gate->where.c_str());
    }
    return failed == 0 ? 0 : 1;
}
