// States, edges and faults: what turns the motors off, how fast, and what turns them on again.
#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include <glm/geometric.hpp>

#include "support/servo_fixture.h"

using namespace spidar;
using spidar::test::Bench;
using spidar::test::kTick_s;

TEST_CASE("states: a simulated device arms itself; after disarm() it waits for arm() or a toggle") {
    Bench bench;
    bench.activate();
    REQUIRE(bench.now().state == DeviceState::active);
    ++bench.command.disarm_count;
    bench.tick();
    CHECK(bench.now().state == DeviceState::fading);
    CHECK(bench.drive.motors_on);
    bench.tick(25);
    CHECK(bench.now().state == DeviceState::connected);
    CHECK(bench.motors_off());
    bench.tick(200);
    CHECK(bench.now().state == DeviceState::connected);
    SUBCASE("arm()") {
        ++bench.command.arm_count;
        bench.tick();
        CHECK(bench.now().state == DeviceState::arming);
    }
    SUBCASE("forces_enabled toggled") {
        bench.command.forces_enabled = false;
        bench.tick();
        bench.command.forces_enabled = true;
        bench.tick();
        CHECK(bench.now().state == DeviceState::arming);
    }
}

TEST_CASE("states: disarming takes 20 ms, the tensions falling all the way") {
    Bench bench;
    bench.activate();
    bench.command.forces_enabled = false;
    double last_n = bench.now().tensions_n[0];
    for (int ms = 1; ms < 20; ++ms) {
        bench.tick();
        CHECK(bench.now().state == DeviceState::fading);
        CHECK(bench.now().tensions_n[0] < last_n);
        last_n = bench.now().tensions_n[0];
    }
    bench.tick(2);
    CHECK(bench.now().state == DeviceState::connected);
    CHECK(bench.motors_off());
}

TEST_CASE(
    "states: a real device arms on the edge of arm() only, and only while forces are enabled") {
    Bench bench;
    bench.simulated = false;
    bench.command.forces_enabled = true;
    bench.tick(300);
    CHECK(bench.now().state == DeviceState::connected);
    bench.command.forces_enabled = false;
    ++bench.command.arm_count;
    bench.tick(10);
    bench.command.forces_enabled = true; // the edge has passed
    bench.tick(300);
    CHECK(bench.now().state == DeviceState::connected);
    CHECK(bench.motors_off());
    ++bench.command.arm_count;
    ++bench.command.disarm_count; // in the same cycle: disarm wins
    bench.tick(300);
    CHECK(bench.now().state == DeviceState::connected);
    ++bench.command.arm_count;
    bench.tick();
    CHECK(bench.now().state == DeviceState::arming);
}

TEST_CASE("states: arm() while fading is kept for when it is over; without a pose it lapses") {
    Bench bench;
    bench.simulated = false;
    bench.command.forces_enabled = true;
    ++bench.command.arm_count;
    bench.tick(1100);
    REQUIRE(bench.now().state == DeviceState::active);
    ++bench.command.disarm_count;
    bench.tick(5);
    ++bench.command.arm_count;
    bench.tick(30);
    CHECK(bench.now().state == DeviceState::arming);

    Bench blind;
    blind.simulated = false;
    blind.command.forces_enabled = true;
    blind.read_status = Status::read_timeout; // no report yet
    ++blind.command.arm_count;
    blind.tick(500);
    CHECK(blind.now().state == DeviceState::connected);
    blind.read_status = Status::ok;
    blind.tick(500);
    CHECK(blind.now().state == DeviceState::connected); // half a second later would be a surprise
}

