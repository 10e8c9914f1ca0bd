// What the wire and the clock do wrong.
#include <doctest/doctest.h>

#include <glm/geometric.hpp>

#include "support/fault_table.h"

namespace spidar::test {

namespace {

const Wrench kWrench{Vec3(0.0, 0.0, 3.0), Vec3(0.0), 0.0};

FaultRig in_play(HandFirmness hand) {
    FaultRig rig(hand);
    rig.hand_moves = true;
    rig.ask(kWrench);
    rig.activate();
    return rig;
}

Answer reports_late(HandFirmness hand) {
    FaultRig rig = in_play(hand);
    const double before_n = rig.now.requested.force_n.z;
    REQUIRE(rig.inject(SimulatedFault::read_timeout, 0, 0.010));
    rig.mark();
    const double fades_ms =
        rig.until([&](const auto &now) { return now.requested.force_n.z < 0.99 * before_n; }, 10);
    rig.run_ms(100);
    CHECK(rig.now.state == DeviceState::active);
    CHECK(rig.now.requested.force_n.z == doctest::Approx(before_n)); // it comes back
    CHECK(rig.events_of(DeviceEventKind::reports_late) == 1);
    return rig.answer(fades_ms);
}

Answer reports_stopped(HandFirmness hand) {
    FaultRig rig = in_play(hand);
    REQUIRE(rig.inject(SimulatedFault::read_timeout));
    rig.mark();
    const double off_ms = rig.until([&](const auto &) { return rig.motors_off(); }, 30);
    CHECK(rig.now.fault == Status::read_timeout);
    CHECK(rig.events_of(DeviceEventKind::reports_stopped) == 1);
    rig.run_ms(300);
    CHECK(rig.now.state == DeviceState::fault);
    return rig.answer(off_ms);
}

Answer reports_disordered(HandFirmness hand) {
    FaultRig rig = in_play(hand);
    rig.mark();
    REQUIRE(rig.inject(SimulatedFault::reports_lost));
    rig.run_ms(700);
    CHECK(rig.now.counters.reports_missed >= 5);
    rig.device->clear_faults();
    REQUIRE(rig.inject(SimulatedFault::reports_repeated));
    rig.run_ms(700);
    const std::uint64_t repeated = rig.now.counters.old_reports;
    CHECK(repeated >= 5);
    rig.device->clear_faults();
    REQUIRE(rig.inject(SimulatedFault::reports_swapped));
    rig.run_ms(700);
    CHECK(rig.now.counters.old_reports >= repeated + 5);
    CHECK(rig.now.state == DeviceState::active);
    CHECK(rig.now.safety_scale == 1.0); // nothing is felt of it
    CHECK(rig.now.counters.bad_samples == 0);
    return rig.answer(0.0);
}

Answer unplugged(HandFirmness hand) {
    FaultRig rig = in_play(hand);
    REQUIRE(rig.inject(SimulatedFault::unplugged, 0, 2.0));
    rig.mark();
    const double off_ms =
        rig.until([&](const auto &now) { return now.state == DeviceState::closed; }, 5);
    CHECK(rig.motors_off());
    CHECK(rig.events_of(DeviceEventKind::device_lost) == 1);
    rig.run_ms(2500); // plugged in again
    CHECK(rig.now.state == DeviceState::closed);
    ++rig.command.clear_fault_count;
    rig.run_ms(300);
    CHECK(rig.now.state == DeviceState::connected); // and not armed
    return rig.answer(off_ms);
}

Answer device_restarted(HandFirmness hand) {
    FaultRig rig = in_play(hand);
    REQUIRE(rig.inject(SimulatedFault::counts_reset));
    rig.mark();
    const double off_ms = rig.until([&](const auto &) { return rig.motors_off(); }, 5);
    CHECK(rig.now.fault == Status::device_restarted);
    CHECK_FALSE(rig.now.zero_known);
    const Answer answer = rig.answer(off_ms);
    ++rig.command.clear_fault_count;
    ++rig.command.arm_count;
    rig.run_ms(300);
    CHECK(rig.now.state == DeviceState::connected);
    CHECK(rig.motors_off());
    CHECK(rig.events_of(DeviceEventKind::zero_needed) > 0);
    // At home, zeroed, moved: then it may arm.
    rig.ask({});
    rig.hand_moves = false;
    rig.run_ms(500);
    ++rig.command.zero_count;
    rig.run_ms(700);
    CHECK(rig.now.state == DeviceState::taut);
    rig.move_hand(Vec3(0.04, 0.03, 0.0));
    rig.run_ms(500);
    rig.move_hand(Vec3(-0.04, 0.0, 0.03));
    rig.run_ms(500);
    rig.move_hand(Vec3(0.03, -0.03, 0.0));
    rig.run_ms(700);
    CHECK(rig.now.zero_known);
    ++rig.command.arm_count;
    rig.run_ms(300);
    CHECK(rig.now.state == DeviceState::active);
    CHECK(glm::distance(rig.now.grip.pose.position_m, rig.device->truth().pose.position_m) < 1e-3);
    return answer;
}

// A motion at 2 m/s across a border of the counters must be felt as nothing.
Answer counts_cross(std::int64_t border) {
    for (const double direction : {1.0, -1.0}) {
        Bench bench;
        // Half way through the motion string 0 is at the border.
        bench.settings.strings.zero_count.fill(
            static_cast<std::int32_t>(static_cast<std::uint32_t>(border)));
        bench.settings.safety.arming_time_s = 0.01;
        bench.start();
        REQUIRE(bench.started == Status::ok);
        bench.put(moved_by(bench.settings, Vec3(0.0)));
        bench.command.forces_enabled = true;
        bench.tick(20);
        REQUIRE(bench.now().state == DeviceState::active);
        double speed_m_s = 0.0;
        double x = 0.0;
        for (int i = 0; i < 200; ++i) { // up to 1.1 m/s and back, across the border and again
            speed_m_s = direction * 1.1 * std::sin(2.0 * 3.14159265358979 * i / 200.0);
            x += speed_m_s * kTick_s;
            const GripPose pose = moved_by(bench.settings, Vec3(x, -0.5 * x, 0.0));
            bench.put(pose);
            bench.tick();
            CHECK(glm::distance(bench.now().grip.pose.position_m, pose.position_m) < 1e-4);
        }
        CHECK(bench.now().counters.bad_samples == 0);
        CHECK(bench.now().state == DeviceState::active);
    }
    return {0.0, 0.0, 0.0, 0.0};
}

// Counts are 32 bits wide from the device on: passing 16 bits is nothing special.
Answer counts_pass_16_bits(HandFirmness) {
    static_assert(sizeof(DeviceReading{}.counts[0]) == 4);
    (void)counts_cross(-32768);
    return counts_cross(32767);
}

Answer counts_wrap_32_bits(HandFirmness) {
    return counts_cross(2147483647);
}

Answer encoder_jumps(HandFirmness hand) {
    {
        FaultRig rig = in_play(hand);
        REQUIRE(rig.inject(SimulatedFault::count_jump, 3, 0.0015)); // once
        rig.mark();
        rig.run_ms(50);
        CHECK(rig.now.state == DeviceState::active);
        CHECK(rig.now.counters.bad_samples == 1);
        CHECK(rig.energy_j < 0.05);
    }
    FaultRig rig = in_play(hand);
    REQUIRE(rig.inject(SimulatedFault::count_jump, 3));
    rig.mark();
    const double off_ms = rig.until([&](const auto &) { return rig.motors_off(); }, 10);
    CHECK(rig.now.fault == Status::count_jump);
    CHECK(rig.now.fault_string == 3);
    rig.run_ms(300);
    return rig.answer(off_ms);
}

Answer clock_jumps(HandFirmness) {
    double worst_ms = 0.0;
    for (const double dt_s : {-1.0, 0.2, 3600.0, std::nan("")}) {
        Bench bench;
        bench.simulated = false;
        bench.settings.safety.arming_time_s = 0.05;
        bench.start();
        bench.command.forces_enabled = true;
        ++bench.command.arm_count;
        bench.tick(100);
        REQUIRE(bench.now().state == DeviceState::active);
        bench.ask({Vec3(0.0, 0.0, 2.0), Vec3(0.0), 0.0}, 1.0);
        bench.tick(5);
        bench.tick(1, dt_s);
        CHECK(bench.now().state == DeviceState::fading);
        CHECK(bench.now().counters.bad_time_steps == 1);
        CHECK(std::isfinite(bench.now().time_s));
        CHECK(glm::length(bench.now().grip.twist.linear_m_s) == 0.0);
        int ms = 1;
        while (!bench.motors_off() && ms < 100) {
            bench.tick();
            ++ms;
        }
        worst_ms = std::max(worst_ms, static_cast<double>(ms));
        bench.tick(300);
        CHECK(bench.now().state == DeviceState::connected); // until arm()
    }
    return {worst_ms, 0.0, 0.0, 0.0};
}

constexpr FaultRow kRows[] = {
    {4, "no report for 5 ms", 6.0, 0.0, reports_late},
    {5, "no report for 20 ms", 20.0, 0.0, reports_stopped},
    {6, "lost, repeated, swapped reports", 1.0, 0.0, reports_disordered},
    {7, "unplugged", 5.0, 0.0, unplugged},
    {8, "device restarted, counts reset", 3.0, 0.0, device_restarted},
    {15, "counts pass 16 bits", 1.0, 0.0, counts_pass_16_bits},
    {16, "counts wrap at 32 bits", 1.0, 0.0, counts_wrap_32_bits},
    {17, "encoder jumps", 4.0, 0.0, encoder_jumps},
    {29, "clock jumps, computer slept", 25.0, 0.0, clock_jumps},
};

} // namespace

std::span<const FaultRow> rows_of_link() {
    return kRows;
}

} // namespace spidar::test
