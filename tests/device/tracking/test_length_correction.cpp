#include <doctest/doctest.h>

#include <cmath>

#include <glm/geometric.hpp>

#include "device/tracking/length_correction.h"
#include "support/length_error_model.h"
#include "support/wall_rig.h"

using namespace spidar;
using namespace spidar::test;

namespace {

constexpr double kTick_s = 0.001;

StringCalibration calibration() {
    const ServoSettings settings;
    return calibrate_at_home(
        string_lengths(settings.frame, settings.grip, rest_pose(settings.grip)), CountArray{},
        kPaperMetresPerCount);
}

struct Pressed {
    double pose_error_m = 0.0;
    double force_error = 0.0; // of the wall without strings
    bool active = false;
};

// A firm hand leans on a wall: what the strings' stretch hides of the pose, and
// of the force.
Pressed lean(double known_ea_n) {
    RigSettings settings;
    settings.plant.firmness = HandFirmness::firm;
    settings.servo.corrections.axial_stiffness_n.fill(known_ea_n);
    constexpr double kWall_n_m = 800.0;
    const std::vector<ContactPlane> walls = walls_at_rest(0, kWall_n_m, 2.0);
    HapticRig rig(settings);
    rig.game = [&walls](const ServoSnapshot &, HapticCommand &command) {
        give_contacts(command, walls);
    };
    rig.hand_to(press_target(0, 1.0));
    rig.run(2.0);
    const Vec3 true_m = rig.truth().pose.position_m;
    const double wall_n = kWall_n_m * -true_m.x;
    return {glm::distance(rig.now().grip.pose.position_m, true_m),
            rig.now().requested.force_n.x / wall_n - 1.0, rig.active()};
}

} // namespace

TEST_CASE("length correction: strings of known stiffness show the true pose "
          "and force") {
    const Pressed raw = lean(0.0);
    const Pressed corrected = lean(PlantSettings().string_stiffness_ea_n);
    CHECK(raw.active);
    CHECK(corrected.active);
    CHECK(raw.force_error < -0.04); // the wall feels softer than asked
    CHECK(std::abs(corrected.force_error) < 0.01);
    CHECK(corrected.pose_error_m < 0.2 * raw.pose_error_m);
}

TEST_CASE("length correction: off, nothing changes, to the bit") {
    LengthCorrection correction;
    correction.configure(calibration(), LengthCorrections());
    StringArray tensions_n;
    tensions_n.fill(7.0);
    CHECK_FALSE(correction.follow(tensions_n, kTick_s));
    const CountArray counts{1, -20, 300, -4000, 50, 60, -70, 8000};
    CHECK(correction.lengths(counts) == lengths_from_counts(calibration(), counts));
}

TEST_CASE("length correction: tensions that rest are followed to their end") {
    LengthCorrections known;
    known.axial_stiffness_n.fill(3000.0);
    known.calibration_tension_n.fill(0.5);
    LengthCorrection correction;
    correction.configure(calibration(), known);
    StringArray tensions_n;
    tensions_n.fill(6.5);
    int cycles = 0;
    while (correction.follow(tensions_n, kTick_s) && cycles < 10000) {
        ++cycles;
    }
    CHECK(cycles > 100);  // slowly,
    CHECK(cycles < 1000); // but it ends
    const CountArray counts{};
    const StringArray plain_m = lengths_from_counts(calibration(), counts);
    const StringArray lengths_m = correction.lengths(counts);
    for (std::size_t i = 0; i < lengths_m.size(); ++i) {
        CHECK(lengths_m[i] == doctest::Approx(plain_m[i] * (1.0 + 6.0 / 3000.0)).epsilon(1e-12));
    }
    tensions_n.fill(std::nan(""));
    CHECK_FALSE(correction.follow(tensions_n, kTick_s));
    CHECK(correction.lengths(counts) == lengths_m);
}

