// What strings and encoders do wrong.
#include <doctest/doctest.h>

#include <cstdlib>

#include <glm/geometric.hpp>

#include "core/kinematics/forward_kinematics.h"
#include "device/faults/fault_table.h"

namespace spidar::test {

namespace {

FaultRig in_play(HandFirmness hand) {
    FaultRig rig(hand);
    rig.hand_moves = true;
    rig.ask({Vec3(0.0, 0.0, 1.0), Vec3(0.0), 0.0});
    rig.activate();
    return rig;
}

// Disagreement of the lengths that a fault has to show before it can be told from stretch and calibration.
constexpr double kVisible_m = 0.0035;

// What no pose explains of the lengths as they are read, by a solution of its own. At some poses another pose explains
// a wrong string nearly as well as none: then nothing shows until the grip has moved on.
double visible_error_m(const FaultRig &rig) {
    ForwardKinematics kinematics;
    REQUIRE(kinematics.configure(rig.settings.frame, rig.settings.grip) == Status::ok);
    const KinematicsResult solved =
        kinematics.solve_cold(lengths_from_counts(rig.settings.strings, rig.now.counts));
    return std::sqrt(double{kStringCount}) * solved.residual_rms_m;
}

// Motors off by a string fault, whichever string it is; the worst answer of all eight, from when the fault shows.
// One that does not show does no harm either: the energy given to the hand stays within the same bound.
Answer of_each_string(HandFirmness hand, SimulatedFault fault) {
    Answer worst{0.0, 0.0, 0.0, 0.0};
    int shown = 0;
    for (int string = 0; string < kStringCount; ++string) {
        CAPTURE(string);
        FaultRig rig = in_play(hand);
        REQUIRE(rig.inject(fault, string));
        rig.mark();
        const double shows_ms = rig.until(
            [&](const auto &) { return rig.motors_off() || visible_error_m(rig) > kVisible_m; },
            1500);
        if (shows_ms >= 0.0) {
            ++shown;
            const double off_ms = rig.until([&](const auto &) { return rig.motors_off(); }, 1500);
            if (off_ms < 0.0) {
                return rig.answer(off_ms);
            }
            worst.response_ms = std::max(worst.response_ms, off_ms - shows_ms);
            rig.run_ms(300);
        }
        const Answer answer = rig.answer(0.0);
        worst.tension_n = std::max(worst.tension_n, answer.tension_n);
        worst.energy_j = std::max(worst.energy_j, answer.energy_j);
        worst.peak_speed_m_s = std::max(worst.peak_speed_m_s, answer.peak_speed_m_s);
    }
    CHECK(shown >= 2);
    return worst;
}

Answer stuck_encoder(HandFirmness hand) {
    return of_each_string(hand, SimulatedFault::stuck_encoder);
}

Answer jammed_drum(HandFirmness hand) {
    return of_each_string(hand, SimulatedFault::jammed_drum);
}

Answer broken_string(HandFirmness hand) {
    Answer worst = of_each_string(hand, SimulatedFault::broken_string);
    CHECK(worst.response_ms <= 100.0);
    const Answer slipped = of_each_string(hand, SimulatedFault::slipped_string);
    worst.response_ms = slipped.response_ms < 0.0
                            ? slipped.response_ms
                            : std::max(worst.response_ms, slipped.response_ms);
    worst.energy_j = std::max(worst.energy_j, slipped.energy_j);
    return worst;
}

// A device without a zero, its grip `off_m` beside home, zeroed there and moved. Returns the rig after it.
void zero_and_move(FaultRig &rig, const Vec3 &off_m) {
    rig.command.forces_enabled = true;
    rig.move_hand(off_m);
    rig.run_ms(600);
    ++rig.command.zero_count;
    rig.mark();
    rig.run_ms(600);
    for (const Vec3 &step : {Vec3(0.05, 0.0, 0.0), Vec3(0.0, 0.05, 0.0), Vec3(0.0, 0.0, 0.05),
                             Vec3(-0.05, -0.04, 0.03), Vec3(0.03, -0.04, -0.05), Vec3(0.0)}) {
        rig.move_hand(off_m + step, 4.0 * step.x);
        rig.run_ms(300);
    }
}

// A simulated device arms itself as soon as its zero is good: that it did not says that it was refused.
Answer refused(FaultRig &rig) {
    CHECK(rig.events_of(DeviceEventKind::zero_refused) == 1);
    CHECK(rig.events_of(DeviceEventKind::zero_confirmed) == 0);
    CHECK_FALSE(rig.now.zero_known);
    CHECK(rig.motors_off());
    CHECK(rig.tension_n <= rig.settings.tension.reference_tension_n + 1e-9);
    double told_ms = -1.0;
    for (const DeviceEvent &event : rig.events) {
        if (event.kind == DeviceEventKind::zero_refused) {
            told_ms = 1e3 * event.time_s - static_cast<double>(rig.marked_at);
        }
    }
    return rig.answer(told_ms);
}

void lose_zero(FaultRig &rig) {
    REQUIRE(rig.inject(SimulatedFault::counts_reset));
    rig.run_ms(5);
    ++rig.command.clear_fault_count;
    rig.run_ms(40);
    REQUIRE_FALSE(rig.now.zero_known);
}

Answer wrong_wiring(HandFirmness hand) {
    {
        FaultRig right(hand); // the same procedure with nothing wrong
        right.activate();
        lose_zero(right);
        zero_and_move(right, Vec3(0.0));
        CHECK(right.events_of(DeviceEventKind::zero_confirmed) == 1);
        CHECK(right.events_of(DeviceEventKind::zero_refused) == 0);
        CHECK(right.now.zero_known);
    }
    Answer worst{0.0, 0.0, 0.0, 0.0};
    for (const SimulatedFault fault :
         {SimulatedFault::reversed_encoder, SimulatedFault::swapped_encoders}) {
        for (const int string : {0, 3, 6}) {
            CAPTURE(string);
            FaultRig rig(hand);
            rig.activate();
            lose_zero(rig);
            REQUIRE(rig.inject(fault, string));
            zero_and_move(rig, Vec3(0.0));
            const Answer answer = refused(rig);
            worst.response_ms = std::max(worst.response_ms, answer.response_ms);
            worst.tension_n = std::max(worst.tension_n, answer.tension_n);
        }
    }
    return worst;
}

Answer not_at_home(HandFirmness hand) {
    Answer worst{0.0, 0.0, 0.0, 0.0};
    for (const Vec3 &off_m : {Vec3(0.03, 0.0, 0.0), Vec3(0.0, -0.03, 0.0), Vec3(0.0, 0.0, 0.03)}) {
        CAPTURE(off_m.x);
        CAPTURE(off_m.y);
        FaultRig rig(hand);
        rig.activate();
        lose_zero(rig);
        zero_and_move(rig, off_m);
        const Answer answer = refused(rig);
        worst.response_ms = std::max(worst.response_ms, answer.response_ms);
        worst.tension_n = std::max(worst.tension_n, answer.tension_n);
    }
    return worst;
}

Answer impossible_lengths(HandFirmness) {
    Bench bench;
    bench.activate();
    const GripPose pose = bench.now().grip.pose;
    int first_bad_ms = -1;
    int off_ms = -1;
    // All strings grow at 4 m/s, slow enough to be real, to lengths beyond any pose.
    for (int ms = 0; ms < 200 && off_ms < 0; ++ms) {
        for (std::int32_t &count : bench.reading.counts) {
            count += 150;
        }
        bench.tick();
        first_bad_ms = first_bad_ms < 0 && bench.now().counters.bad_samples > 0 ? ms : first_bad_ms;
        off_ms = bench.motors_off() ? ms : -1;
    }
    CHECK(glm::distance(bench.now().grip.pose.position_m, pose.position_m) < 0.25);
    CHECK(bench.now().state == DeviceState::fault);
    CHECK(first_bad_ms >= 0);
    return {static_cast<double>(off_ms - first_bad_ms), 0.0, 0.0, 0.0};
}

constexpr FaultRow kRows[] = {
    {18, "stuck encoder", 100.0, 0.0, stuck_encoder},
    {19, "reversed or swapped strings", 2500.0, 0.0, wrong_wiring},
    {20, "jammed drum: slack or caught string", 100.0, 0.0, jammed_drum},
    {21, "broken or slipped string", 1000.0, 0.0, broken_string},
    {22, "lengths that no pose has", 16.0, 0.0, impossible_lengths},
    {36, "zero taken 30 mm beside home", 2500.0, 0.0, not_at_home},
};

} // namespace

std::span<const FaultRow> rows_of_strings() {
    return kRows;
}

} // namespace spidar::test
