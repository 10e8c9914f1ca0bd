// What a game does wrong: it stops, stalls, or asks for nonsense.
#include <doctest/doctest.h>

#include <algorithm>
#include <limits>
#include <random>

#include <glm/geometric.hpp>

#include "support/fault_table.h"

namespace spidar::test {

namespace {

constexpr double kForce_n = 3.0;

double force_of(const ServoSnapshot &now) {
    return glm::length(now.requested.force_n);
}

Answer wrench_not_renewed(HandFirmness hand) {
    FaultRig rig(hand);
    rig.ask({Vec3(0.0, 0.0, kForce_n), Vec3(0.0), 0.0});
    rig.activate();
    while (rig.ticks % 16 != 1) { // the last request has just arrived
        rig.tick();
    }
    rig.game_runs = false;
    rig.mark();
    rig.run_ms(48);
    CHECK(force_of(rig.now) == doctest::Approx(kForce_n));
    rig.run_ms(26); // 75 ms after it arrived: half
    CHECK(force_of(rig.now) == doctest::Approx(0.5 * kForce_n).epsilon(0.03));
    const double gone_ms = rig.until([](const auto &now) { return force_of(now) == 0.0; }, 100);
    rig.run_ms(50);
    CHECK(rig.now.state == DeviceState::active);
    CHECK(rig.now.tensions_n[0] > 0.0); // pretension stays
    return rig.answer(gone_ms);
}

Answer contacts_not_renewed(HandFirmness hand) {
    FaultRig rig(hand);
    ContactPlane &plane = rig.command.contacts[0];
    plane.normal = Vec3(0.0, 1.0, 0.0);
    plane.offset_m = 0.01; // the hand stands a centimetre inside
    rig.command.contact_count = 1;
    rig.activate();
    const double before_n = force_of(rig.now);
    REQUIRE(before_n > 0.5);
    rig.game_runs = false;
    rig.mark();
    rig.run_ms(80);
    CHECK(force_of(rig.now) == doctest::Approx(before_n).epsilon(0.1));
    const double gone_ms = rig.until([](const auto &now) { return force_of(now) < 1e-6; }, 300);
    CHECK(rig.now.state == DeviceState::active);
    const Answer answer = rig.answer(gone_ms);
    rig.game_runs = true; // it comes back by itself
    rig.run_ms(150);
    CHECK(force_of(rig.now) > 0.6 * before_n);
    return answer;
}

// Zeroed at home, and moved until the zero is believed.
void calibrate(FaultRig &rig, bool confirm) {
    rig.command.forces_enabled = false;
    rig.run_ms(100);
    rig.command.forces_enabled = true;
    ++rig.command.zero_count;
    rig.run_ms(700);
    REQUIRE(rig.now.state == DeviceState::taut);
    const Vec3 ways_m[] = {Vec3(0.04, 0.03, 0.0), Vec3(-0.04, 0.0, 0.03), Vec3(0.03, -0.03, 0.0)};
    for (int i = 0; confirm && i < 6 && rig.now.state == DeviceState::taut; ++i) {
        rig.move_hand(ways_m[i % 3]);
        rig.run_ms(500);
    }
    REQUIRE(rig.now.state == (confirm ? DeviceState::calibrated : DeviceState::taut));
    REQUIRE_FALSE(rig.motors_off());
}

// What is held at pretension alone goes as play does.
double stalled_in_calibration(HandFirmness hand, bool confirm) {
    FaultRig rig(hand);
    calibrate(rig, confirm);
    while (rig.ticks % 16 != 1) {
        rig.tick();
    }
    rig.game_runs = false;
    rig.mark();
    const double off_ms = rig.until([&](const auto &) { return rig.motors_off(); }, 600);
    CHECK(rig.now.state == DeviceState::connected);
    CHECK(rig.now.zero_known == confirm);
    CHECK(rig.events_of(DeviceEventKind::game_stalled) == 1);
    rig.run_ms(1000);
    CHECK(rig.motors_off());
    CHECK(rig.energy_j < 0.05);
    return off_ms;
}

Answer game_stalled(HandFirmness hand) {
    const double taut_ms = stalled_in_calibration(hand, false);
    const double calibrated_ms = stalled_in_calibration(hand, true);
    REQUIRE(std::min(taut_ms, calibrated_ms) >= 0.0);
    FaultRig rig(hand);
    rig.ask({Vec3(0.0, 0.0, kForce_n), Vec3(0.0), 0.0});
    rig.activate();
    rig.game_runs = false;
    rig.mark();
    const double off_ms = rig.until([&](const auto &) { return rig.motors_off(); }, 600);
    CHECK(rig.now.state == DeviceState::connected);
    CHECK(rig.events_of(DeviceEventKind::game_stalled) == 1);
    rig.run_ms(1000);
    CHECK(rig.motors_off());            // for as long as it sleeps
    Answer answer = rig.answer(off_ms); // what comes after is asked for again
    answer.response_ms = std::max({off_ms, taut_ms, calibrated_ms});
    rig.game_runs = true; // a simulated device arms itself again, a real one would wait
    rig.run_ms(300);
    CHECK(rig.now.state == DeviceState::active);
    return answer;
}

// None of these may change what is felt, nor last.
Answer nonsense(HandFirmness hand, std::span<const double> values) {
    FaultRig rig(hand);
    rig.ask({Vec3(0.0, 0.0, kForce_n), Vec3(0.0), 0.0});
    rig.activate();
    const Wrench good = rig.asked;
    rig.mark();
    const std::uint64_t refused = rig.now.counters.rejected_requests;
    std::uint64_t sent = 0;
    for (const double value : values) {
        for (std::size_t dof = 0; dof < kDofCount; ++dof) {
            PaperWrench q = to_paper(good);
            q[dof] = value;
            rig.asked = from_paper(q);
            rig.run_ms(16);
            ++sent;
            CHECK(force_of(rig.now) == doctest::Approx(kForce_n));
            rig.asked = good;
            rig.run_ms(32);
        }
    }
    CHECK(rig.now.counters.rejected_requests == refused + sent);
    CHECK(rig.now.state == DeviceState::active);
    return rig.answer(0.0);
}

Answer nan_wrench(HandFirmness hand) {
    const double values[] = {std::numeric_limits<double>::quiet_NaN()};
    return nonsense(hand, values);
}

Answer infinite_wrench(HandFirmness hand) {
    const double infinity = std::numeric_limits<double>::infinity();
    const double values[] = {infinity, -infinity};
    const Answer answer = nonsense(hand, values);
    // Finite, but beyond all reason: brought down to the limit, not refused.
    FaultRig rig(hand);
    rig.activate();
    rig.mark();
    for (const double value : {1e30, 1e308, -1e308, 5e-324}) {
        rig.ask({Vec3(0.0, value, 0.0), Vec3(0.0), 0.0});
        rig.run_ms(17);
        CHECK(force_of(rig.now) <= rig.settings.safety.max_force_n + 1e-9);
        CHECK(rig.now.counters.gate_clamps == 0);
    }
    return answer;
}

Answer huge_wrench(HandFirmness hand) {
    FaultRig rig(hand);
    rig.activate();
    rig.mark();
    const Vec3 asked_n(60.0, 0.0, 80.0); // 100 N
    rig.ask({asked_n, Vec3(0.0), 0.0});
    const double limited_ms =
        rig.until([](const auto &now) { return now.counters.clamped_requests > 0; }, 20);
    rig.run_ms(2);
    CHECK(force_of(rig.now) == doctest::Approx(rig.settings.safety.max_force_n));
    CHECK(glm::length(glm::cross(rig.now.requested.force_n, asked_n)) <
          1e-9 * glm::length(asked_n)); // same direction
    rig.ask({});
    return rig.answer(limited_ms);
}

Answer wrench_step(HandFirmness hand) {
    FaultRig rig(hand);
    rig.activate();
    while (rig.ticks % 16 != 0) {
        rig.tick();
    }
    rig.ask({Vec3(8.0, 0.0, 0.0), Vec3(0.0), 0.0});
    rig.mark();
    StringArray before_n = rig.now.tensions_n;
    double risen_ms = -1.0;
    for (int ms = 1; ms <= 30; ++ms) {
        rig.tick();
        for (std::size_t i = 0; i < kStringCount; ++i) {
            CHECK(std::abs(rig.now.tensions_n[i] - before_n[i]) <=
                  rig.settings.safety.tension_slew_n_per_ms + 1e-9);
        }
        before_n = rig.now.tensions_n;
        if (risen_ms < 0.0 && rig.now.achieved.force_n.x >= 0.9 * 8.0) {
            risen_ms = ms;
        }
    }
    CHECK(risen_ms >= 3.0);
    rig.ask({});
    return {risen_ms, rig.tension_n, 0.0,
            rig.peak_speed_m_s}; // 8 N are asked for: no fault's energy
}

Answer stiff_contact(HandFirmness hand) {
    FaultRig rig(hand);
    ContactPlane &plane = rig.command.contacts[0];
    plane.normal = Vec3(0.0, 1.0, 0.0);
    plane.offset_m = -0.002;
    plane.stiffness_n_m = 1e6;
    plane.damping_n_s_m = 1e6;
    rig.command.contact_count = 1;
    rig.activate();
    rig.mark();
    CHECK(rig.now.counters.clamped_requests > 0);
    rig.move_hand(Vec3(0.0, -0.006, 0.0)); // gently into it
    rig.run_ms(300);
    // 4 mm at the cap of 2000 N/m, not at 1e6.
    CHECK(force_of(rig.now) <= rig.settings.safety.max_force_n + 1e-9);
    return rig.answer(0.0);
}

Answer impossible_wrenches(HandFirmness hand) {
    FaultRig rig(hand);
    rig.hand_moves = true;
    rig.activate();
    rig.mark();
    std::mt19937_64 engine(38);
    std::uniform_real_distribution<double> any(-1.0, 1.0);
    for (int i = 0; i < 40; ++i) {
        rig.ask({4.0 * Vec3(any(engine), any(engine), any(engine)),
                 0.4 * Vec3(any(engine), any(engine), any(engine)), 0.4 * any(engine)});
        rig.run_ms(16);
        rig.ask({});
        rig.run_ms(16);
    }
    CHECK(rig.now.counters.saturated_ticks > 0); // some were more than eight strings can give
    CHECK(rig.now.counters.gate_clamps == 0);
    return {0.0, rig.tension_n, 0.0,
            rig.peak_speed_m_s}; // these forces are asked for: no fault's energy
}

constexpr FaultRow kRows[] = {
    {1, "no new command, wrench", 101.0, 0.0, wrench_not_renewed},
    {2, "no new command, contacts", 301.0, 0.0, contacts_not_renewed},
    {3, "game paused", 525.0, 0.0, game_stalled},
    {9, "NaN in a wrench", 1.0, 0.0, nan_wrench},
    {10, "infinity or 1e308 in a wrench", 1.0, 0.0, infinite_wrench},
    {11, "huge finite wrench", 17.0, 0.0, huge_wrench},
    {12, "wrench step", 16.0, 0.0, wrench_step},
    {14, "stiffness and damping over their caps", 1.0, 0.0, stiff_contact},
    {38, "wrenches that strings cannot give", 1.0, 0.0, impossible_wrenches},
};

} // namespace

std::span<const FaultRow> rows_of_game() {
    return kRows;
}

} // namespace spidar::test
