// Rate, loss, latency, faults of the link, two devices, wrong devices: through /dev/uhid and /dev/hidraw.
#include <doctest/doctest.h>

#include <cstdio>

#include "device/contract/device_claims.h"
#include "hid/uhid_device.h"
#include "hid/vm_host.h"

using namespace spidar;
using spidar::test::DeviceObservations;
using spidar::test::FirmwareModel;
using spidar::test::sleep_ms;
using spidar::test::UhidDevice;
using spidar::test::VmHost;

namespace {

constexpr double kForce_n = 3.0;
constexpr double kMillisecond_ns = 1e6;

void figure(const char *what, double value, const char *unit) {
    std::printf("figure: %s = %.3f %s\n", what, value, unit);
    std::fflush(stdout);
}

} // namespace

TEST_CASE(
    "vm: 1 kHz for ten seconds in contact: no loss either way, one cycle from state to command") {
    UhidDevice device({});
    REQUIRE(device.plug());
    sleep_ms(100.0);
    VmHost host("VM-1");
    REQUIRE(host.start() == Status::ok);
    REQUIRE(host.activate(kForce_n));
    device.clear_observations();
    const HidCounters before = host.transport->counters();
    const std::uint64_t lost_before =
        device.with_firmware([](const FirmwareModel &f) { return f.counters().lost; });
    const std::int64_t from_ns = test::now_ns();
    host.pull(10.0);
    const double seconds = static_cast<double>(test::now_ns() - from_ns) * 1e-9;
    const HidCounters after = host.transport->counters();
    const DeviceObservations seen = device.observations();
    const HidTimes times = host.transport->times();
    const LoopStatistics loop = host.loop.statistics();
    const auto reports = static_cast<double>(after.reports - before.reports);
    figure("reports read a second", reports / seconds, "Hz");
    figure("reports lost", static_cast<double>(after.lost - before.lost), "");
    figure("commands lost", static_cast<double>(device.with_firmware([](const FirmwareModel &f) {
               return f.counters().lost;
           }) - lost_before),
           "");
    figure("round trip, median", times.round_trip_p50_us, "us");
    figure("round trip, p99", times.round_trip_p99_us, "us");
    figure("round trip, largest", times.round_trip_max_us, "us");
    figure("hid_write, largest", times.write_max_us, "us");
    figure("read, compute, write: p99", loop.step_p99_us, "us");
    figure("commands that answer the newest state",
           100.0 * static_cast<double>(seen.commands_on_newest_state) /
               static_cast<double>(seen.commands),
           "%");
    CHECK(host.look().state == DeviceState::active);
    CHECK(seen.overruns == 0);
    CHECK(reports / seconds >= 999.0);
    CHECK(reports / seconds <= 1001.0);
    CHECK(after.lost == before.lost);
    CHECK(after.corrupt + after.wrong_length + after.stale == 0);
    CHECK(device.with_firmware([](const FirmwareModel &f) { return f.counters().lost; }) ==
          lost_before);
    CHECK(times.round_trip_p99_us <= 1100.0);
    CHECK(loop.step_p99_us <= 500.0); // read, compute and write in one cycle, with room to spare
    CHECK(static_cast<double>(seen.commands_on_newest_state) >=
          0.99 * static_cast<double>(seen.commands));
    CHECK(seen.motors.back().strongest_mn > 500);
}

TEST_CASE(
    "vm: corrupt, short, repeated, reordered and missing reports are counted and do no harm") {
    UhidDevice device({});
    REQUIRE(device.plug());
    sleep_ms(100.0);
    VmHost host("VM-1");
    REQUIRE(host.start() == Status::ok);
    REQUIRE(host.activate(kForce_n));
    const HidCounters before = host.transport->counters();
    for (int round = 0; round < 10; ++round) {
        for (auto *fault :
             {&device.faults.corrupted, &device.faults.shortened, &device.faults.replayed,
              &device.faults.reordered, &device.faults.silent}) {
            fault->store(1);
            host.pull(0.02);
        }
    }
    const HidCounters after = host.transport->counters();
    // Newer kernels drop short reports themselves; older ones hand them on.
    CHECK(after.corrupt - before.corrupt == 10);
    CHECK(after.wrong_length - before.wrong_length <= 10);
    CHECK(after.replayed - before.replayed == 10);
    CHECK(after.out_of_order - before.out_of_order == 10);
    CHECK(after.lost - before.lost == 30); // those 20, and 10 that were never sent
    CHECK(host.look().state == DeviceState::active);
}

