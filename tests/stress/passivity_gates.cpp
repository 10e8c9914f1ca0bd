// Gates of the default gains in simulated time: three hands, strings without and with friction, three latencies, games
// at 30 to 144 Hz with jitter and dropped frames. In each: the work of a tap, dither while pressing a plane, a turn stop,
// a grasp stop, all seven and a coupling, the drag of a coupling in free space, walls that move and turn, an edge, and
// one or four coplanar contacts.
// And real shapes with automatic stiffness: a face, the end of a bar, a box between the pads, a peg in a hole.
//   passivity_gates [--cases N] [--seed S] [--out FOLDER]
// N of the combinations, at random; all of them without --cases. --out: passivity_gates.csv, all figures of each, and
// passivity_gates.md, the worst of all.
#include <algorithm>
#include <array>
#include <cstdio>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "support/command_line.h"
#include "support/gate_measures.h"
#include "support/touch_gates.h"

using namespace spidar;
using namespace spidar::test;

namespace {

// Of a tap; above rounding, and far below what a hand feels.
constexpr double kMostWork_j = 1e-5;
constexpr double kStill_m = 0.2e-3;
constexpr double kStill_rad = 0.05 * std::numbers::pi / 180.0;
// A peg is held by its ends, 30 mm from the middle, on both sides: five of a string's counts there.
constexpr double kStillPeg_rad = 0.06 * std::numbers::pi / 180.0;
// A face of four corners 30 mm from the middle on pits of 3 mm: a light hand that nothing rubs on rocks in a valley by 30 um at
// a corner, at 2 ms of latency.
constexpr double kStillMaterial_rad = 0.2 * std::numbers::pi / 180.0;
constexpr double kMostDrag_n = 0.25;
// Of the rms force: what moves, turns or has an edge against the ideal wall, and four contacts against one.
constexpr double kSameFeel = 0.05;
constexpr double kSameFace = 0.02;

struct Gate {
    const char *name;
    const char *column;
    const char *unit;
    double limit;
    double scale; // to that unit
    double worst = -1e300;
    std::string where{};

    void add(double value, const Case &one) {
        if (!(value <= worst)) { // NaN is worst of all
            worst = value;
            where = one.name();
        }
    }
    [[nodiscard]] bool good() const { return worst <= limit; }
};

constexpr double kDegrees = 180.0 / std::numbers::pi;
constexpr std::size_t kGates = 37;
using Gates = std::array<Gate, kGates>;

Gates all_gates() {
    const auto work = [](const char *name, const char *column) {
        return Gate{name, column, "mJ", kMostWork_j, 1e3};
    };
    const auto still = [](const char *name, const char *column) {
        return Gate{name, column, "mm", kStill_m, 1e3};
    };
    const auto turn = [](const char *name, const char *column) {
        return Gate{name, column, "deg", kStill_rad, kDegrees};
    };
    const auto feel = [](const char *name, const char *column) {
        return Gate{name, column, "%", kSameFeel, 100.0};
    };
    return {work("energy of a tap, plane", "tap_plane_mj"),
            work("energy of a tap, turn stop", "tap_turn_mj"),
            work("energy of a tap, grasp stop", "tap_grasp_mj"),
            work("energy of a tap, all seven", "tap_all_mj"),
            work("energy of a tap, coupling", "tap_coupling_mj"),
            still("dither, plane", "plane_mm"),
            turn("dither, turn stop", "turn_deg"),
            turn("dither, grasp stop", "grasp_deg"),
            still("dither, all seven", "all_mm"),
            turn("dither, all seven, turns", "all_deg"),
            still("dither, coupling", "coupling_mm"),
            turn("dither, coupling, turns", "coupling_deg"),
            Gate{"drag in free space", "drag_n", "N", kMostDrag_n, 1.0},
            feel("moving wall", "moving_percent"),
            feel("turning wall", "turning_percent"),
            feel("edge of two walls", "edge_percent"),
            feel("one or four coplanar", "coplanar_percent"),
            work("energy of a tap, face", "tap_face_mj"),
            still("dither, face", "face_mm"),
            turn("dither, face, turns", "face_deg"),
            work("energy of a tap, bar's end", "tap_bar_mj"),
            still("dither, bar's end", "bar_mm"),
            turn("dither, bar's end, turns", "bar_deg"),
            work("energy of a tap, width", "tap_width_mj"),
            still("dither, width", "width_mm"),
            turn("dither, width, turns", "width_deg"),
            work("energy of a tap, peg", "tap_peg_mj"),
            still("dither, peg", "peg_mm"),
            Gate{"dither, peg, turns", "peg_deg", "deg", kStillPeg_rad, kDegrees},
            work("energy of a tap and slide, material", "tap_material_mj"),
            still("dither, material", "material_mm"),
            Gate{"dither, material, turns", "material_deg", "deg", kStillMaterial_rad, kDegrees},
            work("energy of a swing, door", "swing_door_mj"),
            still("dither, door", "door_mm"),
            turn("dither, door, turns", "door_deg"),
            Gate{"face or ball", "face_percent", "%", kSameFace, 100.0},
            feel("moving floor", "floor_percent")};
}

// In the order of all_gates().
std::vector<double> measure(const Case &one) {
    constexpr int kTurnZ = 5;
    constexpr int kGrasp = 6;
    constexpr int kCoupling = -1;
    std::vector<double> values;
    for (const int dof : {0, kTurnZ, kGrasp, kAllWalls, kCoupling}) {
        values.push_back(tap_work(one, dof));
    }
    const auto metres = [&values](const PressResult &result) {
        values.push_back(result.active ? result.dither_m : kLost);
    };
    const auto radians = [&values](const PressResult &result) {
        values.push_back(result.active ? result.dither_rad : kLost);
    };
    metres(press_default(one, 0));
    radians(press_default(one, kTurnZ));
    radians(press_default(one, kGrasp));
    const PressResult all = press_default(one, kAllWalls);
    metres(all);
    radians(all);
    const PressResult held = hold_coupling(one);
    metres(held);
    radians(held);
    values.push_back(free_drag(one));
    values.push_back(moving_wall_error(one, false));
    values.push_back(moving_wall_error(one, true));
    values.push_back(edge_error(one));
    values.push_back(coplanar_difference(one));
    for (int i = 0; i < kTouchWalls; ++i) {
        const auto wall = static_cast<TouchWall>(i);
        values.push_back(touch_tap_work(one, wall));
        const PressResult pressed =
            touch_press(rig_for(one), scene_of(wall), touch_target(wall, 1.0));
        metres(pressed);
        radians(pressed);
    }
    values.push_back(touch_face_difference(one));
    values.push_back(touch_moving_error(one));
    return values;
}

std::vector<Case> combinations(long wanted, std::uint64_t seed) {
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
    return cases;
}

void write_row(std::FILE *csv, const Case &one, const Gates &gates,
               const std::vector<double> &values) {
    std::fprintf(csv, "%s,%g,%g,%g,%llu", one.hand_name(), one.friction_n, 1e3 * one.latency_s,
                 one.game_hz, static_cast<unsigned long long>(one.seed));
    for (std::size_t i = 0; i < gates.size(); ++i) {
        std::fprintf(csv, ",%.5g", gates[i].scale * values[i]);
    }
    std::fprintf(csv, "\n");
}

void write_page(std::FILE *page, const Gates &gates, std::size_t cases, std::uint64_t seed) {
    std::fprintf(page,
                 "# Passivity gates\n\nWritten by `build/bin/passivity_gates --seed %llu --out "
                 "FOLDER`: %zu combinations of hand, friction, latency and game rate in simulated "
                 "time (any machine gives the same), the default gains; the worst of each figure. "
                 "All of them are in "
                 "passivity_gates.csv. A tap's energy is what the device gave the hand: below "
                 "zero it took.\n\n| gate | worst | at most | | where |\n|---|---|---|---|---|\n",
                 static_cast<unsigned long long>(seed), cases);
    for (const Gate &gate : gates) {
        std::fprintf(page, "| %s | %.3g %s | %.3g | %s | %s |\n", gate.name,
                     gate.scale * gate.worst, gate.unit, gate.scale * gate.limit,
                     gate.good() ? "good" : "**FAILED**", gate.where.c_str());
    }
}

} // namespace

