// The plant against known answers: virtual work, the hand's spring law, exact counts.
#include <algorithm>
#include <limits>

#include <doctest/doctest.h>

#include "support/plant_test_support.h"

using namespace spidar;
using namespace spidar::test;

TEST_CASE("plant: net wrench of the strings is the virtual work of the tensions in all seven DOF") {
    for (const bool elastic : {false, true}) {
        const PlantSettings settings = frictionless(elastic);
        Random random(11);
        SimulatedPlant plant(settings);
        for (int round = 0; round < 40; ++round) {
            plant.reset(random.pose(0.15, 0.5, 0.6));
            pull(plant, random.tensions(0.3, 10.0));
            plant.advance(0.02);
            const PlantTruth truth = plant.truth();
            const DofLanes given = lanes(truth.strings);
            const PaperWrench expected =
                virtual_work_forces(settings, pose_of(truth), truth.tensions_n);
            for (std::size_t dof = 0; dof < kDofCount; ++dof) {
                CAPTURE(elastic);
                CAPTURE(round);
                CAPTURE(dof);
                CHECK(std::abs(given[dof] - expected[dof]) < 1e-7);
            }
        }
    }
}

TEST_CASE("plant: motor currents become the tensions of the true motors") {
    PlantSettings settings = frictionless(false);
    settings.motors.effective_radius_m = {0.008, 0.009, 0.010, 0.008, 0.008, 0.008, 0.008, 0.008};
    settings.motors.tension_gain = {1.0, 1.0, 1.0, 0.9, 1.0, 1.0, 1.0, 1.0};
    SimulatedPlant plant(settings);
    StringArray currents{};
    currents.fill(1.0);
    currents[5] = 1e9;                                      // above max_current_a
    currents[6] = std::numeric_limits<double>::quiet_NaN(); // off
    currents[7] = -1.0;                                     // a string cannot push
    plant.set_currents(currents);
    plant.advance(0.05); // 100 current lags
    const StringArray t = plant.truth().tensions_n;
    CHECK(t[0] == doctest::Approx(0.0438 / 0.008).epsilon(1e-12));
    CHECK(t[1] == doctest::Approx(0.0438 / 0.009).epsilon(1e-12));
    CHECK(t[2] == doctest::Approx(0.0438 / 0.010).epsilon(1e-12));
    CHECK(t[3] == doctest::Approx(0.9 * 0.0438 / 0.008).epsilon(1e-12));
    CHECK(t[5] == doctest::Approx(4.0 * 0.0438 / 0.008).epsilon(1e-12));
    CHECK(t[6] == 0.0);
    CHECK(t[7] == 0.0);
}

TEST_CASE("plant: motor current follows with its lag") {
    SimulatedPlant plant(frictionless(false));
    pull(plant, equal_tensions(1.0));
    plant.advance(PlantSettings{}.current_lag_s);
    CHECK(plant.truth().tensions_n[0] == doctest::Approx(1.0 - std::exp(-1.0)).epsilon(1e-9));
}

TEST_CASE("plant: equal tensions leave a hand at its target at rest there") {
    for (const bool elastic : {false, true}) {
        PlantSettings settings;
        settings.elastic = elastic;
        SimulatedPlant plant(settings);
        pull(plant, equal_tensions(5.0));
        plant.advance(0.5);
        const PlantTruth truth = plant.truth();
        CHECK(glm::length(truth.pose.position_m) < 1e-12);
        CHECK(std::abs(truth.frame.grasp_angle_rad) < 1e-10);
        CHECK(glm::length(truth.twist.linear_m_s) < 1e-12);
        CHECK(truth.tensions_n[0] ==
              doctest::Approx(5.0).epsilon(0.011)); // less stiction of 0.05 N
    }
}

TEST_CASE("plant: a 2 N push moves the normal hand by F / K = 6.67 mm") {
    for (const bool elastic : {false, true}) {
        SimulatedPlant plant(frictionless(elastic));
        // Motors 0, 2, 4 and 6 are the four at +x: more tension there pulls along +x.
        double extra_n = 1.0;
        for (int round = 0; round < 12; ++round) {
            StringArray tensions = equal_tensions(1.0);
            for (const std::size_t i : {0U, 2U, 4U, 6U}) {
                tensions[i] += extra_n;
            }
            pull(plant, tensions);
            plant.advance(1.0);
            plant.advance(1.0);
            extra_n += 0.4 * (2.0 - plant.truth().strings.force_n.x);
        }
        const PlantTruth truth = plant.truth();
        REQUIRE(truth.strings.force_n.x == doctest::Approx(2.0).epsilon(1e-4));
        CHECK(truth.pose.position_m.x == doctest::Approx(2.0 / 300.0).epsilon(2e-4));
        CHECK(truth.pose.position_m.x ==
              doctest::Approx(truth.strings.force_n.x / kNormalHand.stiffness_n_m).epsilon(1e-6));
    }
}