TEST_CASE(
    "vm: a device that falls silent: forces fade, then the fault latches and the motors stop") {
    UhidDevice device({});
    REQUIRE(device.plug());
    sleep_ms(100.0);
    VmHost host("VM-1");
    REQUIRE(host.start() == Status::ok);
    REQUIRE(host.activate(kForce_n));
    device.faults.silent.store(100'000);
    const std::int64_t last_ns = device.observations().last_report_ns;
    const std::int64_t fault_ns =
        host.wait_for([](const ServoSnapshot &s) { return s.state == DeviceState::fault; }, 0.5);
    REQUIRE(fault_ns > 0);
    CHECK(host.snapshot.fault == Status::read_timeout);
    figure("silence -> fault", static_cast<double>(fault_ns - last_ns) / kMillisecond_ns, "ms");
    CHECK(static_cast<double>(fault_ns - last_ns) <= 25.0 * kMillisecond_ns);
    sleep_ms(5.0);
    CHECK(device.observations().motors.back().strongest_mn == 0);
}

TEST_CASE(
    "vm: unplugged in contact: closed at once; plugged in again: found, not armed, until zeroed") {
    UhidDevice device({});
    REQUIRE(device.plug());
    sleep_ms(100.0);
    VmHost host("VM-1");
    REQUIRE(host.start() == Status::ok);
    REQUIRE(host.activate(kForce_n));
    device.unplug();
    const std::int64_t closed_ns =
        host.wait_for([](const ServoSnapshot &s) { return s.state == DeviceState::closed; }, 0.5);
    REQUIRE(closed_ns > 0);
    const double closing_ms =
        static_cast<double>(closed_ns - device.unplugged_ns()) / kMillisecond_ns;
    figure("unplug -> CLOSED, tensions zero", closing_ms, "ms");
    CHECK(closing_ms <= 5.0);
    for (const double tension_n : host.snapshot.tensions_n) {
        CHECK(tension_n == 0.0);
    }

    sleep_ms(400.0);
    REQUIRE(device.plug());
    const std::int64_t plugged_ns = test::now_ns();
    while (host.transport->counters().replugs == 0 && test::now_ns() - plugged_ns < 2'000'000'000) {
        sleep_ms(1.0);
    }
    const double found_ms = static_cast<double>(test::now_ns() - plugged_ns) / kMillisecond_ns;
    figure("plug -> found", found_ms, "ms");
    CHECK(found_ms <= 1000.0);
    // Whatever the game asks: without a new zero there is no force.
    for (int i = 0; i < 50; ++i) {
        ++host.command.clear_fault_count;
        ++host.command.arm_count;
        host.pull(0.01);
        REQUIRE(host.look().state != DeviceState::active);
        REQUIRE(host.snapshot.state != DeviceState::arming);
    }
    CHECK(device.with_firmware([](const FirmwareModel &f) { return f.mode(); }) ==
          FirmwareModel::Mode::disabled);
    CHECK(host.activate(kForce_n));
}

TEST_CASE("vm: another serial number, product or protocol is not taken for the device") {
    test::UhidOptions other;
    other.serial = "VM-9";
    other.product = "Other gadget";
    UhidDevice wrong_product(other);
    REQUIRE(wrong_product.plug());
    other.product = "SPIDAR-G model";
    other.firmware.capabilities.protocol_version = 2;
    UhidDevice wrong_version(other);
    REQUIRE(wrong_version.plug());
    sleep_ms(100.0);
    VmHost host("VM-1");
    CHECK(host.start() == Status::no_device);
    CHECK(host.transport->problem().find("VM-1") != std::string::npos);
    VmHost newer("VM-9");
    CHECK(newer.start() == Status::protocol_mismatch);
    CHECK(newer.transport->problem().find("version 2") != std::string::npos);
}

TEST_CASE("vm: two devices and two hosts at once; a second owner is refused") {
    UhidDevice first({});
    test::UhidOptions options;
    options.serial = "VM-2";
    UhidDevice second(options);
    REQUIRE(first.plug());
    REQUIRE(second.plug());
    sleep_ms(150.0);
    VmHost one("VM-1");
    VmHost two("VM-2");
    DeviceClaim claim;
    DeviceClaim again;
    REQUIRE(claim.take("hid:VM-1", "one"));
    CHECK_FALSE(again.take("hid:VM-1", "two"));
    REQUIRE(one.start() == Status::ok);
    REQUIRE(two.start() == Status::ok);
    REQUIRE(one.activate(kForce_n));
    one.command.forces_enabled = true;
    REQUIRE(two.activate(-kForce_n));
    const HidCounters before_one = one.transport->counters();
    const HidCounters before_two = two.transport->counters();
    for (int i = 0; i < 100; ++i) {
        one.pull(0.01);
        two.pull(0.01);
    }
    CHECK(one.look().state == DeviceState::active);
    CHECK(two.look().state == DeviceState::active);
    CHECK(one.snapshot.requested.force_n.y == doctest::Approx(kForce_n));
    CHECK(two.snapshot.requested.force_n.y == doctest::Approx(-kForce_n));
    const std::uint64_t reports_one = one.transport->counters().reports - before_one.reports;
    const std::uint64_t reports_two = two.transport->counters().reports - before_two.reports;
    figure("two devices: reports of each in two seconds", static_cast<double>(reports_one), "");
    CHECK(reports_one >= 1990);
    CHECK(reports_two >= 1990);
    CHECK(one.transport->counters().lost == before_one.lost);
    CHECK(two.transport->counters().lost == before_two.lost);
}