int main(int argc, char **argv) {
    const long wanted = whole_option(argc, argv, "--cases", 0);
    const auto seed = static_cast<std::uint64_t>(whole_option(argc, argv, "--seed", 1));
    const char *const folder = option_text(argc, argv, "--out");
    std::FILE *csv = nullptr;
    std::FILE *page = nullptr;
    if (folder != nullptr) {
        csv = std::fopen((std::string(folder) + "/passivity_gates.csv").c_str(), "w");
        page = std::fopen((std::string(folder) + "/passivity_gates.md").c_str(), "w");
        if (csv == nullptr || page == nullptr) {
            std::fprintf(stderr, "passivity_gates: cannot write into %s\n", folder);
            return 2;
        }
    }
    Gates gates = all_gates();
    if (csv != nullptr) {
        std::fprintf(csv, "hand,friction_n,latency_ms,game_hz,seed");
        for (const Gate &gate : gates) {
            std::fprintf(csv, ",%s", gate.column);
        }
        std::fprintf(csv, "\n");
    }
    const std::vector<Case> cases = combinations(wanted, seed);
    for (const Case &one : cases) {
        const std::vector<double> values = measure(one);
        for (std::size_t i = 0; i < gates.size(); ++i) {
            gates[i].add(values[i], one);
        }
        if (csv != nullptr) {
            write_row(csv, one, gates, values);
        }
    }
    int failed = 0;
    std::printf("%zu combinations, seed %llu; the worst of each gate\n", cases.size(),
                static_cast<unsigned long long>(seed));
    for (const Gate &gate : gates) {
        failed += gate.good() ? 0 : 1;
        std::printf("%-6s %-28s %10.4f %-4s (at most %g)  %s\n", gate.good() ? "good" : "FAILED",
                    gate.name, gate.scale * gate.worst, gate.unit, gate.scale * gate.limit,
                    gate.where.c_str());
    }
    if (folder != nullptr) {
        write_page(page, gates, cases.size(), seed);
        std::fclose(page);
        std::fclose(csv);
    }
    return failed == 0 ? 0 : 1;
}
