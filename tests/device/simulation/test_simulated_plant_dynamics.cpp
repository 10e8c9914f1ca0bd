// The plant in motion: energy, friction, slack, stability, and inputs that make no sense.
#include <algorithm>
#include <limits>

#include <doctest/doctest.h>

#include "support/plant_test_support.h"

using namespace spidar;
using namespace spidar::test;

namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

double count_error(const PlantSettings &settings, const SimulatedPlant &plant, std::size_t i) {
    return static_cast<double>(plant.counts()[i]) -
           plant.truth().lengths_m[i] / settings.metres_per_count;
}

HandTarget at(const Vec3 &position_m) {
    HandTarget target;
    target.position_m = position_m;
    return target;
}

} // namespace

TEST_CASE("plant: without currents a displaced grip never gains energy") {
    for (const double friction : {0.0, 1.0}) {
        for (const HandFirmness firmness :
             {HandFirmness::light, HandFirmness::normal, HandFirmness::firm}) {
            PlantSettings settings;
            settings.coulomb_friction_n *= friction;
            settings.viscous_friction_n_s_m *= friction;
            settings.firmness = firmness;
            SimulatedPlant plant(settings);
            StringArray tensions = equal_tensions(0.5);
            tensions[0] = 1.5;
            tensions[5] = 1.0;
            pull(plant, tensions);
            plant.advance(1.0);
            plant.advance(1.0);
            plant.set_currents({});
            plant.advance(0.02); // 40 current lags: the motors are off
            const double start_j = plant.mechanical_energy_j();
            const double supplied_j = plant.supplied_energy_j();
            const double to_hand_j = plant.truth().energy_to_hand_j;
            REQUIRE(start_j > 1e-4);
            double last_j = start_j;
            double worst_rise_j = 0.0;
            for (int cycle = 0; cycle < 2000; ++cycle) {
                plant.advance(0.001);
                const double own_j =
                    plant.mechanical_energy_j() - (plant.supplied_energy_j() - supplied_j);
                worst_rise_j = std::max(worst_rise_j, own_j - last_j);
                last_j = std::min(last_j, own_j);
                CHECK(plant.mechanical_energy_j() <= start_j * 1.001);
            }
            CAPTURE(friction);
            CAPTURE(start_j);
            // Semi-implicit Euler keeps energy to first order in the step.
            CHECK(worst_rise_j < 2e-3 * start_j);
            CHECK(plant.mechanical_energy_j() < 0.02 * start_j);
            CHECK(plant.truth().energy_to_hand_j - to_hand_j < start_j);
        }
    }
}

TEST_CASE("plant: with motors on, energy gained is at most the work of the motors") {
    for (const double ea_n : {500.0, 3000.0, 30000.0}) {
        PlantSettings settings = frictionless(true);
        settings.string_stiffness_ea_n = ea_n;
        SimulatedPlant plant(settings);
        Random random(31);
        double worst_j = 0.0;
        double last_j = 0.0;
        double peak_j = 0.0;
        for (int cycle = 0; cycle < 2000; ++cycle) {
            if (cycle % 50 == 0) {
                pull(plant, random.tensions(0.3, 3.0));
            }
            plant.advance(0.001);
            const double own_j = plant.mechanical_energy_j() - plant.supplied_energy_j();
            worst_j = std::max(worst_j, own_j - last_j);
            last_j = std::min(last_j, own_j);
            peak_j = std::max(peak_j, plant.mechanical_energy_j());
        }
        CAPTURE(ea_n);
        CAPTURE(peak_j);
        CHECK(worst_j < 0.02 * peak_j);
    }
}

TEST_CASE("plant: energy_to_hand is the work of a constant force along the way") {
    PlantSettings settings = frictionless(false);
    SimulatedPlant plant(settings);
    StringArray tensions = equal_tensions(1.0);
    tensions[0] = tensions[2] = tensions[4] = tensions[6] = 1.5;
    pull(plant, tensions);
    plant.advance(0.05);
    // Work of tensions is -sum T dl exactly, whatever the path.
    const PlantTruth start = plant.truth();
    plant.set_hand_target(at({0.05, 0.02, -0.03}));
    plant.advance(1.0);
    const PlantTruth end = plant.truth();
    double work_j = 0.0;
    for (std::size_t i = 0; i < kStringCount; ++i) {
        work_j -= tensions[i] * (end.lengths_m[i] - start.lengths_m[i]);
    }
    REQUIRE(std::abs(work_j) > 1e-2);
    CHECK(end.energy_to_hand_j - start.energy_to_hand_j == doctest::Approx(work_j).epsilon(1e-3));
}

