// The whole device: plant, encoders, kinematics, requests, tensions, motors, and the hand that feels them.
#include <doctest/doctest.h>

#include <cmath>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "device/step/tension_diagnosis.h"
#include "support/servo_fixture.h"

using namespace spidar;
using spidar::test::ideal_settings;

namespace {

PlantSettings ideal_plant() {
    PlantSettings plant;
    plant.elastic = false;
    plant.coulomb_friction_n = 0.0;
    plant.viscous_friction_n_s_m = 0.0;
    return plant;
}

struct Device {
    explicit Device(const PlantSettings &plant) {
        auto made = std::make_unique<SimulatedTransport>(plant);
        transport = made.get();
        settings = ideal_settings();
        settings.strings = calibrate_at_home(
            string_lengths(settings.frame, settings.grip, rest_pose(settings.grip)),
            transport->home_counts(), kPaperMetresPerCount);
        loop = std::make_unique<ServoLoop>(std::move(made));
        started = loop->start_stepped(settings);
        command.forces_enabled = true;
    }
    // Game ticks at 60 Hz, each renewing what is asked for.
    void play(int ticks) {
        for (int i = 0; i < ticks; ++i) {
            ++command.wrench_sequence;
            ++command.contacts_sequence;
            loop->publish(command);
            loop->advance(1, 60);
        }
        loop->latest(snapshot);
        truth = transport->truth();
    }
    void ask(const Wrench &wrench) {
        command.wrench = wrench;
        command.wrench_duration_s = 0.05;
    }

    SimulatedTransport *transport = nullptr;
    ServoSettings settings;
    std::unique_ptr<ServoLoop> loop;
    Status started = Status::not_open;
    HapticCommand command;
    ServoSnapshot snapshot;
    PlantTruth truth;
};

Wrench unit_wrench(int dof, double sign) {
    // The 2 N, 50 N mm and 25 N mm of grasp torque.
    PaperWrench q{};
    q[static_cast<std::size_t>(dof)] = sign * (dof < 3 ? 2.0 : 0.05); // g = 2 grasp_torque
    return from_paper(q);
}

} // namespace

TEST_CASE("closed loop: each DOF is felt by the hand within 1 % beyond the reported bias") {
    Device device(ideal_plant());
    REQUIRE(device.started == Status::ok);
    device.play(90);
    REQUIRE(device.snapshot.state == DeviceState::active);
    for (int dof = 0; dof < kDofCount; ++dof) {
        for (const double sign : {1.0, -1.0}) {
            const Wrench asked = unit_wrench(dof, sign);
            device.ask(asked);
            device.play(60);
            const PaperWrench q = to_paper(asked);
            const PaperWrench felt = to_paper(device.truth.strings);
            const PaperWrench bias = tension_report(device.settings, device.snapshot).bias();
            CAPTURE(dof);
            CAPTURE(sign);
            for (std::size_t k = 0; k < felt.size(); ++k) {
                // Moments in newtons at the pole ends, to compare with forces.
                const double d = device.settings.grip.pole_half_length_m;
                const double size = (dof < 3 ? 2.0 : 0.05 / d) * (k < 3 ? 1.0 : d);
                CAPTURE(k);
                CHECK(std::abs(felt[k] - q[k] - bias[k]) < 0.01 * size);
            }
            // Wherever the hand was pushed to, the pose is the true one, to the encoders' resolution.
            CHECK(glm::distance(device.snapshot.grip.pose.position_m,
                                device.truth.pose.position_m) < 5e-5);
        }
    }
}

TEST_CASE("closed loop: work = wrench x displacement in all seven DOF, by moving the hand") {
    Device device(ideal_plant());
    device.play(90);
    for (int dof = 0; dof < kDofCount; ++dof) {
        const Wrench asked = unit_wrench(dof, 1.0);
        device.ask(asked);
        device.transport->set_hand_target(HandTarget());
        device.play(90);
        const PlantTruth before = device.truth;
        const double step = dof < 3 ? 0.02 : 0.2;
        HandTarget target;
        if (dof < 3) {
            target.position_m[dof] = step;
        } else if (dof < 6) {
            Vec3 axis(0.0);
            axis[dof - 3] = 1.0;
            target.rotation = glm::mat3_cast(glm::angleAxis(step, axis));
        } else {
            target.grasp_angle_rad = step;
        }
        device.transport->set_hand_target(target);
        device.play(90);
        const double work_j = device.truth.energy_to_hand_j - before.energy_to_hand_j;
        double moved = 0.0;
        if (dof < 3) {
            moved = device.truth.pose.position_m[dof] - before.pose.position_m[dof];
        } else if (dof < 6) {
            const glm::dquat turn =
                glm::quat_cast(device.truth.frame.rotation * glm::transpose(before.frame.rotation));
            moved = glm::angle(turn) * glm::axis(turn)[dof - 3];
        } else {
            moved = device.truth.frame.grasp_angle_rad - before.frame.grasp_angle_rad;
        }
        const double amount = dof < 3 ? 2.0 : dof < 6 ? 0.05 : 0.025;
        CAPTURE(dof);
        CHECK(moved > 0.5 * step);
        CHECK(work_j / (amount * moved) == doctest::Approx(1.0).epsilon(0.03));
    }
}