TEST_CASE("plant: at rest the hand's wrench is minus the strings' and its springs' law holds") {
    for (const HandFirmness firmness :
         {HandFirmness::light, HandFirmness::normal, HandFirmness::firm}) {
        PlantSettings settings = frictionless(true);
        settings.firmness = firmness;
        const HandImpedance z = impedance_of(firmness);
        Random random(5);
        SimulatedPlant plant(settings);
        for (int round = 0; round < 4; ++round) {
            const HandTarget target = random.pose(0.03, 0.2, 0.2);
            plant.reset(target);
            // Gentle enough that the light hand is not pulled over.
            pull(plant, random.tensions(0.5, 0.8));
            for (int second = 0; second < 4; ++second) {
                plant.advance(1.0);
            }
            const PlantTruth truth = plant.truth();
            const DofLanes strings = lanes(truth.strings);
            const DofLanes hand = lanes(truth.hand);
            for (std::size_t dof = 0; dof < kDofCount; ++dof) {
                CAPTURE(round);
                CAPTURE(dof);
                CHECK(std::abs(strings[dof] + hand[dof]) < 1e-6);
            }
            const Vec3 moved_m = truth.pose.position_m - target.position_m;
            CHECK(glm::length(z.stiffness_n_m * moved_m - truth.strings.force_n) < 1e-6);
            CHECK(z.grasp_stiffness_nm_rad *
                      (truth.frame.grasp_angle_rad - target.grasp_angle_rad) ==
                  doctest::Approx(truth.strings.grasp_torque_nm).epsilon(1e-4));
            // The rotation from target to grip is that of the moment over the stiffness.
            const Mat3 turned = rotation_by(truth.strings.moment_nm / z.stiffness_nm_rad);
            const Mat3 expected = turned * target.rotation;
            for (int axis = 0; axis < 3; ++axis) {
                CHECK(glm::length(truth.frame.rotation[axis] - expected[axis]) < 1e-5);
            }
        }
    }
}

TEST_CASE(
    "plant: counts are the exact lengths over the scale, elastic or not, when nothing pulls") {
    for (const bool elastic : {false, true}) {
        PlantSettings settings = frictionless(elastic);
        Random random(3);
        for (int round = 0; round < 200; ++round) {
            const HandTarget pose = random.pose(0.15, 0.5, 0.5);
            const StringArray gains = random.tensions(-0.02, 0.02);
            const StringArray offsets = random.tensions(-0.01, 0.01);
            settings.length_gain_error = round % 2 == 0 ? StringArray{} : gains;
            settings.length_offset_error_m = round % 2 == 0 ? StringArray{} : offsets;
            SimulatedPlant plant(settings);
            plant.reset(pose);
            const CountArray counts = plant.counts();
            for (std::size_t i = 0; i < kStringCount; ++i) {
                const double read_m =
                    string_length(settings, pose, i) * (1.0 + settings.length_gain_error[i]) +
                    settings.length_offset_error_m[i];
                CAPTURE(round);
                CAPTURE(i);
                CHECK(counts[i] == std::lround(read_m / settings.metres_per_count));
            }
        }
    }
}

TEST_CASE("plant: the core's kinematics agree with the plant's truth") {
    const PlantSettings settings = frictionless(false);
    Random random(17);
    SimulatedPlant plant(settings);
    for (int round = 0; round < 50; ++round) {
        const HandTarget pose = random.pose(0.15, 0.5, 0.6);
        plant.reset(pose);
        const PlantTruth truth = plant.truth();
        const GripPose core =
            make_pose(settings.grip, pose.position_m, pose.rotation, pose.grasp_angle_rad);
        CHECK(glm::length(core.position_m - truth.pose.position_m) < 1e-14);
        CHECK(glm::length(core.r1_m - truth.pose.r1_m) < 1e-14);
        CHECK(glm::length(core.r2_m - truth.pose.r2_m) < 1e-14);
        const StringArray lengths = string_lengths(settings.frame, settings.grip, core);
        for (std::size_t i = 0; i < kStringCount; ++i) {
            CHECK(std::abs(lengths[i] - truth.lengths_m[i]) < 1e-14);
        }
    }
}

TEST_CASE("plant: stretch is tension over stiffness, and the encoder does not see it") {
    const PlantSettings settings = frictionless(true);
    SimulatedPlant plant(settings);
    pull(plant, equal_tensions(5.0));
    plant.advance(1.0);
    const PlantTruth truth = plant.truth();
    const double stretch_m = 5.0 * truth.lengths_m[0] / settings.string_stiffness_ea_n;
    CHECK(plant.counts()[0] ==
          std::lround((truth.lengths_m[0] - stretch_m) / settings.metres_per_count));
    CHECK(stretch_m / settings.metres_per_count > 20.0); // or the line above proves nothing
}

TEST_CASE("plant: two runs are the same to the bit") {
    const auto run = [] {
        SimulatedPlant plant((PlantSettings()));
        Random random(23);
        for (int cycle = 0; cycle < 400; ++cycle) {
            if (cycle % 16 == 0) {
                plant.set_hand_target(random.pose(0.1, 0.4, 0.4));
            }
            pull(plant, random.tensions(0.0, 8.0));
            plant.advance(0.001);
        }
        return plant.truth();
    };
    const PlantTruth first = run();
    const PlantTruth second = run();
    CHECK(first.pose.position_m == second.pose.position_m);
    CHECK(first.pose.r1_m == second.pose.r1_m);
    CHECK(first.pose.r2_m == second.pose.r2_m);
    CHECK(first.twist.angular_rad_s == second.twist.angular_rad_s);
    CHECK(first.tensions_n == second.tensions_n);
    CHECK(first.energy_to_hand_j == second.energy_to_hand_j);
    CHECK(glm::length(first.pose.position_m) > 0.0); // it did move
}

TEST_CASE("plant: time steps add up whatever they are cut into") {
    SimulatedPlant sixtieths((PlantSettings()));
    for (int i = 0; i < 60; ++i) {
        sixtieths.advance(1.0 / 60.0);
    }
    CHECK(std::abs(sixtieths.time_s() - 1.0) < 1.01 / kPlantRate_hz);
    SimulatedPlant tiny((PlantSettings()));
    for (int i = 0; i < 1000; ++i) {
        tiny.advance(0.1 / kPlantRate_hz);
    }
    CHECK(std::abs(tiny.time_s() - 100.0 / kPlantRate_hz) < 1.01 / kPlantRate_hz);
}
