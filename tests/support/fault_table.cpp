#include "support/fault_table.h"

#include <algorithm>
#include <numbers>

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

namespace spidar::test {

namespace {

constexpr int kGamePeriod_ms = 16;
constexpr double kCircle_m = 0.03;
constexpr double kHandSpeed_m_s = 0.15;

} // namespace

FaultRig::FaultRig(HandFirmness hand, const PlantSettings &from) {
    PlantSettings plant = from;
    plant.firmness = hand;
    auto made = std::make_unique<SimulatedTransport>(plant);
    device = made.get();
    settings = ideal_settings();
    settings.safety.arming_time_s = 0.1;
    settings.strings =
        calibrate_at_home(string_lengths(settings.frame, settings.grip, rest_pose(settings.grip)),
                          made->home_counts(), kPaperMetresPerCount);
    loop = std::make_unique<ServoLoop>(std::move(made));
    REQUIRE(loop->start_stepped(settings) == Status::ok);
    command.heartbeat = 1;
}

void FaultRig::tick() {
    if (game_runs && ticks % kGamePeriod_ms == 0) {
        ++command.heartbeat;
        ++command.wrench_sequence;
        command.wrench = asked;
        command.wrench_duration_s = 0.05;
        command.contacts_sequence += contacts_renew ? 1U : 0U;
        loop->publish(command);
    }
    Vec3 target_m = hand_m;
    if (hand_moves) {
        const double turn = kHandSpeed_m_s / kCircle_m * 1e-3 * static_cast<double>(ticks);
        target_m += kCircle_m * Vec3(std::sin(turn), std::cos(turn) - 1.0, 0.6 * std::sin(turn));
    }
    HandTarget target;
    target.position_m = target_m;
    target.grasp_angle_rad = hand_grasp_rad;
    device->set_hand_target(target);
    REQUIRE(loop->advance(1, 1000) == 1);
    ++ticks;
    (void)loop->latest(now);
    DeviceEvent event;
    while (loop->next_event(event)) {
        events.push_back(event);
    }
    const PlantTruth truth = device->truth();
    tension_n =
        std::max(tension_n, *std::max_element(now.tensions_n.begin(), now.tensions_n.end()));
    energy_j = std::max(energy_j, truth.energy_to_hand_j - energy_at_mark_j);
    peak_speed_m_s = std::max(peak_speed_m_s, glm::length(truth.twist.linear_m_s));
}

void FaultRig::run_ms(int ms) {
    for (int i = 0; i < ms; ++i) {
        tick();
    }
}

void FaultRig::activate() {
    command.forces_enabled = true;
    run_ms(400);
    REQUIRE(now.state == DeviceState::active);
}

void FaultRig::move_hand(const Vec3 &position_m, double grasp_angle_rad) {
    hand_m = position_m;
    hand_grasp_rad = grasp_angle_rad;
}

bool FaultRig::inject(SimulatedFault fault, int string, double duration_s) {
    return device->inject({fault, string, 0.0, duration_s});
}

void FaultRig::mark() {
    marked_at = ticks;
    energy_at_mark_j = device->truth().energy_to_hand_j;
    tension_n = 0.0;
    energy_j = 0.0;
    peak_speed_m_s = 0.0;
    events.clear();
}

int FaultRig::events_of(DeviceEventKind kind) const {
    return static_cast<int>(std::count_if(events.begin(), events.end(),
                                          [kind](const DeviceEvent &e) { return e.kind == kind; }));
}

} // namespace spidar::test
