// Boards that are found later than they are looked for.
#include <doctest/doctest.h>

#include "device/contract/device_claims.h"
#include "device/serial/open_serial_device.h"
#include "device/serial/serial_port.h"
#include "serial/serial_rig.h"

using namespace spidar;
using namespace spidar::test;

namespace {

constexpr int kFind_ms = 3000;

std::unique_ptr<SerialTransport> found_by(SerialSearch &search, int limit_ms) {
    std::unique_ptr<SerialTransport> found;
    (void)wait_for(
        [&] {
            found = search.take();
            return found != nullptr;
        },
        limit_ms);
    return found;
}

} // namespace

TEST_SUITE_BEGIN("quick");

TEST_CASE("serial search: a port that comes later is found, kept awake, and nobody's when it is "
          "fetched") {
    const std::string link = link_of_this_test();
    SerialSearch search(settings_for(link), "searcher");
    Status status = Status::ok;
    std::string problem;
    REQUIRE(wait_for([&] { return search.take_failure(status, problem); }, kFind_ms));
    CHECK(status == Status::no_device);
    CHECK(problem.find(link) != std::string::npos);
    CHECK(search.take() == nullptr);

    BoardBus bus(one_b5m(), link);
    const std::string name = serial_device_name(link);
    REQUIRE(wait_for([&] { return DeviceClaim::owner_of(name) == "searcher"; }, kFind_ms));
    sleep_ms(300); // far longer than boards may be silent
    const std::unique_ptr<SerialTransport> found = found_by(search, kFind_ms);
    REQUIRE(found);
    CHECK(DeviceClaim::owner_of(name).empty());
    CHECK(usable(found->open())); // it is open already
    DeviceReading reading;
    CHECK(found->read(reading) == Status::ok);
    CHECK(reading.device_status == Status::ok);
    CHECK(found->counters().losses == 0);
    CHECK(search.take() == nullptr);
}

TEST_CASE("serial search: a port that another one owns, and boards that do not answer") {
    BoardBus bus(one_b5m(), link_of_this_test());
    bus.faults.silent.store(true);
    Status status = Status::ok;
    std::string problem;
    DeviceClaim other;
    REQUIRE(other.take(serial_device_name(bus.link()), "other"));
    SerialSearch search(settings_for(bus.link()), "searcher");
    REQUIRE(wait_for([&] { return search.take_failure(status, problem); }, kFind_ms));
    CHECK(status == Status::device_in_use);
    CHECK(problem.find("\"other\"") != std::string::npos);
    other.release();
    REQUIRE(wait_for(
        [&] { return search.take_failure(status, problem) && status == Status::protocol_mismatch; },
        kFind_ms));
    CHECK(DeviceClaim::owner_of(serial_device_name(bus.link())).empty());
    bus.faults.silent.store(false);
    CHECK(found_by(search, kFind_ms));
}

TEST_CASE("serial search: its end breaks a look off") {
    BoardBus bus(one_b5m(), link_of_this_test());
    bus.faults.silent.store(true); // a whole look takes 0.35 s
    auto search = std::make_unique<SerialSearch>(settings_for(bus.link()), "searcher");
    REQUIRE(wait_for([&] { return bus.seen().heard_bytes > 0; }, kFind_ms));
    const std::int64_t start_ns = monotonic_ns();
    search.reset();
    const double took_ms = 1e-6 * static_cast<double>(monotonic_ns() - start_ns);
    MESSAGE("ended after " << took_ms << " ms");
    CHECK(took_ms < 200.0);
}

TEST_SUITE_END();
