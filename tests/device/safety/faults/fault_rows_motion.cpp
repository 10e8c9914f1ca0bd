// What the grip does wrong: too far, too fast, too long, too shaky.
#include <doctest/doctest.h>

#include <glm/geometric.hpp>

#include "support/fault_table.h"

namespace spidar::test {

namespace {

Answer workspace_edge(HandFirmness hand) {
    FaultRig rig(hand);
    rig.activate();
    rig.mark();
    rig.move_hand(Vec3(0.3, 0.3, 0.3)); // the hand's own reach ends at 0.2
    const double told_ms = rig.until(
        [&](const auto &) { return rig.events_of(DeviceEventKind::workspace_edge) > 0; }, 1500);
    rig.run_ms(500);
    CHECK(rig.now.state == DeviceState::active);
    const Vec3 &push_n = rig.now.requested.force_n;
    CHECK(push_n.x + push_n.y + push_n.z < -0.2); // inwards, as far as this hand pushes
    CHECK(glm::length(push_n) < 6.0);
    const Answer answer = rig.answer(told_ms >= 0.0 ? 0.0 : -1.0); // when it gets there
    // Poles nearly parallel, both ways: a grasp torque there has no string to act on.
    rig.move_hand(Vec3(0.0));
    rig.run_ms(1500);
    for (const double angle_rad : {1.5, -1.5}) {
        rig.ask({Vec3(0.0, 1.0, 0.0), Vec3(0.0), 0.02});
        rig.move_hand(Vec3(0.0), angle_rad);
        rig.run_ms(800);
        CHECK(rig.now.state == DeviceState::active);
        CHECK(rig.now.counters.gate_clamps == 0);
        CHECK(rig.tension_n <= rig.settings.tension.max_tension_n + 1e-9);
    }
    return answer;
}

Answer released_grip(HandFirmness hand) {
    FaultRig rig(hand);
    rig.ask({Vec3(8.0, 0.0, 0.0), Vec3(0.0), 0.0});
    rig.activate();
    rig.run_ms(300);
    REQUIRE(rig.now.requested.force_n.x > 4.0);
    REQUIRE(rig.inject(SimulatedFault::hand_released));
    rig.mark();
    const double slows_ms =
        rig.until([&](const auto &now) { return now.safety_scale < 1.0 || rig.motors_off(); }, 200);
    rig.run_ms(200);
    return rig.answer(slows_ms);
}

Answer sustained_force(HandFirmness hand) {
    FaultRig rig(hand);
    rig.ask({Vec3(8.0, 0.0, 0.0), Vec3(0.0), 0.0});
    rig.activate();
    rig.mark();
    double share = 0.0;
    double first_derated_ms = -1.0;
    const double start_n = rig.now.requested.force_n.x;
    for (int ms = 0; ms < 60000; ++ms) {
        rig.tick();
        share = std::max(share, rig.now.thermal_share);
        if (first_derated_ms < 0.0 && rig.events_of(DeviceEventKind::motors_warm) > 0) {
            first_derated_ms = ms;
        }
    }
    CHECK(share < 1.0); // never spent
    CHECK(share > 0.7);
    CHECK(rig.now.requested.force_n.x < 0.95 * start_n);
    CHECK(rig.now.requested.force_n.x > 0.2 * start_n); // derated, not switched off
    CHECK(rig.now.state == DeviceState::active);
    return rig.answer(first_derated_ms);
}

// A wall far too stiff for its latency: a light or normal hand bounces off it harder each time, a firm one is shaken.
Answer shaken(HandFirmness hand, double stiffness_n_m, bool doubled_latency) {
    FaultRig rig(hand, [] {
        PlantSettings plant;
        plant.coulomb_friction_n = 0.0;
        plant.output_latency_s = 0.004; // and as much again by the fault
        return plant;
    }());
    // A device that is not what its settings say: nothing is filtered, nothing foreseen, nothing capped.
    RenderSettings &render = rig.settings.render;
    render.string_resonance_hz = 0.0;
    render.velocity_cutoff_hz = 60.0;
    render.delay_compensation_s = 0.0;
    render.caps_from_latency = false;
    render.max_stiffness_n_m = stiffness_n_m;
    REQUIRE(rig.loop->start_stepped(rig.settings) == Status::ok);
    ContactPlane &plane = rig.command.contacts[0];
    plane.normal = Vec3(0.0, 1.0, 0.0);
    plane.offset_m = 0.0;
    plane.stiffness_n_m = stiffness_n_m;
    plane.damping_n_s_m = 5.0;
    rig.command.contact_count = 1;
    rig.activate();
    REQUIRE((!doubled_latency || rig.inject(SimulatedFault::late_output)));
    rig.mark();
    rig.move_hand(Vec3(0.0, -0.01, 0.0)); // presses into it
    const auto told = [&](const auto &) {
        return rig.events_of(DeviceEventKind::shaking) + rig.events_of(DeviceEventKind::unstable) >
               0;
    };
    const double halved_ms = rig.until(told, 1000);
    rig.run_ms(1500);
    CHECK(rig.peak_speed_m_s < 1.0);
    return rig.answer(halved_ms);
}

// The answers count from when the hand sets out for the wall.
Answer instability(HandFirmness hand) {
    const Answer stiff = shaken(hand, 3000.0, false);
    const Answer late = shaken(hand, 2000.0, true);
    CHECK(stiff.response_ms >= 0.0);
    CHECK(stiff.response_ms <= 500.0);
    return {late.response_ms, std::max(stiff.tension_n, late.tension_n),
            std::max(stiff.energy_j, late.energy_j),
            std::max(stiff.peak_speed_m_s, late.peak_speed_m_s)};
}

constexpr FaultRow kRows[] = {
    {23, "edge of the workspace", 1.0, 0.0, workspace_edge},
    {24, "grip released under 8 N", 100.0, 2.2, released_grip},
    {25, "8 N for a minute", 60000.0, 0.0, sustained_force},
    {26, "contact that shakes", 550.0, 0.0, instability},
};

} // namespace

std::span<const FaultRow> rows_of_motion() {
    return kRows;
}

} // namespace spidar::test
