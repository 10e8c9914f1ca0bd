// Skipping the tension solve is exact: from any state, mid-transient or settled, the step gives the same bits.
#include <doctest/doctest.h>

#include <memory>
#include <random>

#include "device/servo_fixture.h"
#include "support/snapshot_bits.h"

using namespace spidar;
using spidar::test::Bench;
using spidar::test::kTick_s;

namespace {

struct Dice {
    std::mt19937_64 engine;
    bool one_in(unsigned n) { return engine() % n == 0; }
    double within(double size) {
        return std::uniform_real_distribution<double>(-size, size)(engine);
    }
};

// What a game and a hand may do; most of the time nothing.
void disturb(Dice &dice, Bench &bench) {
    if (dice.one_in(60)) {
        bench.put(test::moved_by(bench.settings,
                                 {dice.within(0.001), dice.within(0.001), dice.within(0.001)},
                                 dice.within(0.02)));
    }
    if (dice.one_in(60)) {
        const double size = dice.one_in(3) ? 0.0 : 4.0;
        bench.ask({Vec3(dice.within(size), dice.within(size), dice.within(size)),
                   Vec3(dice.within(0.02 * size), 0.0, dice.within(0.02 * size)),
                   dice.within(0.01 * size)},
                  dice.one_in(2) ? 5.0 : 0.05);
    }
    if (dice.one_in(200)) {
        bench.command.contact_count = static_cast<int>(dice.engine() % 3);
        for (ContactPlane &plane : bench.command.contacts) {
            plane.offset_m = dice.within(0.005);
            plane.stiffness_n_m = 300.0;
        }
        ++bench.command.contacts_sequence;
    }
    if (dice.one_in(900)) {
        bench.command.forces_enabled = !bench.command.forces_enabled;
    }
    bench.read_status = dice.one_in(300) ? Status::read_timeout : Status::ok;
}

} // namespace

TEST_CASE("tension skip: same bits as without it, from random states") {
    std::uint64_t skipped = 0;
    std::uint64_t solved_while_on = 0;
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
        Dice dice{std::mt19937_64(seed)};
        auto bench = std::make_unique<Bench>();
        bench->settings.tension.change_weight = seed % 3 == 0 ? 0.0 : 1e-2;
        bench->settings.tension.dof_mask = seed % 4 == 0 ? kTranslationOnly : kAllDofs;
        bench->start();
        REQUIRE(bench->started == Status::ok);
        bench->activate();
        auto unskipped = std::make_unique<ServoStep>();
        for (int tick = 0; tick < 4000; ++tick) {
            disturb(dice, *bench);
            *unskipped = bench->step;
            unskipped->forget_settled();
            const DriveCommand truth =
                unskipped->step(bench->read_status, bench->reading, bench->command, kTick_s, true);
            const std::uint64_t before = bench->now().counters.tension_skipped;
            bench->tick();
            CAPTURE(seed);
            CAPTURE(tick);
            REQUIRE(bench->drive.motors_on == truth.motors_on);
            REQUIRE(bench->drive.tensions_n == truth.tensions_n);
            REQUIRE(bench->drive.currents_a == truth.currents_a);
            ServoSnapshot told = bench->now();
            const bool was_skipped = told.counters.tension_skipped != before;
            told.counters.tension_skipped = unskipped->snapshot().counters.tension_skipped;
            told.counters.steps_skipped = unskipped->snapshot().counters.steps_skipped;
            REQUIRE(test::bits_of(told) == test::bits_of(unskipped->snapshot()));
            skipped += was_skipped ? 1U : 0U;
            solved_while_on += !was_skipped && truth.motors_on ? 1U : 0U;
        }
    }
    CHECK(skipped > 1000);
    CHECK(solved_while_on > 1000);
}
