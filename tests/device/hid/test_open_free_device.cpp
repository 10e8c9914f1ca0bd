#include <doctest/doctest.h>

#include <chrono>
#include <thread>

#include "device/hid/open_free_device.h"
#include "support/fake_hid_bus.h"

using namespace spidar;
using spidar::test::FakeHidBus;

namespace {

struct Opened {
    DeviceClaim claim;
    Status status = Status::ok;
    std::string problem;
    std::unique_ptr<HidTransport> transport;

    Opened(const std::shared_ptr<HidBus> &bus, const std::string &owner,
           const HidDeviceFilter &filter = {}) {
        HidTransportSettings settings;
        settings.filter = filter;
        transport = open_free_device(bus, settings, owner, claim, status, problem);
    }
};

} // namespace

TEST_CASE("open free device: each asker gets a device of its own, the third is told who has them") {
    const auto bus = std::make_shared<FakeHidBus>();
    bus->add("free/1");
    bus->add("free/2");
    const Opened first(bus, "one");
    const Opened second(bus, "two");
    REQUIRE(first.transport);
    REQUIRE(second.transport);
    CHECK(first.transport->device().serial == "free/1");
    CHECK(second.transport->device().serial == "free/2");
    const Opened third(bus, "three");
    CHECK_FALSE(third.transport);
    CHECK(third.status == Status::device_in_use);
    CHECK(third.problem.find("\"two\"") != std::string::npos);
    CHECK(third.problem.find("device_serial") != std::string::npos);
    HidDeviceFilter filter;
    filter.serial = "free/1";
    const Opened named(bus, "four", filter);
    CHECK(named.status == Status::device_in_use);
    CHECK(named.problem.find("\"one\"") != std::string::npos);
}

TEST_CASE("open free device: one that may not be opened is passed over and stays free") {
    const auto bus = std::make_shared<FakeHidBus>();
    const auto locked = bus->add("free/3");
    locked->permitted = false;
    {
        const Opened refused(bus, "one");
        CHECK_FALSE(refused.transport);
        CHECK(refused.status == Status::no_permission);
        CHECK_FALSE(refused.problem.empty());
    }
    bus->add("free/4");
    const Opened other(bus, "two");
    REQUIRE(other.transport);
    CHECK(other.status == Status::ok);
    CHECK(other.transport->device().serial == "free/4");
    locked->permitted = true;
    const Opened later(bus, "three");
    REQUIRE(later.transport);
    CHECK(later.transport->device().serial == "free/3");
}

TEST_CASE("open free device: no device, or only another maker's") {
    const auto bus = std::make_shared<FakeHidBus>();
    const Opened none(bus, "one");
    CHECK_FALSE(none.transport);
    CHECK(none.status == Status::no_device);
    bus->add("free/5");
    HidDeviceFilter filter;
    filter.vendor_id = 0x1234;
    const Opened other_maker(bus, "one", filter);
    CHECK(other_maker.status == Status::no_device);
    filter.product.clear();
    const Opened any(bus, "one", filter);
    CHECK(any.status == Status::invalid_settings);
    CHECK(any.problem.starts_with("device_product"));
    const Opened first(bus, "one");
    CHECK(first.transport);
}

TEST_CASE("open free device: a device without a serial number is chosen by its path") {
    const auto bus = std::make_shared<FakeHidBus>();
    bus->add("")->info.path = "/dev/hidraw0";
    bus->add("")->info.path = "/dev/hidraw1";
    HidDeviceFilter filter;
    filter.serial = "/dev/hidraw1";
    const Opened named(bus, "one", filter);
    REQUIRE(named.transport);
    CHECK(named.transport->device().path == "/dev/hidraw1");
    filter.serial = "/dev/hidraw7";
    CHECK(Opened(bus, "two", filter).status == Status::no_device);
}

TEST_CASE("open free device: devices without a serial number are told apart by their paths") {
    const auto bus = std::make_shared<FakeHidBus>();
    const auto left = bus->add("");
    left->info.path = "/dev/hidraw0";
    const auto right = bus->add("");
    right->info.path = "/dev/hidraw1";
    Opened first(bus, "one");
    const Opened second(bus, "two");
    REQUIRE(first.transport);
    REQUIRE(second.transport);
    CHECK(first.transport->device().path == "/dev/hidraw0");
    CHECK(second.transport->device().path == "/dev/hidraw1");
    const Opened third(bus, "three");
    CHECK(third.status == Status::device_in_use);

    // What one pulls, the other does not.
    DeviceReading reading;
    DriveCommand off;
    for (int i = 0; i < 20; ++i) {
        bus->tick();
        first.transport->read(reading);
        first.transport->write(off);
    }
    REQUIRE(first.transport->zero(CountArray{}) == Status::ok);
    DriveCommand pull;
    pull.motors_on = true;
    pull.tensions_n.fill(2.0);
    for (int i = 0; i < 300; ++i) {
        bus->tick();
        first.transport->read(reading);
        first.transport->write(pull);
    }
    CHECK(left->firmware.motors_mn()[0] > 1000);
    CHECK(right->firmware.motors_mn()[0] == 0);
}

TEST_CASE(
    "open free device: one without a serial number that is unplugged takes no other's place") {
    const auto bus = std::make_shared<FakeHidBus>();
    const auto left = bus->add("");
    left->info.path = "/dev/hidraw0";
    const auto right = bus->add("");
    right->info.path = "/dev/hidraw1";
    const Opened opened(bus, "one");
    REQUIRE(opened.transport);
    DeviceReading reading;
    bus->tick();
    REQUIRE(opened.transport->read(reading) == Status::ok);
    FakeHidBus::unplug(*left);
    bus->tick();
    REQUIRE(opened.transport->read(reading) == Status::read_failed);
    std::this_thread::sleep_for(std::chrono::milliseconds(700)); // two polls of the watcher
    CHECK(opened.transport->counters().replugs == 0);
    CHECK(opened.transport->device().path == "/dev/hidraw0");
    FakeHidBus::plug(*left, "/dev/hidraw0");
    for (int i = 0; i < 100 && opened.transport->counters().replugs == 0; ++i) {
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    CHECK(opened.transport->counters().replugs == 1);
}

TEST_CASE("open free device: feature reports are read as Windows wants them") {
    const auto bus = std::make_shared<FakeHidBus>();
    bus->add("windows/1")->wants_largest_buffer = true;
    const Opened opened(bus, "one");
    CHECK(opened.status == Status::ok);
    REQUIRE(opened.transport);
    CHECK(opened.transport->limits().max_tension_mn > 0);
    CHECK(opened.transport->capabilities().motor_count == kStringCount);
}
