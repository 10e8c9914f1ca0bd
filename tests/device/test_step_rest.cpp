// A step that is skipped whole gives the same bits as the whole step, whatever wakes the grip from its rest.
#include <doctest/doctest.h>

#include <memory>
#include <random>

#include "device/servo_fixture.h"
#include "support/snapshot_bits.h"

using namespace spidar;
using spidar::test::Bench;
using spidar::test::kTick_s;

namespace {

// Until all that evolves in time has settled (the usual parity error and the change term take longest).
constexpr int kSettle = 6000;

struct Dice {
    std::mt19937_64 engine;
    bool one_in(unsigned n) { return engine() % n == 0; }
    double within(double size) {
        return std::uniform_real_distribution<double>(-size, size)(engine);
    }
};

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

bool same(const DriveCommand &a, const DriveCommand &b) {
    return a.motors_on == b.motors_on && a.clear_faults == b.clear_faults &&
           a.tensions_n == b.tensions_n && a.currents_a == b.currents_a;
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
        auto whole = std::make_unique<ServoStep>();
        for (int tick = 0; tick < 20000; ++tick) {
            disturb(dice, *bench, tick % 8000 < 7000);
            *whole = bench->step;
            whole->forget_settled();
            const DriveCommand truth = whole->step(bench->read_status, bench->reading,
                                                   bench->command, kTick_s, bench->simulated);
            const std::uint64_t before = rested(*bench);
            bench->tick();
            CAPTURE(seed);
            CAPTURE(tick);
            REQUIRE(same(bench->drive, truth));
            ServoSnapshot told = bench->now();
            skipped += told.counters.steps_skipped - before;
            skipped_while_on += truth.motors_on ? told.counters.steps_skipped - before : 0U;
            told.counters.steps_skipped = whole->snapshot().counters.steps_skipped;
            told.counters.tension_skipped = whole->snapshot().counters.tension_skipped;
            REQUIRE(test::bits_of(told) == test::bits_of(whole->snapshot()));
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
