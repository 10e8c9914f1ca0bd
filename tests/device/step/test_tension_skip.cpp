// Skipping the tension solve is exact: from any state, mid-transient or settled, the step gives the same bits.
#include <doctest/doctest.h>

#include <memory>

#include "support/step_twin.h"

using namespace spidar;
using spidar::test::Bench;
using spidar::test::Dice;

namespace {

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
        test::StepTwin twin;
        for (int tick = 0; tick < 4000; ++tick) {
            disturb(dice, *bench);
            CAPTURE(seed);
            CAPTURE(tick);
            const test::StepTwin::Skipped now = twin.tick(*bench);
            skipped += now.solves;
            solved_while_on += now.solves == 0 && now.motors_on ? 1U : 0U;
        }
    }
    CHECK(skipped > 1000);
    CHECK(solved_while_on > 1000);
}
