#include <doctest/doctest.h>

#include <chrono>
#include <limits>
#include <thread>

#include "device/hid/hid_transport.h"
#include "support/fake_hid_bus.h"

using namespace spidar;
using spidar::test::FakeDevice;
using spidar::test::FakeHidBus;
using spidar::test::FirmwareModel;

namespace {

struct Link {
    std::shared_ptr<FakeHidBus> bus = std::make_shared<FakeHidBus>();
    std::shared_ptr<FakeDevice> device = bus->add("A1");
    HidTransport transport{bus, HidTransportSettings{}};
    DeviceReading reading;
    DriveCommand drive;

    // As the servo loop does: read, then write.
    Status cycle(int times = 1) {
        Status status = Status::ok;
        for (int i = 0; i < times; ++i) {
            bus->tick();
            status = transport.read(reading);
            transport.write(drive);
        }
        return status;
    }
    void pull(double tension_n) {
        drive.motors_on = true;
        drive.tensions_n.fill(tension_n);
    }
    void zero() {
        REQUIRE(transport.zero(CountArray{}) == Status::ok);
        cycle(110);
        REQUIRE(reading.zeroed);
    }
    // The thread that looks for devices runs in real time.
    bool found_again() {
        for (int i = 0; i < 2000 && transport.counters().replugs == 0; ++i) {
            std::this_thread::sleep_for(std::chrono::milliseconds(2));
        }
        return transport.counters().replugs == 1;
    }
};

std::vector<std::uint8_t> bytes_of(const StateReport &report) {
    const auto bytes = encode(report);
    return {bytes.begin(), bytes.end()};
}

} // namespace

TEST_CASE("hid transport: an encoder fault comes with the strings that it is about") {
    Link link;
    REQUIRE(link.transport.open() == Status::ok);
    link.cycle(30);
    CHECK(link.reading.device_status == Status::ok);
    CHECK(link.reading.fault_strings == 0);
    link.device->firmware.inputs.faulty_encoders = 0x20;
    link.cycle(30);
    CHECK(link.reading.device_status == Status::device_encoder_fault);
    CHECK(link.reading.fault_strings == 0x20);
}

TEST_CASE("hid transport: a device is known by its serial number while it is open, unplugged too") {
    Link link;
    CHECK(link.transport.device_name() == "");
    REQUIRE(link.transport.open() == Status::ok);
    CHECK(link.transport.device_name() == "hid:A1");
    link.cycle(5);
    link.bus->unplug(*link.device);
    link.cycle(5);
    CHECK(link.transport.device_name() == "hid:A1");
    link.transport.close();
    CHECK(link.transport.device_name() == "");
}

TEST_CASE("hid transport: readings come, commands go, and both are matched by their numbers") {
    Link link;
    CHECK(link.transport.read(link.reading) == Status::not_open);
    CHECK(link.transport.write(link.drive) == Status::not_open);
    REQUIRE(link.transport.open() == Status::ok);
    CHECK(link.transport.read(link.reading) == Status::read_timeout);
    link.device->firmware.inputs.raw_counts = {1, -2, 3, -4, 5, -6, 7, -8};
    link.device->firmware.inputs.buttons = 5;
    CHECK(link.cycle() == Status::ok);
    CHECK(link.reading.counts == link.device->firmware.inputs.raw_counts);
    CHECK(link.reading.buttons == 5);
    CHECK_FALSE(link.reading.zeroed);
    link.zero();
    link.pull(2.0);
    CHECK(link.cycle(300) == Status::ok);
    CHECK(link.device->firmware.motors_mn()[3] == 2000);
    const HidCounters counters = link.transport.counters();
    CHECK(counters.reports == 411);
    CHECK(counters.commands == 411);
    CHECK(counters.lost + counters.skipped_commands + counters.superseded == 0);
    CHECK(link.device->firmware.counters().lost == 0);
    CHECK(link.transport.times().round_trip_max_us == doctest::Approx(1000.0));
    // Each command is named a whole period later: half of it is the wait for the report.
    CHECK(link.transport.latency_s() == doctest::Approx(0.0005).epsilon(0.2));
    CHECK(link.transport.capabilities().max_force_mn == 8000);
    CHECK(link.transport.limits().max_tension_mn == 10000);
    link.transport.close();
    CHECK(link.device->firmware.mode() == FirmwareModel::Mode::disabled);
    CHECK(link.transport.read(link.reading) == Status::not_open);
}

