// A 6-DOF device with a rigid grip, the whole way: plant, counts, kinematics, wrench, tensions, currents, plant.
#include <doctest/doctest.h>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "core/presets/presets.h"
#include "device/simulation/simulated_plant.h"
#include "support/servo_fixture.h"
#include "support/tick_checks.h"

using namespace spidar;

namespace {

struct RigidRig {
    DevicePreset device = device_preset(Preset::spidar_g6_x3r);
    PlantSettings plant_settings;
    ServoSettings settings;
    HapticCommand command;
    test::TickChecks checks;
    ServoStep step;

    RigidRig() {
        settings.frame = device.frame;
        settings.grip = device.grip;
        settings.tension.min_tension_n = device.min_tension_n;
        plant_settings.frame = device.frame;
        plant_settings.grip = device.grip;
        plant_settings.metres_per_count = device.metres_per_count;
        plant_settings.elastic = false;
        plant_settings.coulomb_friction_n = 0.0;
        plant_settings.viscous_friction_n_s_m = 0.0;
        settings.strings =
            calibrate_at_home(string_lengths(device.frame, device.grip, rest_pose(device.grip)),
                              SimulatedPlant(plant_settings).counts(), device.metres_per_count);
        REQUIRE(validate(settings) == "");
        REQUIRE(validate(plant_settings) == "");
        REQUIRE(step.configure(settings) == Status::ok);
        command.forces_enabled = true;
    }
    void run(SimulatedPlant &plant, int ticks) {
        for (int i = 0; i < ticks; ++i) {
            DeviceReading reading;
            reading.counts = plant.counts();
            const DriveCommand drive = step.step(Status::ok, reading, command, test::kTick_s, true);
            checks.check(settings, Status::ok, reading, drive, step.snapshot(), test::kTick_s);
            plant.set_currents(drive.currents_a);
            plant.advance(test::kTick_s);
        }
    }
    void ask(const Wrench &wrench) {
        ++command.wrench_sequence;
        command.wrench = wrench;
        command.wrench_duration_s = 10.0;
    }
};

} // namespace

TEST_CASE("rigid device: the pose follows the true grip, and its grasp angle is 0") {
    RigidRig rig;
    SimulatedPlant plant(rig.plant_settings);
    rig.run(plant, 1200);
    HandTarget target;
    target.position_m = Vec3(0.012, -0.01, 0.015);
    target.rotation = glm::mat3_cast(glm::angleAxis(0.35, glm::normalize(Vec3(1, 2, -1))));
    target.grasp_angle_rad = 0.5; // the hand cannot close what has no hinge
    plant.set_hand_target(target);
    rig.run(plant, 1500);
    const ServoSnapshot &now = rig.step.snapshot();
    const PlantTruth truth = plant.truth();
    CHECK(now.state == DeviceState::active);
    CHECK(glm::distance(truth.pose.position_m, target.position_m) < 0.005);
    CHECK(truth.frame.grasp_angle_rad == 0.0);
    CHECK(glm::distance(now.grip.pose.position_m, truth.pose.position_m) < 5e-5);
    CHECK(glm::distance(now.grip.pose.r1_m, truth.pose.r1_m) < 2e-4);
    CHECK(glm::distance(now.grip.pose.r2_m, truth.pose.r2_m) < 2e-4);
    CHECK(std::fabs(now.grip.frame.grasp_angle_rad) < 1e-12);
}

TEST_CASE("rigid device: force and moment asked for are felt, in all six degrees of freedom") {
    for (int dof = 0; dof < 6; ++dof) {
        RigidRig rig;
        SimulatedPlant plant(rig.plant_settings);
        rig.run(plant, 1200);
        Wrench wrench;
        (dof < 3 ? wrench.force_n : wrench.moment_nm)[dof % 3] = dof < 3 ? 2.0 : 0.03;
        rig.ask(wrench);
        rig.run(plant, 1000);
        const Wrench felt = plant.truth().strings;
        const ServoSnapshot &now = rig.step.snapshot();
        CAPTURE(dof);
        CHECK(usable(now.tension_status)); // a string at its least tension is no failure
        CHECK(glm::distance(felt.force_n, wrench.force_n) < 0.05);
        CHECK(glm::distance(felt.moment_nm, wrench.moment_nm) < 0.002);
        CHECK(felt.grasp_torque_nm == 0.0);
        // And the report agrees with the plant.
        CHECK(glm::distance(now.achieved.force_n, felt.force_n) < 0.02);
        CHECK(glm::distance(now.achieved.moment_nm, felt.moment_nm) < 0.001);
    }
}

TEST_CASE("rigid device: a grasp torque is left out, flagged with its own status, and the rest is "
          "given") {
    RigidRig rig;
    SimulatedPlant plant(rig.plant_settings);
    rig.run(plant, 1200);
    Wrench wrench;
    wrench.force_n = Vec3(0.0, 1.5, 0.0);
    wrench.grasp_torque_nm = 0.1;
    rig.ask(wrench);
    rig.run(plant, 500);
    const ServoSnapshot &now = rig.step.snapshot();
    CHECK(now.tension_status == Status::grasp_unavailable);
    CHECK(now.requested.grasp_torque_nm == 0.0);
    CHECK(std::fabs(now.achieved.force_n.y - 1.5) < 0.05);
    wrench.grasp_torque_nm = 0.0;
    rig.ask(wrench);
    rig.run(plant, 100);
    CHECK(rig.step.snapshot().tension_status != Status::grasp_unavailable);
}
