#include <doctest/doctest.h>

#include <chrono>
#include <thread>

#include "device/contract/device_claims.h"
#include "device/hid/hid_watch.h"
#include "support/fake_hid_bus.h"

using namespace spidar;
using spidar::test::FakeHidBus;

namespace {

constexpr auto kPeriod = std::chrono::milliseconds(5);

bool finds(const HidWatch &watch, std::chrono::milliseconds limit) {
    const auto end = std::chrono::steady_clock::now() + limit;
    while (!watch.found() && std::chrono::steady_clock::now() < end) {
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return watch.found();
}

} // namespace

TEST_CASE("hid watch: a device that is plugged in later is found, another kind is not") {
    const auto bus = std::make_shared<FakeHidBus>();
    const HidWatch watch(bus, HidDeviceFilter(), {}, kPeriod);
    bus->add("watch/0", "A keyboard");
    CHECK_FALSE(finds(watch, std::chrono::milliseconds(60)));
    bus->add("watch/1");
    CHECK(finds(watch, std::chrono::seconds(5)));
}

TEST_CASE("hid watch: a device that was tried is passed over until it was unplugged") {
    const auto bus = std::make_shared<FakeHidBus>();
    const auto device = bus->add("watch/2");
    const HidWatch watch(bus, HidDeviceFilter(), {device->info}, kPeriod);
    CHECK_FALSE(finds(watch, std::chrono::milliseconds(60)));
    FakeHidBus::unplug(*device);
    std::this_thread::sleep_for(std::chrono::milliseconds(60));
    FakeHidBus::plug(*device, "path/watch/2");
    CHECK(finds(watch, std::chrono::seconds(5)));
}

TEST_CASE("hid watch: what somebody owns is not offered; freed, it is") {
    const auto bus = std::make_shared<FakeHidBus>();
    DeviceClaim claim;
    REQUIRE(claim.take("hid:watch/3", "another node"));
    const HidWatch watch(bus, HidDeviceFilter(), {}, kPeriod);
    bus->add("watch/3");
    CHECK_FALSE(finds(watch, std::chrono::milliseconds(60)));
    claim.release();
    CHECK(finds(watch, std::chrono::seconds(5)));
}

TEST_CASE("hid watch: stops at once, also with a long period") {
    const auto start = std::chrono::steady_clock::now();
    {
        const HidWatch watch(std::make_shared<FakeHidBus>(), HidDeviceFilter(), {},
                             std::chrono::seconds(60));
    }
    CHECK(std::chrono::steady_clock::now() - start < std::chrono::seconds(5));
}