TEST_CASE(
    "fault: one count jump is held and counted, three in a row latch with the string's number") {
    Bench bench;
    bench.activate();
    const GripPose pose = bench.now().grip.pose;
    bench.reading.counts[6] += 1000;
    bench.tick();
    CHECK(bench.now().grip.status == Status::held_last_pose);
    CHECK(glm::distance(bench.now().grip.pose.position_m, pose.position_m) == 0.0);
    CHECK(bench.now().counters.bad_samples == 1);
    bench.reading.counts[6] -= 1000;
    bench.tick();
    CHECK(bench.now().state == DeviceState::active);
    CHECK(bench.now().grip.status == Status::ok);

    bench.reading.counts[6] += 1000;
    bench.tick(2);
    CHECK(bench.drive.motors_on);
    bench.tick(); // the third: off in this very cycle
    CHECK(bench.motors_off());
    CHECK(bench.now().state == DeviceState::fault);
    CHECK(bench.now().fault == Status::count_jump);
    CHECK(bench.now().fault_string == 6);
    CHECK(bench.now().counters.bad_samples == 4);
    bench.tick(100);
    CHECK(bench.now().state == DeviceState::fault);
    CHECK(glm::distance(bench.now().grip.pose.position_m, pose.position_m) == 0.0);

    ++bench.command.arm_count; // alone it does not help
    bench.tick(10);
    CHECK(bench.now().state == DeviceState::fault);
    bench.reading.counts[6] -= 1000;
    ++bench.command.clear_fault_count;
    bench.tick(200);
    CHECK(bench.now().state ==
          DeviceState::connected); // and a fault wants arm() from simulated ones too
    CHECK(bench.now().fault == Status::ok);
    CHECK(bench.now().fault_string == -1);
    ++bench.command.arm_count;
    bench.tick(1100);
    CHECK(bench.now().state == DeviceState::active);
}

TEST_CASE("counts wrap at 32 bits in both directions and nothing is felt of it") {
    for (const std::int64_t start :
         {std::int64_t{2147483647} - 100, -std::int64_t{2147483648} + 100}) {
        Bench bench;
        bench.settings.strings.zero_count.fill(static_cast<std::int32_t>(start));
        bench.start();
        REQUIRE(bench.started == Status::ok);
        for (int i = 0; i < 400; ++i) {
            const double x = 0.02 * std::sin(0.05 * i);
            const GripPose pose = spidar::test::moved_by(bench.settings, Vec3(x, -x, 0.5 * x));
            bench.put(pose);
            bench.tick();
            REQUIRE(bench.now().grip.status == Status::ok);
            REQUIRE(glm::distance(bench.now().grip.pose.position_m, pose.position_m) < 5e-5);
        }
        CHECK(bench.now().counters.bad_samples == 0);
    }
}

TEST_CASE("fault: no reports: the wrench fades from 5 ms, pretension stays, motors off at 20 ms") {
    Bench bench;
    bench.activate();
    bench.ask({Vec3(0.0, 0.0, 2.0), Vec3(0.0), 0.0}, 1.0);
    bench.tick(50);
    bench.read_status = Status::read_timeout;
    for (int ms = 1; ms <= 19; ++ms) {
        bench.tick();
        const double known_n = ms < 5 ? 2.0 : 2.0 * (1.0 - (ms - 4) / 20.0);
        CAPTURE(ms);
        CHECK(bench.now().requested.force_n.z == doctest::Approx(known_n));
        CHECK(bench.drive.motors_on);
    }
    CHECK(bench.now().tensions_n[0] > 0.0);
    CHECK(bench.now().grip.status == Status::read_timeout);
    bench.tick();
    CHECK(bench.motors_off());
    CHECK(bench.now().state == DeviceState::fault);
    CHECK(bench.now().fault == Status::read_timeout);
    CHECK(bench.now().counters.read_timeouts == 20);
}

TEST_CASE("a zero taken by the host is gone when the device was unplugged; one that the device "
          "keeps is not") {
    for (const bool kept : {false, true}) {
        CAPTURE(kept);
        Bench bench;
        bench.simulated = false;
        bench.reading.zeroed = kept;
        bench.command.forces_enabled = true;
        bench.tick();
        if (!kept) {
            ++bench.command.zero_count;
            bench.tick(700);
            REQUIRE(bench.now().state == DeviceState::taut);
            for (int ms = 0; ms < 3000; ++ms) { // shown by moving the grip
                const double way = 0.04 * std::sin(0.004 * ms);
                bench.put(spidar::test::moved_by(
                    bench.settings, Vec3(way, 0.04 * std::sin(0.003 * ms), -way), 0.0));
                bench.tick();
            }
        }
        REQUIRE(bench.now().zero_known);
        bench.read_status = Status::read_failed;
        bench.tick(20);
        REQUIRE(bench.now().state == DeviceState::closed);
        bench.read_status = Status::ok;
        ++bench.command.clear_fault_count;
        bench.tick(20);
        ++bench.command.arm_count;
        bench.tick(1200);
        CHECK(bench.now().zero_known == kept);
        CHECK(bench.now().state == (kept ? DeviceState::active : DeviceState::connected));
        CHECK(bench.drive.motors_on == kept);
    }
}