TEST_CASE("plant: friction is against the string's movement, and exactly absent when zero") {
    PlantSettings settings;
    settings.elastic = false;
    for (const double scale : {1.0, 0.0}) {
        settings.coulomb_friction_n = 0.05 * scale;
        settings.viscous_friction_n_s_m = 0.3 * scale;
        SimulatedPlant plant(settings);
        pull(plant, equal_tensions(1.0));
        plant.advance(0.1);
        plant.set_hand_target(at({0.15, 0.0, 0.0}));
        plant.advance(0.1); // on its way along +x
        const PlantTruth truth = plant.truth();
        REQUIRE(truth.twist.linear_m_s.x > 0.3);
        for (std::size_t i = 0; i < kStringCount; ++i) {
            const bool paid_out = settings.frame.motors_m[i].x < 0.0;
            CAPTURE(i);
            if (scale == 0.0) {
                CHECK(truth.tensions_n[i] == doctest::Approx(1.0).epsilon(1e-14));
            } else if (paid_out) {
                CHECK(truth.tensions_n[i] > 1.05);
            } else {
                CHECK(truth.tensions_n[i] < 0.95);
            }
        }
        // Friction only takes from the hand.
        if (scale > 0.0) {
            CHECK(glm::dot(truth.strings.force_n, truth.twist.linear_m_s) < 0.0);
        }
    }
}

TEST_CASE("plant: a rotor in stiction does not move at all, and moves without friction") {
    for (const double coulomb_n : {0.5, 0.0}) {
        PlantSettings settings;
        settings.coulomb_friction_n = coulomb_n;
        SimulatedPlant plant(settings);
        pull(plant, equal_tensions(2.0));
        plant.advance(1.0);
        const CountArray before = plant.counts();
        plant.set_hand_target(at({0.001, 0.0, 0.0})); // at most 0.3 N over eight strings
        plant.advance(1.0);
        const CountArray after = plant.counts();
        if (coulomb_n > 0.0) {
            CHECK(after == before);
        } else {
            CHECK(std::abs(after[0] - before[0]) >= 10);
        }
    }
}

TEST_CASE("plant: slack strings never push, and the counts stay true with the motors off") {
    const PlantSettings settings;
    SimulatedPlant plant(settings);
    Random random(41);
    for (int move = 0; move < 10; ++move) {
        plant.set_hand_target(random.pose(0.12, 0.5, 0.5));
        double worst_moving = 0.0;
        for (int cycle = 0; cycle < 1000; ++cycle) {
            plant.advance(0.001);
            const PlantTruth truth = plant.truth();
            for (std::size_t i = 0; i < kStringCount; ++i) {
                REQUIRE(truth.tensions_n[i] >= 0.0);
                worst_moving = std::max(worst_moving, std::abs(count_error(settings, plant, i)));
            }
        }
        CAPTURE(move);
        CHECK(worst_moving < 30.0); // 0.75 mm on the way, at up to 1 m/s
        const PlantTruth truth = plant.truth();
        for (std::size_t i = 0; i < kStringCount; ++i) {
            CAPTURE(i);
            CHECK(std::abs(count_error(settings, plant, i)) <= 1.0); // half a count is rounding
            CHECK(truth.tensions_n[i] <= settings.coulomb_friction_n * 1.01);
        }
    }
}

TEST_CASE("plant: the hand feels nothing of the take-up when the motors are off") {
    SimulatedPlant plant(frictionless(true));
    plant.set_hand_target(at({0.1, -0.05, 0.08}));
    plant.advance(1.0);
    plant.advance(1.0);
    for (const double value : lanes(plant.truth().strings)) {
        CHECK(std::abs(value) < 2e-3);
    }
    CHECK(glm::length(plant.truth().pose.position_m - Vec3(0.1, -0.05, 0.08)) < 1e-5);
}

