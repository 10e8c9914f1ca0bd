// Two servo steps from one state: one that may skip what has settled, and one that computes everything. Their bits agree.
#pragma once

#include <doctest/doctest.h>

#include <cstdint>
#include <memory>
#include <random>

#include "support/servo_fixture.h"
#include "support/snapshot_bits.h"

namespace spidar::test {

struct Dice {
    std::mt19937_64 engine;
    bool one_in(unsigned n) { return engine() % n == 0; }
    double within(double size) {
        return std::uniform_real_distribution<double>(-size, size)(engine);
    }
};

class StepTwin {
public:
    struct Skipped {
        bool motors_on = false;
        std::uint64_t steps = 0;
        std::uint64_t solves = 0;
    };

    // One cycle of the bench, compared. What it skipped.
    Skipped tick(Bench &bench) {
        *whole_ = bench.step;
        whole_->forget_settled();
        bench.step.touch().forget_pairs(); // both look at shapes as for the first time
        const DriveCommand truth =
            whole_->step(bench.read_status, bench.reading, bench.command, kTick_s, bench.simulated);
        const ServoCounters before = bench.now().counters;
        bench.step.touch().forget_pairs();
        bench.tick();
        REQUIRE(bench.drive.motors_on == truth.motors_on);
        REQUIRE(bench.drive.clear_faults == truth.clear_faults);
        REQUIRE(bench.drive.tensions_n == truth.tensions_n);
        REQUIRE(bench.drive.currents_a == truth.currents_a);
        ServoSnapshot told = bench.now();
        const Skipped skipped{truth.motors_on, told.counters.steps_skipped - before.steps_skipped,
                              told.counters.tension_skipped - before.tension_skipped};
        told.counters.steps_skipped = whole_->snapshot().counters.steps_skipped;
        told.counters.tension_skipped = whole_->snapshot().counters.tension_skipped;
        REQUIRE(bits_of(told) == bits_of(whole_->snapshot()));
        return skipped;
    }

private:
    std::unique_ptr<ServoStep> whole_ = std::make_unique<ServoStep>();
};

} // namespace spidar::test
