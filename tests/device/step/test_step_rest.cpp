// A step that is skipped whole gives the same bits as the whole step, whatever wakes the grip from its rest.
#include <doctest/doctest.h>

#include <memory>

#include "support/servo_step_input.h"
#include "support/step_twin.h"

using namespace spidar;
using spidar::test::Bench;
using spidar::test::Dice;
using spidar::test::kTick_s;

namespace {

// Until all that evolves in time has settled (the usual parity error and the change term take longest).
constexpr int kSettle = 6000;

// Rarely one of all the things that may end a rest.
void disturb(Dice &dice, Bench &bench, bool beating) {
    bench.read_status = dice.one_in(3000) ? Status::read_timeout : Status::ok;
    bench.reading.device_status = Status::ok;
    bench.command.heartbeat += beating && dice.one_in(16) ? 1U : 0U;
    if (!dice.one_in(1200)) {
        return;
    }
    switch (dice.engine() % 9) {
    case 0:
        bench.put(test::moved_by(bench.settings,
                                 {dice.within(0.01), dice.within(0.01), dice.within(0.01)},
                                 dice.within(0.02)));
        break;
    case 1:
        bench.ask({Vec3(dice.within(4.0), dice.within(4.0), dice.within(4.0)), Vec3(0.0), 0.0},
                  dice.one_in(2) ? 5.0 : 0.05);
        break;
    case 2:
        bench.command.contact_count = static_cast<int>(dice.engine() % 2);
        bench.command.contacts[0].offset_m = dice.within(0.005);
        ++bench.command.contacts_sequence;
        break;
    case 3:
        bench.command.forces_enabled = !bench.command.forces_enabled;
        break;
    case 4:
        ++bench.command.disarm_count;
        break;
    case 5:
        ++bench.command.arm_count;
        break;
    case 6:
        bench.reading.buttons = static_cast<std::uint8_t>(dice.engine());
        break;
    case 7:
        bench.reading.device_status = Status::device_emergency_stop;
        break;
    default:
        ++bench.command.clear_fault_count;
        break;
    }
}

std::uint64_t rested(const Bench &bench) {
    return bench.now().counters.steps_skipped;
}

// Settled under forces, with a wrench that is held for a minute.
std::unique_ptr<Bench> resting_bench() {
    auto bench = std::make_unique<Bench>();
    bench->activate();
    bench->ask({Vec3(0.0, 1.0, 0.0), Vec3(0.0), 0.0}, kMaxWrenchDuration_s);
    bench->tick(kSettle);
    return bench;
}

} // namespace

TEST_CASE("step at rest: skipped whole, with the same bits as without") {
    std::uint64_t skipped = 0;
    std::uint64_t skipped_while_on = 0;
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
        Dice dice{std::mt19937_64(seed)};
        auto bench = std::make_unique<Bench>();
        bench->settings.safety.arming_time_s = 0.05;
        bench->simulated = seed != 2;
        bench->settings.corrections.axial_stiffness_n.fill(seed == 4 ? 1e4 : 0.0);
        bench->start();
        REQUIRE(bench->started == Status::ok);
        bench->command.heartbeat = seed == 3 ? 1 : 0;
        bench->command.arm_count = 1;
        bench->activate();
        test::StepTwin twin;
        for (int tick = 0; tick < 20000; ++tick) {
            disturb(dice, *bench, tick % 8000 < 7000);
            CAPTURE(seed);
            CAPTURE(tick);
            const test::StepTwin::Skipped now = twin.tick(*bench);
            skipped += now.steps;
            skipped_while_on += now.motors_on ? now.steps : 0U;
        }
    }
    CHECK(skipped > 10000);
    CHECK(skipped_while_on > 3000);
}

TEST_CASE("step at rest: what is new ends it at once") {
    const auto resting = resting_bench();
    REQUIRE(resting->now().state == DeviceState::active);
    const auto goes_on = [&](auto &&change) {
        auto bench = std::make_unique<Bench>(*resting);
        change(*bench);
        const std::uint64_t before = rested(*bench);
        bench->tick();
        return rested(*bench) == before;
    };
    CHECK_FALSE(goes_on([](Bench &) {}));
    CHECK_FALSE(goes_on([](Bench &bench) { bench.reading.buttons = 1; }));
    CHECK(goes_on([](Bench &bench) { ++bench.reading.counts[3]; }));
    CHECK(goes_on([](Bench &bench) { bench.read_status = Status::read_timeout; }));
    CHECK(goes_on([](Bench &bench) { bench.read_status = Status::read_failed; }));
    CHECK(goes_on([](Bench &bench) { bench.reading.zeroed = false; }));
    CHECK(goes_on([](Bench &bench) { bench.reading.device_status = Status::device_no_power; }));
    CHECK(goes_on([](Bench &bench) { bench.reading.sequence = 7; }));
    CHECK(goes_on([](Bench &bench) { bench.command.forces_enabled = false; }));
    CHECK(goes_on([](Bench &bench) { ++bench.command.disarm_count; }));
    CHECK(goes_on([](Bench &bench) { ++bench.command.stop_count; }));
    CHECK(goes_on([](Bench &bench) { ++bench.command.wrench_sequence; }));
    CHECK(goes_on([](Bench &bench) { ++bench.command.contacts_sequence; }));
    CHECK(goes_on([](Bench &bench) { ++bench.command.coupling_sequence; }));
    CHECK(goes_on([](Bench &bench) { ++bench.command.effects_sequence; }));
    CHECK(goes_on([](Bench &bench) { bench.step.report_write(Status::write_failed); }));
}

TEST_CASE("step at rest: time still passes: a wrench expires, a silent game disarms, motors warm") {
    auto bench = resting_bench();
    const double before = bench->now().thermal_share;
    bench->tick(1000);
    CHECK(bench->now().thermal_share > before);
    CHECK(rested(*bench) > 1000);

    bench->tick(static_cast<int>(kMaxWrenchDuration_s / kTick_s) + 1000 - kSettle);
    CHECK(bench->now().requested.force_n == Vec3(0.0));
    CHECK(bench->now().counters.expired_requests == 1);

    bench->command.heartbeat = 1;
    bench->tick(kSettle); // promised, then nothing
    CHECK(bench->now().state != DeviceState::active);
}

TEST_CASE("slow loops: a step longer than the guard's patience is no speed") {
    Bench bench;
    bench.settings.rate_hz = 100.0;
    bench.start();
    bench.command.forces_enabled = true;
    bench.tick(300, 0.01);
    CHECK(bench.now().state == DeviceState::active);
    CHECK(bench.now().safety_scale == 1.0);
}

TEST_CASE("step at rest: with stretch it begins only where the tensions are those of the cycle "
          "before, to the bit") {
    // Found by stress_servo_step, two in 5 x 10^8 steps: a solve that was skipped gave a tension a rounding away, whose
    // stretch the next step would have followed.
    for (const std::uint64_t sequence : {31186U, 53620U}) {
        spidar::test::ServoStepInput input(6001, sequence);
        const auto step = std::make_unique<ServoStep>();
        const auto whole = std::make_unique<ServoStep>();
        REQUIRE(usable(step->configure(input.settings)));
        REQUIRE(usable(whole->configure(input.settings)));
        for (int i = 0; i < 4600; ++i) {
            input.next(step->snapshot());
            whole->forget_settled();
            for (ServoStep *one : {step.get(), whole.get()}) {
                (void)one->step(input.read_status, input.reading, input.command, input.dt_s,
                                input.simulated);
            }
            REQUIRE(step->snapshot().tensions_n == whole->snapshot().tensions_n);
        }
    }
}