TEST_CASE("hid transport: no tension leaves its range, whatever the command says") {
    Link link;
    REQUIRE(link.transport.open() == Status::ok);
    link.cycle();
    link.zero();
    link.pull(0.0);
    link.drive.tensions_n = {std::numeric_limits<double>::quiet_NaN(),
                             -1.0,
                             1e300,
                             std::numeric_limits<double>::infinity(),
                             0.0004,
                             0.0006,
                             9.9999,
                             10.0};
    link.cycle(200);
    const test::MotorTensions_mn expected{0, 0, 10000, 10000, 0, 1, 10000, 10000};
    CHECK(link.device->firmware.motors_mn() == expected);
}

TEST_CASE("hid transport: acts on the newest report, and counts those that waited before it") {
    Link link;
    REQUIRE(link.transport.open() == Status::ok);
    link.cycle();
    for (int i = 0; i < 5; ++i) {
        link.bus->tick();
    }
    link.device->firmware.inputs.raw_counts[0] = 99;
    CHECK(link.cycle() == Status::ok);
    CHECK(link.reading.counts[0] == 99);
    CHECK(link.transport.counters().superseded == 5);
    CHECK(link.transport.counters().lost == 0);
}

TEST_CASE("hid transport: after a stalled host the old queue is not acted on") {
    Link link;
    REQUIRE(link.transport.open() == Status::ok);
    link.cycle(10);
    for (int i = 0; i < 200; ++i) {
        link.bus->tick(); // the queue keeps the first 64
    }
    CHECK(link.transport.read(link.reading) == Status::read_timeout);
    CHECK(link.transport.counters().stale == 64);
    CHECK(link.cycle() == Status::ok);
    CHECK(link.transport.counters().lost == 136);
    CHECK(link.transport.counters().restarts == 0);
}

TEST_CASE("hid transport: short, long, corrupt, replayed and old reports are refused and counted") {
    Link link;
    REQUIRE(link.transport.open() == Status::ok);
    link.cycle(5);
    StateReport state;
    REQUIRE(decode(link.device->firmware.report(), state) == Decoded::ok);
    state.counts.fill(123456);
    auto good = bytes_of(state);
    link.bus->inject(*link.device, good); // same number: replayed
    state.sequence = static_cast<std::uint16_t>(state.sequence - 2);
    link.bus->inject(*link.device, bytes_of(state));
    state.sequence = static_cast<std::uint16_t>(state.sequence + 3);
    link.bus->inject(*link.device, bytes_of(state)); // the device's clock stands still
    auto bad = bytes_of(state);
    bad[30] ^= 4U;
    link.bus->inject(*link.device, bad);
    bad = good;
    bad.pop_back();
    link.bus->inject(*link.device, bad);
    bad = good;
    bad.push_back(0);
    link.bus->inject(*link.device, bad);
    link.bus->inject(*link.device, {0x01});
    CHECK(link.transport.read(link.reading) == Status::read_timeout);
    CHECK(link.reading.counts == CountArray{});
    const HidCounters counters = link.transport.counters();
    CHECK(counters.replayed == 1);
    CHECK(counters.out_of_order == 1);
    CHECK(counters.implausible == 1);
    CHECK(counters.corrupt == 1);
    CHECK(counters.wrong_length == 3);
    CHECK(link.cycle() == Status::ok);
}

TEST_CASE("hid transport: what the device says of itself reaches the servo step") {
    Link link;
    REQUIRE(link.transport.open() == Status::ok);
    link.cycle(30); // the commands that clear what an earlier host left are over
    CHECK(link.reading.device_status == Status::ok);
    link.device->firmware.inputs.motor_power = false;
    link.cycle();
    CHECK(link.reading.device_status == Status::device_no_power);
    link.device->firmware.inputs.motor_power = true;
    link.device->firmware.inputs.emergency_stop = true;
    link.cycle();
    CHECK(link.reading.device_status == Status::device_emergency_stop);
    link.device->firmware.inputs.emergency_stop = false;
    link.cycle(50);
    CHECK(link.reading.device_status == Status::device_emergency_stop); // latched
    link.drive.clear_faults = true;
    link.cycle(2);
    CHECK(link.reading.device_status == Status::ok);
}