TEST_CASE("plant: stable for strings from 0.5 to 30 kN, with every hand and high tension") {
    for (const double ea_n : {500.0, 1000.0, 3000.0, 10000.0, 30000.0}) {
        for (const HandFirmness firmness :
             {HandFirmness::light, HandFirmness::normal, HandFirmness::firm}) {
            PlantSettings settings = frictionless(true); // friction hides instability
            settings.string_stiffness_ea_n = ea_n;
            settings.firmness = firmness;
            SimulatedPlant plant(settings);
            pull(plant, equal_tensions(6.0));
            HandTarget target = at({0.02, 0.02, 0.02});
            target.rotation = rotation_by({0.1, 0.1, 0.1});
            plant.set_hand_target(target);
            plant.advance(1.0);
            for (int second = 0; second < 3; ++second) {
                plant.advance(1.0);
            }
            Vec3 low = plant.truth().pose.position_m;
            Vec3 high = low;
            double fastest = 0.0;
            for (int cycle = 0; cycle < 200; ++cycle) {
                plant.advance(0.001);
                const PlantTruth truth = plant.truth();
                low = glm::min(low, truth.pose.position_m);
                high = glm::max(high, truth.pose.position_m);
                fastest = std::max(fastest, glm::length(truth.twist.linear_m_s));
            }
            CAPTURE(ea_n);
            CAPTURE(static_cast<int>(firmness));
            CHECK(plant.truth().resets == 0);
            CHECK(glm::length(high - low) < 1e-5);
            CHECK(fastest < 1e-3);
        }
    }
}

TEST_CASE("plant: a target that jumps is followed at a limited speed, smoothly, and reached") {
    SimulatedPlant plant(frictionless(false));
    HandTarget target = at({0.2, 0.0, 0.0});
    target.rotation = rotation_by({0.0, 0.0, 2.0});
    target.grasp_angle_rad = 1.0;
    plant.set_hand_target(target);
    double fastest = 0.0;
    double fastest_turn = 0.0;
    double furthest = 0.0;
    for (int cycle = 0; cycle < 3000; ++cycle) {
        plant.advance(0.001);
        const PlantTruth truth = plant.truth();
        fastest = std::max(fastest, glm::length(truth.twist.linear_m_s));
        fastest_turn = std::max(fastest_turn, glm::length(truth.twist.angular_rad_s));
        furthest = std::max(furthest, truth.pose.position_m.x);
    }
    CHECK(fastest > 0.9 * kHandMaxSpeed_m_s);
    CHECK(fastest < 1.2 * kHandMaxSpeed_m_s);
    CHECK(fastest_turn < 1.2 * kHandMaxTurnRate_rad_s);
    CHECK(furthest < 0.21);
    const PlantTruth truth = plant.truth();
    CHECK(glm::length(truth.pose.position_m - target.position_m) < 1e-6);
    for (int axis = 0; axis < 3; ++axis) {
        CHECK(glm::length(truth.frame.rotation[axis] - target.rotation[axis]) < 1e-6);
    }
    CHECK(truth.frame.grasp_angle_rad == doctest::Approx(1.0).epsilon(1e-6));
}

TEST_CASE("plant: hinge stops and the hand's reach hold") {
    PlantSettings settings = frictionless(false);
    SimulatedPlant plant(settings);
    HandTarget target = at({10.0, -10.0, 0.0});
    target.grasp_angle_rad = 3.0;
    plant.set_hand_target(target);
    plant.advance(1.0);
    plant.advance(1.0);
    CHECK(plant.truth().pose.position_m.x == doctest::Approx(0.24 - 0.04).epsilon(1e-6));
    CHECK(plant.truth().pose.position_m.y == doctest::Approx(-0.24 + 0.04).epsilon(1e-6));
    CHECK(plant.truth().frame.grasp_angle_rad <= settings.hinge_closed_rad);
    // Narrow stops, against which the strings pull both ways.
    settings.hinge_open_rad = -0.1;
    settings.hinge_closed_rad = 0.1;
    SimulatedPlant narrow(settings);
    StringArray tensions = equal_tensions(1.0);
    double highest = 0.0;
    double lowest = 0.0;
    Random random(7);
    for (int cycle = 0; cycle < 500; ++cycle) {
        if (cycle % 50 == 0) {
            tensions = random.tensions(0.0, 15.0);
        }
        pull(narrow, tensions);
        narrow.advance(0.001);
        highest = std::max(highest, narrow.truth().frame.grasp_angle_rad);
        lowest = std::min(lowest, narrow.truth().frame.grasp_angle_rad);
    }
    CHECK(highest <= 0.1);
    CHECK(lowest >= -0.1);
    CHECK(highest - lowest > 0.1); // it was pushed at all
}