TEST_CASE("closed loop: a contact plane stops the hand, as deep as force / stiffness") {
    for (const bool elastic : {false, true}) {
        PlantSettings plant = ideal_plant();
        plant.elastic = elastic;
        Device device(plant);
        device.play(90);
        ContactPlane floor;
        floor.normal = Vec3(0.0, 0.0, 1.0);
        floor.offset_m = -0.01;
        floor.id = 5;
        device.command.contacts[0] = floor;
        device.command.contact_count = 1;
        HandTarget target;
        target.position_m.z = -0.03;
        device.transport->set_hand_target(target);
        device.play(120);
        const double depth_m = floor.offset_m - device.truth.pose.position_m.z;
        const double felt_n = device.truth.strings.force_n.z;
        CAPTURE(elastic);
        CHECK(depth_m > 0.001);
        CHECK(depth_m <
              0.02 * 300.0 / (300.0 + 350.0) + 1e-3); // the hand's spring against the plane's
        CHECK(felt_n ==
              doctest::Approx(floor.stiffness_n_m * depth_m).epsilon(elastic ? 0.15 : 0.03));
        CHECK(device.snapshot.contacts[0].touching);
        CHECK(device.snapshot.contacts[0].impulse_ns.z > 0.0);
        // Away again: free.
        device.transport->set_hand_target(HandTarget());
        device.play(120);
        CHECK_FALSE(device.snapshot.contacts[0].touching);
        CHECK(std::abs(device.truth.pose.position_m.z) < 1e-3);
    }
}

TEST_CASE("closed loop: a grasp stop holds the hand open") {
    Device device(ideal_plant());
    device.play(90);
    ContactPlane stop;
    stop.target = ContactTarget::grasp_stop;
    stop.normal = Vec3(-1.0, 0.0, 0.0);
    stop.offset_m = -0.3;
    stop.stiffness_n_m = 0.25;
    stop.damping_n_s_m = 0.001;
    device.command.contacts[0] = stop;
    device.command.contact_count = 1;
    HandTarget target;
    target.grasp_angle_rad = 0.6;
    device.transport->set_hand_target(target);
    device.play(120);
    const double past_rad = device.truth.frame.grasp_angle_rad - 0.3;
    CHECK(past_rad > 0.0);
    CHECK(past_rad < 0.29);
    CHECK(device.truth.strings.grasp_torque_nm == doctest::Approx(-0.25 * past_rad).epsilon(0.05));
}

TEST_CASE(
    "closed loop: unplugging ends in closed with motors off, jumps in a fault with the string") {
    Device device((PlantSettings()));
    device.play(90);
    REQUIRE(device.snapshot.state == DeviceState::active);
    device.transport->inject({SimulatedFault::count_jump, 4, 0.0, 0.0});
    device.play(2);
    CHECK(device.snapshot.state == DeviceState::fault);
    CHECK(device.snapshot.fault == Status::count_jump);
    CHECK(device.snapshot.fault_string == 4);
    CHECK(device.snapshot.tensions_n == StringArray{});
    device.transport->clear_faults();
    device.play(1); // the report that is under way still has the jump
    ++device.command.clear_fault_count;
    device.play(2);
    ++device.command.arm_count;
    device.play(90);
    REQUIRE(device.snapshot.state == DeviceState::active);
    device.transport->inject({SimulatedFault::unplugged, 0, 0.0, 0.0});
    device.play(2);
    CHECK(device.snapshot.state == DeviceState::closed);
    CHECK(device.snapshot.tensions_n == StringArray{});
}

TEST_CASE("closed loop: stepped runs are the same to the last bit") {
    const auto run = [] {
        Device device((PlantSettings()));
        HandTarget target;
        std::vector<double> record;
        for (int i = 0; i < 120; ++i) {
            target.position_m = Vec3(0.05 * std::sin(0.1 * i), 0.03 * std::cos(0.07 * i), -0.02);
            target.grasp_angle_rad = 0.4 * std::sin(0.05 * i);
            device.transport->set_hand_target(target);
            device.ask(unit_wrench(i % kDofCount, 1.0));
            ContactPlane plane;
            plane.friction = 0.4;
            device.command.contacts[0] = plane;
            device.command.contact_count = 1;
            device.play(1);
            const ServoSnapshot &s = device.snapshot;
            record.insert(record.end(), s.tensions_n.begin(), s.tensions_n.end());
            for (int k = 0; k < 3; ++k) {
                record.push_back(s.grip.pose.position_m[k]);
                record.push_back(s.grip.twist.angular_rad_s[k]);
                record.push_back(s.contacts[0].impulse_ns[k]);
                record.push_back(device.truth.pose.r1_m[k]);
            }
        }
        return record;
    };
    const std::vector<double> first = run();
    CHECK(first.size() == 120U * 20U);
    CHECK(first == run());
}
