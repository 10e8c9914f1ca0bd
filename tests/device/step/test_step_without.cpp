// What a device must not do while something is missing: power, a pose, a zero; and what its snapshot says then, each tick.
#include <doctest/doctest.h>

#include "support/servo_fixture.h"

using namespace spidar;
using spidar::test::Bench;
using spidar::test::moved_by;

namespace {

bool is_zero(const Wrench &wrench) {
    return to_paper(wrench) == PaperWrench{};
}

bool says_nothing_of_forces(const Bench &bench) {
    const ServoSnapshot &now = bench.now();
    return bench.motors_off() && is_zero(now.requested) && is_zero(now.achieved) &&
           now.at_min_mask == 0 && now.at_max_mask == 0 && now.tension_status == Status::ok;
}

int told(const Bench &bench, DeviceEventKind kind) {
    int count = 0;
    for (const DeviceEvent &event : bench.step.events()) {
        count += event.kind == kind ? 1 : 0;
    }
    return count;
}

} // namespace

TEST_CASE("without power: a device stays connected, whatever is asked, without a fault; with it "
          "arm() works") {
    for (const bool simulated : {false, true}) {
        CAPTURE(simulated);
        Bench bench;
        bench.simulated = simulated;
        bench.reading.device_status = Status::device_no_power;
        bench.command.forces_enabled = true;
        for (int ms = 0; ms < 300; ++ms) {
            bench.command.arm_count += ms % 50 == 0 ? 1U : 0U;
            bench.tick();
            REQUIRE(bench.now().state == DeviceState::connected);
            REQUIRE(bench.now().fault == Status::ok);
            REQUIRE(bench.motors_off());
        }
        bench.reading.device_status = Status::ok;
        ++bench.command.arm_count;
        bench.tick();
        CHECK(bench.now().state == DeviceState::arming);
    }
}

TEST_CASE("without a pose: arm() waits and lapses, without a fault, each tick") {
    Bench bench;
    bench.command.forces_enabled = true;
    for (std::int32_t &count : bench.reading.counts) {
        count += 20000; // half a metre longer, all of them: no pose has such lengths
    }
    ++bench.command.arm_count;
    for (int ms = 0; ms < 300; ++ms) {
        bench.tick();
        REQUIRE(bench.now().state == DeviceState::connected);
        REQUIRE(bench.now().fault == Status::ok);
        REQUIRE(says_nothing_of_forces(bench));
    }
}

TEST_CASE(
    "without a zero: one that is being taken anew ends the old one, though a panic comes between") {
    Bench bench;
    bench.simulated = false;
    bench.command.forces_enabled = true;
    bench.tick(5);
    REQUIRE(bench.now().zero_known);
    ++bench.command.zero_count;
    bench.tick(100);
    REQUIRE(bench.now().state == DeviceState::taut);
    ++bench.command.stop_count;
    bench.command.stop_reason = Status::panic_stopped;
    bench.tick();
    REQUIRE(bench.now().state == DeviceState::fault);
    ++bench.command.clear_fault_count;
    bench.tick();
    CHECK_FALSE(bench.now().zero_known);
    ++bench.command.arm_count;
    bench.tick();
    CHECK(told(bench, DeviceEventKind::zero_needed) == 1);
    for (int ms = 0; ms < 300; ++ms) {
        bench.tick();
        REQUIRE(bench.now().state == DeviceState::connected);
        REQUIRE(says_nothing_of_forces(bench));
    }
}

TEST_CASE(
    "a zero is told once when it is taken, and reports of forces end with every way to let go") {
    Bench bench;
    bench.simulated = false;
    bench.command.forces_enabled = true;
    ++bench.command.arm_count;
    bench.tick(1100);
    bench.ask({Vec3(3.0, 0.0, 1.0), Vec3(0.0), 0.0}, 1.0);
    bench.tick(10);
    REQUIRE(bench.now().achieved.force_n.x > 2.0);
    REQUIRE_FALSE(is_zero(bench.now().requested));
    ++bench.command.disarm_count;
    bench.tick(25);
    CHECK(bench.now().state == DeviceState::connected);
    CHECK(says_nothing_of_forces(bench));
    // In TAUT there is pretension, and no wrench.
    ++bench.command.zero_count;
    int taken = 0;
    for (int ms = 0; ms < 700; ++ms) {
        bench.tick();
        taken += told(bench, DeviceEventKind::zero_taken);
        REQUIRE(is_zero(bench.now().requested));
        REQUIRE(is_zero(bench.now().achieved));
        REQUIRE(bench.now().at_min_mask == 0);
    }
    CHECK(taken == 1);
    CHECK(bench.drive.motors_on);
    CHECK(bench.now().tensions_n[0] == doctest::Approx(0.5));
    ++bench.command.zero_count; // anew, from TAUT: what is under way goes on
    bench.tick();
    CHECK(bench.now().state == DeviceState::taut);
}

TEST_CASE("a device whose report numbers begin anew after a fault is not taken for one that sends "
          "old ones") {
    Bench bench;
    bench.command.forces_enabled = true;
    for (int ms = 0; ms < 100; ++ms) {
        ++bench.reading.sequence;
        bench.tick();
    }
    REQUIRE(bench.now().counters.old_reports == 0);
    bench.read_status = Status::read_failed;
    bench.tick(5);
    bench.read_status = Status::ok;
    bench.reading.sequence = 1;
    ++bench.command.clear_fault_count;
    for (int ms = 0; ms < 50; ++ms) {
        bench.tick();
        ++bench.reading.sequence;
    }
    CHECK(bench.now().counters.old_reports == 0);
    CHECK(bench.now().state == DeviceState::connected);
}