TEST_CASE("plant: inputs that make no sense are ignored") {
    SimulatedPlant plant((PlantSettings()));
    pull(plant, equal_tensions(1.0));
    plant.set_hand_target(at({0.05, 0.0, 0.0}));
    plant.advance(1.0);
    const PlantTruth before = plant.truth();
    for (const double bad : {kNan, kInfinity, -kInfinity}) {
        plant.set_hand_target(at({bad, 0.0, 0.0}));
        HandTarget target;
        target.grasp_angle_rad = bad;
        plant.set_hand_target(target);
        target = {};
        target.rotation[1][1] = bad;
        plant.set_hand_target(target);
        plant.reset(target);
        plant.advance(bad);
    }
    HandTarget mirrored;
    mirrored.rotation[0][0] = -1.0;
    plant.set_hand_target(mirrored);
    HandTarget scaled;
    scaled.rotation *= 2.0;
    plant.set_hand_target(scaled);
    HandTarget zero;
    zero.rotation = Mat3(0.0);
    plant.set_hand_target(zero);
    plant.advance(0.0);
    plant.advance(-1.0);
    CHECK(plant.truth().time_s == before.time_s);
    plant.advance(1.0);
    const PlantTruth after = plant.truth();
    REQUIRE(is_finite(after));
    CHECK(glm::length(after.pose.position_m - before.pose.position_m) < 1e-5);
    plant.set_currents({kNan, kInfinity, -kInfinity, -1e308, 1e308, kNan, kNan, kNan});
    plant.advance(1.0);
    CHECK(is_finite(plant.truth()));
    CHECK(plant.truth().resets == 0);
}

TEST_CASE("plant: physics that fail begin again at the hand's target, counted") {
    PlantSettings settings;
    settings.string_stiffness_ea_n = 1e12; // validate() refuses this
    REQUIRE_FALSE(validate(settings).empty());
    SimulatedPlant plant(settings);
    pull(plant, equal_tensions(5.0));
    plant.set_hand_target(at({0.05, 0.0, 0.0}));
    for (int cycle = 0; cycle < 100; ++cycle) {
        plant.advance(0.001);
        REQUIRE(is_finite(plant.truth()));
    }
    CHECK(plant.truth().resets > 0);
}

TEST_CASE("plant: a broken string pulls no more, winds in, and is taut when mended") {
    PlantSettings settings;
    SimulatedPlant plant(settings);
    pull(plant, equal_tensions(1.0));
    plant.advance(0.2);
    REQUIRE(plant.truth().tensions_n[3] > 0.9);
    const CountArray before = plant.counts();
    plant.set_broken_strings(1U << 3);
    plant.advance(0.1);
    CHECK(plant.truth().tensions_n[3] == 0.0);
    CHECK(plant.counts()[3] < before[3] - 1000);
    plant.advance(1.0);
    CHECK(plant.counts()[3] == 0); // all wound in
    const HandTarget pose = pose_of(plant.truth());
    const PaperWrench expected = virtual_work_forces(settings, pose, plant.truth().tensions_n);
    CHECK(std::abs(lanes(plant.truth().strings)[0] - expected[0]) < 1e-7);
    plant.set_broken_strings(0);
    plant.advance(0.2);
    CHECK(plant.truth().tensions_n[3] > 0.9);
    CHECK(std::abs(count_error(settings, plant, 3)) < 10.0); // stretch of 1 N: 5 counts
    CHECK(plant.truth().resets == 0);
}

TEST_CASE("plant: validate names the field, the value, the unit and the range") {
    CHECK(validate(PlantSettings{}) == "");
    const auto refused = [](auto change, const char *field) {
        PlantSettings settings;
        change(settings);
        const std::string message = validate(settings);
        CAPTURE(message);
        CHECK(message.find(field) != std::string::npos);
    };
    refused([](PlantSettings &s) { s.rotor_mass_kg = 0.0; }, "rotor_mass_kg is 0 kg");
    refused([](PlantSettings &s) { s.metres_per_count = kNan; }, "metres_per_count");
    refused([](PlantSettings &s) { s.string_stiffness_ea_n = -1.0; },
            "string_stiffness_ea_n is -1 N: set it between 10 and 30000 N");
    refused([](PlantSettings &s) { s.coulomb_friction_n = -0.1; }, "coulomb_friction_n");
    refused([](PlantSettings &s) { s.current_lag_s = kInfinity; }, "current_lag_s");
    refused([](PlantSettings &s) { s.length_gain_error[2] = kNan; }, "length_gain_error[2]");
    refused([](PlantSettings &s) { s.length_offset_error_m[7] = 5.0; }, "length_offset_error_m[7]");
    refused([](PlantSettings &s) { s.hinge_closed_rad = 2.0; }, "hinge_closed_rad");
    refused([](PlantSettings &s) { s.firmness = static_cast<HandFirmness>(9); }, "firmness");
    PlantSettings geometry;
    geometry.frame.motors_m[0].x = kNan;
    CHECK(validate(geometry) != "");
}