TEST_CASE("hid transport: opening clears the watchdog that an earlier host left behind") {
    Link link;
    REQUIRE(link.transport.open() == Status::ok);
    link.cycle();
    link.zero();
    link.pull(1.0);
    link.cycle(50);
    for (int i = 0; i < 60; ++i) {
        link.bus->tick(); // the host is gone
    }
    CHECK((link.device->firmware.flags() & state_flag::kWatchdogTripped) != 0);
    HidTransport next(link.bus, HidTransportSettings{});
    REQUIRE(next.open() == Status::ok);
    for (int i = 0; i < 3; ++i) {
        link.bus->tick();
        next.read(link.reading);
        next.write(DriveCommand());
    }
    CHECK((link.device->firmware.flags() & state_flag::kWatchdogTripped) == 0);
    CHECK(link.device->firmware.counters().stale == 0); // it went on from the device's own count
    CHECK(link.reading.zeroed);                         // never unplugged, so the zero stands
}

TEST_CASE("hid transport: unplugged: lost at once; plugged in again: read, but not zeroed") {
    Link link;
    REQUIRE(link.transport.open() == Status::ok);
    link.cycle();
    link.zero();
    link.pull(1.0);
    link.cycle(50);
    FakeHidBus::unplug(*link.device);
    CHECK(link.cycle() == Status::read_failed);
    CHECK(link.transport.write(link.drive) == Status::write_failed);
    CHECK(link.transport.zero(CountArray{}) == Status::not_open);
    CHECK(link.transport.counters().losses == 1);
    auto other = link.bus->add("B2"); // another device is no replacement
    std::this_thread::sleep_for(std::chrono::milliseconds(600));
    CHECK(link.cycle() == Status::read_failed);

    FakeHidBus::plug(*link.device, "path/elsewhere");
    // Even a device that claims to know its zero.
    REQUIRE(link.device->firmware.set_feature(encode(HidZero{})));
    REQUIRE(link.found_again());
    CHECK(link.cycle(2) == Status::ok);
    CHECK_FALSE(link.reading.zeroed);
    link.cycle(300);
    CHECK_FALSE(link.reading.zeroed);
    REQUIRE(link.device->firmware.set_feature(encode(DeviceControl::stop_all)));
    link.drive = DriveCommand();
    link.cycle(2);
    link.zero();
    CHECK(link.transport.counters().losses == 1);
}

TEST_CASE("hid transport: a device that starts anew without unplugging loses its zero") {
    Link link;
    REQUIRE(link.transport.open() == Status::ok);
    link.cycle();
    link.zero();
    link.cycle(200);
    REQUIRE(link.reading.zeroed);
    {
        const std::lock_guard<std::mutex> lock(link.device->mutex);
        link.device->firmware = FirmwareModel();
        REQUIRE(link.device->firmware.set_feature(encode(HidZero{})));
    }
    link.cycle(19);
    CHECK(link.transport.counters().restarts == 0);
    CHECK(link.cycle(2) == Status::ok);
    CHECK(link.transport.counters().restarts == 1);
    CHECK_FALSE(link.reading.zeroed);
    link.cycle(10);
    CHECK(link.device->firmware.counters().stale <= 20);
    CHECK(link.device->firmware.counters().accepted > 0);
}

TEST_CASE("hid transport: readings from before a zero do not count as after it") {
    Link link;
    REQUIRE(link.transport.open() == Status::ok);
    link.cycle();
    link.zero();
    link.bus->tick(); // in the queue, with the old counts
    CountArray home{};
    home.fill(500);
    REQUIRE(link.transport.zero(home) == Status::ok);
    CHECK(link.transport.read(link.reading) == Status::ok);
    CHECK(link.reading.counts == CountArray{});
    CHECK_FALSE(link.reading.zeroed);
    link.cycle(110);
    CHECK(link.reading.zeroed);
    CHECK(link.reading.counts == home);
    link.pull(1.0);
    link.cycle(2);
    CHECK(link.transport.zero(home) == Status::write_failed); // refused while the motors are on
}

TEST_CASE("hid transport: the device's report can clock the loop, and is not lost by that") {
    Link link;
    CHECK_FALSE(link.transport.wait_report(0)); // not open: the loop's own clock
    REQUIRE(link.transport.open() == Status::ok);
    link.device->firmware.inputs.raw_counts[2] = 7;
    link.bus->tick();
    CHECK(link.transport.wait_report(0));
    CHECK(link.transport.wait_report(0)); // waited for twice, read once
    CHECK(link.transport.read(link.reading) == Status::ok);
    CHECK(link.reading.counts[2] == 7);
    CHECK(link.transport.wait_report(0)); // the time is up
    CHECK(link.transport.read(link.reading) == Status::read_timeout);
    FakeHidBus::unplug(*link.device);
    CHECK(link.transport.wait_report(0));
    CHECK(link.transport.read(link.reading) == Status::read_failed);
    CHECK_FALSE(link.transport.wait_report(0));
}

