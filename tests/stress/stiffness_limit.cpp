// Stiffness limits in simulated time: the largest wall that the worst of three hands holds still, what each part of
// the renderer gives of it, and a Z-width table. Frictionless strings, caps lifted, 1 kHz, game at 60 Hz.
//   stiffness_limit [--part limits|parts|latency|width] [--csv FOLDER] [--quick]
// All four parts without --part; --quick: only whether the promised walls are held still.
// Still: below 0.2 mm and 0.01 rad peak to peak in the last second. These are results for three hands; no wall of a
// frictionless device with encoders is passive for any hand (see docs/why/contact_engine.md).
#include <cstdio>
#include <cstring>
#include <string>

#include "support/touch_gates.h"
#include "support/wall_rig.h"

using namespace spidar;
using namespace spidar::test;

namespace {

constexpr double kStill_m = 0.2e-3;
constexpr double kStill_rad = 0.01;
constexpr double kStep = 1.2; // between the stiffnesses that are tried
constexpr double kSoftest_n_m = 100.0;
constexpr double kStiffest_n_m = 5000.0;
constexpr HandFirmness kHands[] = {HandFirmness::light, HandFirmness::normal, HandFirmness::firm};

struct Variant {
    const char *name;
    RenderSettings render;
    double damping_n_s_m;  // of the wall
    double damping_time_s; // and this times its stiffness
};

RigSettings rig_of(const Variant &variant, HandFirmness hand, double latency_s) {
    RigSettings settings;
    settings.plant.firmness = hand;
    settings.plant.coulomb_friction_n = 0.0;
    settings.latency_s = latency_s;
    settings.servo.render = variant.render;
    settings.servo.safety.max_grip_speed_m_s = 10.0;
    lift_caps(settings.servo.render);
    return settings;
}

bool holds_still(const Variant &variant, HandFirmness hand, double latency_s, int dof,
                 double stiffness_n_m) {
    const double damping_n_s_m = variant.damping_n_s_m + variant.damping_time_s * stiffness_n_m;
    const double part =
        dof == kAllWalls ? 0.5 : 1.0; // seven at once stay within the strings' force
    const PressResult result =
        press(rig_of(variant, hand, latency_s), walls_at_rest(dof, stiffness_n_m, damping_n_s_m),
              press_target(dof, part));
    return result.active && result.dither_m < kStill_m && result.dither_rad < kStill_rad;
}

// The largest stiffness up to which every tried one was still, for the worst hand.
double limit(const Variant &variant, double latency_s, int dof, HandFirmness *worst = nullptr) {
    double least = kStiffest_n_m;
    for (const HandFirmness hand : kHands) {
        double last = 0.0;
        for (double k = kSoftest_n_m; k <= least; k *= kStep) {
            if (!holds_still(variant, hand, latency_s, dof, k)) {
                break;
            }
            last = k;
        }
        if (last < least) {
            least = last;
            if (worst != nullptr) {
                *worst = hand;
            }
        }
    }
    return least;
}

// In the units of the DOF.
double in_units(int dof, double stiffness_n_m) {
    return dof >= 3 && dof < 6 ? turn_of(stiffness_n_m)
           : dof == 6          ? grasp_of(stiffness_n_m)
                               : stiffness_n_m;
}

struct Target {
    int dof;
    const char *name;
    const char *unit;
    double wanted;
};
constexpr Target kTargets[] = {
    {0, "plane, x", "N/m", 900.0},       {1, "plane, y", "N/m", 900.0},
    {2, "plane, z", "N/m", 900.0},       {3, "turn stop, x", "N m/rad", 3.0},
    {4, "turn stop, y", "N m/rad", 3.0}, {5, "turn stop, z", "N m/rad", 3.0},
    {6, "grasp stop", "N m/rad", 0.7},   {kAllWalls, "all seven", "N/m", 400.0}};

// Bounds of theory for a plain wall in translation: damping of the rotors that a move of the grip turns.
void print_bounds(double latency_s) {
    const PlantSettings plant;
    constexpr double kRotorsOfOneDof = 8.0 / 3.0; // sum over the strings of the squared direction
    const double own = plant.viscous_friction_n_s_m * kRotorsOfOneDof;
    const double delay_s = 0.5e-3 + latency_s;
    std::printf("theory, plain wall: own damping %.2f N s/m over half a period and latency: %.0f "
                "N/m; with the "
                "current's lag %.0f N/m (Colgate)\n",
                own, own / delay_s, own / (delay_s + plant.current_lag_s));
    std::printf("passive for any hand (Abbott and Okamura): 2 friction / resolution: 0 N/m without "
                "friction, %.0f "
                "N/m with 0.1 N on each string, 25 um counts, if no delay\n",
                2.0 * 0.1 * kRotorsOfOneDof / plant.metres_per_count);
}

// Real shapes, in parts of the automatic stiffness: the caps are 1 / 0.6 of it.
constexpr double kCap = 1.0 / kAutomaticShare;
constexpr double kSoftestPart = 0.5;
constexpr double kStiffestPart = 8.0;
constexpr const char *kWallNames[kStiffWalls] = {"face", "bar's end", "width", "peg"};

bool holds_still(const Variant &variant, HandFirmness hand, double latency_s, TouchWall wall,
                 double part) {
    const GainCaps caps = gain_caps(RenderSettings(), ServoSettings().rate_hz);
    TouchScene touch = scene_of(wall);
    for (std::size_t dof = 0; dof < touch.stiffness.size(); ++dof) {
        touch.stiffness[dof] = part * kAutomaticShare * stiffness_cap(caps, dof).most;
    }
    touch.damping_n_s_m = variant.damping_n_s_m + variant.damping_time_s * touch.stiffness[0];
    const PressResult result =
        touch_press(rig_of(variant, hand, latency_s), touch, touch_target(wall, 1.0));
    return result.active && result.dither_m < kStill_m && result.dither_rad < kStill_rad;
}

double limit(const Variant &variant, double latency_s, TouchWall wall) {
    double least = kStiffestPart;
    for (const HandFirmness hand : kHands) {
        double last = 0.0;
        for (double part = kSoftestPart; part <= least; part *= kStep) {
            if (!holds_still(variant, hand, latency_s, wall, part)) {
                break;
            }
            last = part;
        }
        least = std::min(least, last);
    }
    return least;
}

// How many of the targets are missed.
int print_limits(const Variant &variant, double latency_s) {
    int missed = 0;
    std::printf("largest stiffness held still by the worst of three hands; latency 1 ms, 1 kHz, no "
                "friction\n");
    std::printf("%-14s %12s %10s  worst hand\n", "wall", "limit", "wanted");
    for (const Target &target : kTargets) {
        HandFirmness worst = HandFirmness::light;
        const double most = in_units(target.dof, limit(variant, latency_s, target.dof, &worst));
        missed += most >= target.wanted ? 0 : 1;
        std::printf("%-14s %12.3g %10g  %d  %s\n", target.name, most, target.wanted,
                    static_cast<int>(worst), target.unit);
        std::fflush(stdout);
    }
    for (int i = 0; i < kStiffWalls; ++i) {
        const double most = limit(variant, latency_s, static_cast<TouchWall>(i));
        missed += most >= kCap ? 0 : 1;
        std::printf("%-14s %12.3g %10.3g     times the automatic stiffness\n", kWallNames[i], most,
                    kCap);
        std::fflush(stdout);
    }
    return missed;
}

int usage() {
    std::fprintf(stderr,
                 "usage: stiffness_limit [--part limits|parts|latency|width] [--csv FOLDER] "
                 "[--quick]\n");
    return 2;
}

} // namespace