TEST_CASE("three lost reports are nothing; seven cost some force, which comes back") {
    Bench bench;
    bench.activate();
    bench.ask({Vec3(0.0, 0.0, 2.0), Vec3(0.0), 0.0}, 1.0);
    bench.tick(50);
    bench.read_status = Status::read_timeout;
    bench.tick(3);
    CHECK(bench.now().requested.force_n.z == doctest::Approx(2.0));
    bench.read_status = Status::ok;
    bench.tick(5);
    bench.read_status = Status::read_timeout;
    bench.tick(7);
    CHECK(bench.now().requested.force_n.z < 1.9);
    bench.read_status = Status::ok;
    bench.tick(60);
    CHECK(bench.now().requested.force_n.z == doctest::Approx(2.0));
    CHECK(bench.now().state == DeviceState::active);
}

TEST_CASE(
    "fault: unplugged: closed with motors off in the same cycle; back only after clear and arm") {
    for (const bool at_write : {false, true}) {
        Bench bench;
        bench.activate();
        if (at_write) {
            bench.step.report_write(Status::write_failed);
            CHECK(bench.now().counters.write_failures == 1);
            CHECK(bench.now().fault == Status::write_failed);
        } else {
            bench.read_status = Status::read_failed;
            bench.tick();
            CHECK(bench.motors_off());
            CHECK(bench.now().fault == Status::read_failed);
            ++bench.command.clear_fault_count; // while it is still away: nothing
            bench.tick(10);
        }
        CHECK(bench.now().state == DeviceState::closed);
        bench.read_status = Status::ok;
        bench.tick(100);
        CHECK(bench.now().state == DeviceState::closed);
        CHECK(bench.motors_off());
        ++bench.command.clear_fault_count;
        bench.tick(100);
        CHECK(bench.now().state == DeviceState::connected);
        ++bench.command.arm_count;
        bench.tick();
        CHECK(bench.now().state == DeviceState::arming);
    }
}

TEST_CASE("fault: over-speed turns the motors off, in arms only") {
    const auto fling = [](Bench &bench) {
        Vec3 p(-0.12, 0.0, 0.0);
        for (int i = 0; i < 80; ++i) {
            p.x += 3.0 * kTick_s; // 3 m/s, above 2
            bench.put(spidar::test::moved_by(bench.settings, p));
            bench.tick();
        }
    };
    Bench idle;
    idle.put(spidar::test::moved_by(idle.settings, Vec3(-0.12, 0.0, 0.0)));
    idle.tick(5);
    fling(idle);
    CHECK(idle.now().state == DeviceState::connected);
    CHECK(idle.now().counters.bad_samples == 0);

    Bench armed;
    armed.put(spidar::test::moved_by(armed.settings, Vec3(-0.12, 0.0, 0.0)));
    armed.activate();
    fling(armed);
    CHECK(armed.now().state == DeviceState::fault);
    CHECK(armed.now().fault == Status::over_speed);
    CHECK(armed.motors_off());
}

TEST_CASE("fault: lengths that no pose has: held, then latched when forces are on") {
    for (const bool forces : {false, true}) {
        Bench bench;
        if (forces) {
            bench.activate();
        } else {
            bench.tick(20);
        }
        const GripPose pose = bench.now().grip.pose;
        // All strings grow at 4 m/s, slow enough to be real, to lengths beyond any pose.
        for (int i = 0; i < 200; ++i) {
            for (std::int32_t &count : bench.reading.counts) {
                count += 150;
            }
            bench.tick();
        }
        CHECK(bench.now().grip.status < Status::ok);
        CHECK(bench.now().counters.bad_samples > 0);
        CHECK(glm::distance(bench.now().grip.pose.position_m, pose.position_m) < 0.25);
        CHECK(bench.motors_off());
        CHECK(bench.now().state == (forces ? DeviceState::fault : DeviceState::connected));
        bench.command.forces_enabled = true;
        ++bench.command.arm_count;
        bench.tick(200);
        CHECK(bench.motors_off()); // nothing arms without a pose
    }
}