TEST_CASE("length correction: a pulley in the corrections is refused, for the "
          "frame has it") {
    ServoSettings settings;
    settings.strings = calibration();
    REQUIRE(validate(settings).empty());
    settings.corrections.pulley_radius_m = 0.004;
    CHECK(validate(settings).find("corrections.pulley_radius_m") == 0);
    settings.corrections.pulley_radius_m = 0.0;
    settings.corrections.axial_stiffness_n[3] = -1.0;
    CHECK(validate(settings).find("axial_stiffness_n[3]") != std::string::npos);
}

TEST_CASE("plant: drums that wind on themselves are seen through by the "
          "winding correction") {
    PlantSettings plant_settings;
    plant_settings.winding_growth = 0.046;
    SimulatedPlant plant(plant_settings);
    const StringArray home_m =
        string_lengths(plant_settings.frame, plant_settings.grip, rest_pose(plant_settings.grip));
    const StringCalibration strings =
        calibrate_at_home(home_m, plant.counts(), plant_settings.metres_per_count);
    LengthCorrections known;
    known.winding_curvature_1_m.fill(-0.5 * plant_settings.winding_growth / kFullWrap_m);
    HandTarget away;
    away.position_m = Vec3(0.08, -0.06, 0.05);
    plant.reset(away);
    const StringArray true_m = plant.truth().lengths_m;
    const StringArray plain_m = lengths_from_counts(strings, plant.counts());
    const StringArray wound_m = wound_lengths(strings, known, plant.counts());
    double plain_worst_m = 0.0;
    for (std::size_t i = 0; i < true_m.size(); ++i) {
        plain_worst_m = std::max(plain_worst_m, std::abs(plain_m[i] - true_m[i]));
        CHECK(std::abs(wound_m[i] - true_m[i]) < plant_settings.metres_per_count);
    }
    CHECK(plain_worst_m > 3e-4);
}

TEST_CASE("plant: a string under tension creeps by its strain") {
    PlantSettings settings;
    settings.creep = 0.002;
    settings.creep_time_s = 0.2;
    settings.coulomb_friction_n = 0.0;
    SimulatedPlant plant(settings);
    StringArray currents_a;
    currents_a.fill(0.5 * settings.motors.max_current_a[0]);
    plant.set_currents(currents_a);
    plant.advance(0.02);
    const CountArray before = plant.counts();
    const double tension_n = plant.truth().tensions_n[0];
    for (int i = 0; i < 40; ++i) {
        plant.advance(0.05);
    }
    const double length_m = plant.truth().lengths_m[0];
    // The motors wind in what the strings have grown by.
    const double wound_in_m = settings.metres_per_count * (before[0] - plant.counts()[0]);
    const double grown_m = settings.creep * plant.truth().tensions_n[0] / 10.0 * length_m;
    CHECK(tension_n > 1.0);
    CHECK(wound_in_m == doctest::Approx(grown_m).epsilon(0.15));
}

TEST_CASE("plant: exit pulleys lengthen the strings; the servo step sees the pose through them") {
    RigSettings settings;
    settings.plant.frame.pulley_radius_m = 0.004;
    settings.plant.frame.pulley_axis = Vec3(0.0, 1.0, 0.0);
    settings.servo.frame = settings.plant.frame;
    LengthErrors errors; // the model of the error budget, written apart from the plant
    errors.pulley_radius_m = 0.004;
    Draw draw(1);
    HapticRig rig(settings);
    HandTarget target;
    target.position_m = Vec3(0.05, 0.03, -0.04);
    rig.hand_to(target);
    rig.run(1.0);
    REQUIRE(rig.active());
    const PlantTruth truth = rig.truth();
    for (std::size_t i = 0; i < kStringCount; ++i) {
        const StringModel model(errors, settings.plant.frame.motors_m[i], kPaperMetresPerCount,
                                draw);
        const Vec3 tie = attachment_point(settings.plant.grip, truth.pose, static_cast<int>(i));
        CHECK(truth.lengths_m[i] == doctest::Approx(model.path_m(tie)).epsilon(1e-9));
    }
    CHECK(glm::distance(rig.now().grip.pose.position_m, truth.pose.position_m) < 2e-4);
    CHECK(glm::length(rig.now().achieved.force_n - truth.strings.force_n) < 0.15);
}