int main(int argc, char **argv) {
    std::string folder;
    std::string part;
    bool quick = false;
    for (int i = 1; i < argc; ++i) {
        if (std::strcmp(argv[i], "--csv") == 0 && i + 1 < argc) {
            folder = argv[++i];
        } else if (std::strcmp(argv[i], "--part") == 0 && i + 1 < argc) {
            part = argv[++i];
        } else if (std::strcmp(argv[i], "--quick") == 0) {
            quick = true;
        } else {
            return usage();
        }
    }
    const auto wants = [&part](const char *name) { return part.empty() || part == name; };
    if (!wants("limits") && !wants("parts") && !wants("latency") && !wants("width")) {
        return usage();
    }
    const Variant shipped{"shipped", RenderSettings(), 2.0, 0.0};
    constexpr double kLatency_s = 0.001;
    int failures = 0;
    if (quick) { // does the shipped renderer hold what is promised?
        for (const Target &target : kTargets) {
            const double k = target.wanted / in_units(target.dof, 1.0);
            for (const HandFirmness hand : kHands) {
                const bool still = holds_still(shipped, hand, kLatency_s, target.dof, k);
                failures += still ? 0 : 1;
                std::printf("%-14s %6g %-8s hand %d: %s\n", target.name, target.wanted, target.unit,
                            static_cast<int>(hand), still ? "still" : "NOT STILL");
            }
        }
        for (int i = 0; i < kStiffWalls; ++i) {
            for (const HandFirmness hand : kHands) {
                const bool still =
                    holds_still(shipped, hand, kLatency_s, static_cast<TouchWall>(i), kCap);
                failures += still ? 0 : 1;
                std::printf("%-14s %6.3g times the automatic stiffness, hand %d: %s\n",
                            kWallNames[i], kCap, static_cast<int>(hand),
                            still ? "still" : "NOT STILL");
            }
        }
        std::printf("%d not still\n", failures);
        return failures == 0 ? 0 : 1;
    }

    if (wants("limits")) {
        failures = print_limits(shipped, kLatency_s);
        print_bounds(kLatency_s);
    }

    constexpr int kShown[] = {0, 5, 6, kAllWalls};
    // One part after the other, on top of those before it.
    RenderSettings filter = plain_spring_damper();
    filter.velocity_cutoff_hz = RenderSettings().velocity_cutoff_hz;
    RenderSettings observer = filter;
    observer.string_resonance_hz = RenderSettings().string_resonance_hz;
    const Variant steps[] = {{"plain spring-damper, 2 N s/m", plain_spring_damper(), 2.0, 0.0},
                             {"+ velocity filter at 300 Hz", filter, 2.0, 0.0},
                             {"+ resonance observer (notch)", observer, 2.0, 0.0},
                             {"+ delay compensation 3 ms: shipped", RenderSettings(), 2.0, 0.0},
                             {"+ damping law 2 ms * stiffness", RenderSettings(), 0.0, 2e-3}};
    if (wants("parts")) {
        std::printf("\nwhat each part gives, worst hand; x N/m, turn z N m/rad, grasp N m/rad, all "
                    "N/m\n");
    }
    for (const Variant &variant : steps) {
        if (!wants("parts")) {
            break;
        }
        std::printf("%-36s", variant.name);
        for (const int dof : kShown) {
            std::printf(" %7.3g", in_units(dof, limit(variant, kLatency_s, dof)));
            std::fflush(stdout);
        }
        std::printf("\n");
    }
    if (wants("latency")) {
        std::printf("\nlatency, worst hand; as above\n");
    }
    for (const double latency_s : {0.00025, 0.002}) {
        if (!wants("latency")) {
            break;
        }
        std::printf("%.2f ms", 1e3 * latency_s);
        for (const int dof : kShown) {
            std::printf(" %7.3g", in_units(dof, limit(shipped, latency_s, dof)));
            std::fflush(stdout);
        }
        std::printf("\n");
    }
    if (!wants("width")) {
        std::printf("%d targets missed\n", failures);
        return failures == 0 ? 0 : 1;
    }
    // Z-width: stiffness limit against damping, plain and shipped.
    std::FILE *csv = folder.empty() ? nullptr : std::fopen((folder + "/z_width.csv").c_str(), "w");
    if (csv != nullptr) {
        std::fprintf(csv, "renderer,damping_n_s_m,limit_n_m\n");
    }
    std::printf("\nZ-width, plane along x: damping N s/m, limit N/m\n");
    for (const Variant &variant : {steps[0], steps[2], shipped}) {
        const char *name = variant.render.delay_compensation_s > 0.0  ? "shipped"
                           : variant.render.string_resonance_hz > 0.0 ? "resonance observer"
                                                                      : "plain";
        for (const double damping : {0.0, 1.0, 2.0, 4.0, 7.0}) {
            Variant one = variant;
            one.damping_n_s_m = damping;
            const double most = limit(one, kLatency_s, 0);
            std::printf("%-20s %5.1f %7.0f\n", name, damping, most);
            std::fflush(stdout);
            if (csv != nullptr) {
                std::fprintf(csv, "%s,%g,%g\n", name, damping, most);
            }
        }
    }
    if (csv != nullptr) {
        std::fclose(csv);
    }
    std::printf("%d targets missed\n", failures);
    return failures == 0 ? 0 : 1;
}