TEST_CASE("hid transport: a write that hangs keeps neither reading nor closing waiting") {
    Link link;
    REQUIRE(link.transport.open() == Status::ok);
    link.cycle();
    link.device->writes_hang.store(true);
    std::thread writer([&] { link.transport.write(DriveCommand()); });
    while (!link.device->write_hangs.load()) { // else ours would be the one that hangs
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    for (int i = 0; i < 20; ++i) {
        link.bus->tick();
        CHECK(link.transport.read(link.reading) == Status::ok);
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    CHECK(link.transport.write(DriveCommand()) == Status::write_failed); // one at a time
    link.transport.close();
    CHECK(link.transport.read(link.reading) == Status::not_open);
    link.device->writes_hang.store(false);
    writer.join();
}

TEST_CASE("hid transport: what cannot be opened says why, and what to do") {
    auto bus = std::make_shared<FakeHidBus>();
    HidTransportSettings settings;
    HidTransport none(bus, settings);
    CHECK(none.open() == Status::no_device);
    CHECK(none.problem().find("SPIDAR-G") != std::string::npos);

    auto device = bus->add("A1");
    device->permitted = false;
    HidTransport forbidden(bus, settings);
    CHECK(forbidden.open() == Status::no_permission);
    CHECK(forbidden.problem().find("udev/70-spidar-g.rules") != std::string::npos);

    test::FirmwareSettings firmware;
    firmware.capabilities.motor_count = 4;
    device->permitted = true;
    device->firmware = FirmwareModel(firmware);
    HidTransport four(bus, settings);
    CHECK(four.open() == Status::protocol_mismatch);
    CHECK(four.problem().find("4 motors") != std::string::npos);

    settings.filter.product.clear();
    HidTransport anything(bus, settings);
    CHECK(anything.open() == Status::invalid_settings);
    bus->available = false;
    settings.filter.product = "SPIDAR-G";
    HidTransport unavailable(bus, settings);
    CHECK(unavailable.open() == Status::hid_unavailable);
}

TEST_CASE("hid devices: filtered by page and name, never by shared numbers; in the order of their "
          "serials") {
    FakeHidBus bus;
    bus.add("B");
    bus.add("A");
    bus.add("C", "Mouse");
    auto shared = bus.add("D");
    shared->info.vendor_id = 0x04D8;
    shared->info.product_id = 0x003F;
    auto keyboard = bus.add("E");
    keyboard->info.usage_page = 1;
    std::vector<HidDeviceInfo> found;
    REQUIRE(find_devices(bus, HidDeviceFilter{}, found) == Status::ok);
    REQUIRE(found.size() == 2);
    CHECK(found[0].serial == "A");
    CHECK(found[1].serial == "B");
    HidDeviceFilter filter;
    filter.vendor_id = 0x1234;
    CHECK(find_devices(bus, filter, found) == Status::no_device);
    CHECK(found.empty());
}

TEST_CASE(
    "hid transport: unplugged and plugged in at random moments, read and written by two threads") {
    auto bus = std::make_shared<FakeHidBus>();
    auto device = bus->add("A1");
    HidTransport transport(bus, HidTransportSettings{});
    REQUIRE(transport.open() == Status::ok);
    std::atomic<bool> stop{false};
    std::thread writer([&] {
        DriveCommand drive;
        drive.motors_on = true;
        drive.tensions_n.fill(1.0);
        while (!stop.load()) {
            transport.write(drive);
            std::this_thread::sleep_for(std::chrono::microseconds(100));
        }
    });
    DeviceReading reading;
    int good = 0;
    // The watcher looks every 250 ms of real time, whatever a sleep takes here (nothing, under wine).
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(30);
    const auto goes_on = [&] {
        return transport.counters().replugs == 0 && std::chrono::steady_clock::now() < end;
    };
    for (int i = 0; i < 3000 || goes_on(); ++i) {
        if (i % 700 == 300) {
            FakeHidBus::unplug(*device);
        } else if (i % 700 == 350) {
            FakeHidBus::plug(*device, "path/" + std::to_string(i));
        }
        bus->tick();
        good += usable(transport.read(reading)) ? 1 : 0;
        std::this_thread::sleep_for(std::chrono::microseconds(300));
    }
    stop.store(true);
    writer.join();
    CHECK(good >= 300);
    CHECK_FALSE(reading.zeroed);
    CHECK(transport.counters().replugs >= 1);
    transport.close();
}
