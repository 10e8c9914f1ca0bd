#include <doctest/doctest.h>

#include <cmath>
#include <numeric>

#include "support/haptic_rig.h"

using namespace spidar;
using namespace spidar::test;

TEST_CASE("energy: what each DOF was given follows from commanded tensions and measured lengths") {
    RigSettings settings;
    settings.plant.coulomb_friction_n = 0.0;
    settings.plant.viscous_friction_n_s_m = 0.0;
    HapticRig rig(settings);
    rig.game = [](const ServoSnapshot &, HapticCommand &command) {
        command.wrench = {Vec3(1.5, -1.0, 0.5), Vec3(0.02, 0.0, -0.03), 0.02};
        command.wrench_duration_s = 0.1;
        ++command.wrench_sequence;
    };
    rig.run(0.5);
    const auto total = [](const ServoSnapshot &now) {
        return std::accumulate(now.injected_j.begin(), now.injected_j.end(), 0.0);
    };
    const ServoSnapshot start = rig.now();
    const double truth_start_j = rig.energy_to_hand_j();
    ServoSnapshot last = start;
    double strings_j = 0.0;
    double most_j = 0.0;
    rig.watch = [&](const ServoSnapshot &now, const PlantTruth &) {
        for (std::size_t i = 0; i < kStringCount; ++i) {
            strings_j -= last.tensions_n[i] * (now.lengths_m[i] - last.lengths_m[i]);
        }
        last = now;
        most_j = std::max(most_j, std::abs(strings_j));
    };
    constexpr int kParts = 1500;
    for (int i = 0; i < kParts; ++i) {
        const double t = 0.001 * i;
        HandTarget target;
        target.position_m = 0.04 * Vec3(std::sin(5.0 * t), std::sin(3.0 * t), std::sin(4.0 * t));
        target.grasp_angle_rad = 0.3 * std::sin(6.0 * t);
        rig.hand_to(target);
        rig.run(0.001);
    }
    REQUIRE(rig.active());
    REQUIRE(most_j > 0.02);
    const double told_j = total(rig.now()) - total(start);
    // Force times way in seven DOF is tension times length in eight strings, but for what no pose explains.
    CHECK(std::abs(told_j - strings_j) < 0.05 * most_j);
    // And what the hand got, but for the springs and rotors in between and half a
    // cycle.
    CHECK(std::abs(told_j - (rig.energy_to_hand_j() - truth_start_j)) < 0.1 * most_j);
}
