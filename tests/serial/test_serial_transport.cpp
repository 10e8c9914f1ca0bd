// The real transport against boards on a pseudo-terminal: found, read, driven, and told apart from what is none.
#include <doctest/doctest.h>

#include <limits>

#include <sys/stat.h>

#include "device/serial/serial_port.h"
#include "serial/serial_rig.h"

using namespace spidar;
using namespace spidar::test;

namespace {

// Asks once a millisecond; the number of good readings.
int exchange(SerialTransport &transport, const DriveCommand &command, DeviceReading &reading,
             int rounds) {
    int good = 0;
    for (int i = 0; i < rounds; ++i) {
        CHECK(usable(transport.write(command)));
        sleep_ms(1);
        good += transport.read(reading) == Status::ok ? 1 : 0;
    }
    return good;
}

} // namespace

TEST_SUITE_BEGIN("quick");

TEST_CASE("serial transport: a B5M is found, asked and driven") {
    BoardBus bus(one_b5m(), link_of_this_test());
    SerialTransport transport(settings_for(bus.link()));
    REQUIRE_MESSAGE(usable(transport.open()), transport.problem());
    CHECK(transport.remarks() == "");
    REQUIRE(transport.boards().size() == 1);
    CHECK(transport.boards()[0].info == kB5mInfo);
    CHECK(transport.highest_rate_hz() == doctest::Approx(2950.8).epsilon(1e-4));
    CHECK(transport.device_name() == "serial:" + bus.link());

    DriveCommand command;
    command.motors_on = true;
    for (std::size_t i = 0; i < kStringCount; ++i) {
        command.currents_a[i] = 0.1 * static_cast<double>(i + 1);
    }
    command.currents_a[6] = 100.0; // more than any limit
    command.currents_a[7] = std::numeric_limits<double>::quiet_NaN();
    DeviceReading reading;
    CHECK(exchange(transport, command, reading, 100) >= 80);
    CHECK(reading.device_status == Status::ok);
    CHECK(!reading.zeroed);
    const auto currents = bus.with_boards([](auto &boards) { return boards[0].currents(); });
    CHECK(currents[0] == 62);
    CHECK(currents[5] == 371);
    CHECK(currents[6] == 1024);
    CHECK(currents[7] == 0);
    transport.close();
    CHECK(bus.seen().cut_replies == 0);
    CHECK(wait_for([&] { return bus.seen().strongest == 0; }, 100));
    CHECK(transport.read(reading) == Status::not_open);
}

TEST_CASE("serial transport: two B3M on one bus, their strings in a table with signs") {
    BoardBus bus(two_b3m(), link_of_this_test());
    SerialTransportSettings settings = settings_for(bus.link());
    settings.motors_in_order = false;
    for (int i = 0; i < kStringCount; ++i) { // the other way round
        settings.motors[static_cast<std::size_t>(i)] = {1 - i / 4, 3 - i % 4, i % 2 == 0 ? -1 : 1,
                                                        i % 2 == 0 ? 1 : -1};
    }
    SerialTransport transport(settings);
    REQUIRE_MESSAGE(usable(transport.open()), transport.problem());
    REQUIRE(transport.boards().size() == 2);
    DriveCommand command;
    command.motors_on = true;
    command.currents_a = {0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8};
    DeviceReading reading;
    CHECK(exchange(transport, command, reading, 100) >= 80);
    const auto first = bus.with_boards([](auto &boards) { return boards[0].currents(); });
    const auto second = bus.with_boards([](auto &boards) { return boards[1].currents(); });
    CHECK(second[3] == 62);
    CHECK(second[2] == -124);
    CHECK(first[0] == -494);
    bus.set_hand_target({Vec3(0.02, 0.0, 0.0), Mat3(1.0), 0.0});
    (void)exchange(transport, DriveCommand(), reading, 600);
    const CountArray counts = bus.counts();
    for (std::size_t i = 0; i < kStringCount; ++i) {
        const std::int32_t mine = settings.motors[i].count_sign * reading.counts[i];
        CHECK(std::abs(mine - counts[kStringCount - 1 - i]) <= 40);
    }
}

TEST_CASE(
    "serial transport: three boards of two kinds, and one that adds its currents to its reply") {
    BusSettings settings = bus_of({{0, kB3mInfo, 0}, {3, kB3mInfo, 4}, {6, kB5mInfo, 0}});
    BoardBus bus(settings, link_of_this_test());
    SerialTransport transport(settings_for(bus.link()));
    REQUIRE_MESSAGE(usable(transport.open()), transport.problem());
    REQUIRE(transport.boards().size() == 3);
    CHECK(transport.boards()[1].id == 3);
    CHECK(transport.boards()[1].extra_words == 4);
    CHECK(transport.boards()[2].extra_words == 0);
    DeviceReading reading;
    CHECK(exchange(transport, {}, reading, 200) >= 150);
    CHECK(bus.seen().cut_replies == 0);
    const SerialCounters counters = transport.counters();
    CHECK(counters.garbage_bytes == 0);
    CHECK(counters.asked <= counters.rounds + counters.lost + ReplyReader::kInFlight);
}

TEST_CASE("serial transport: encoders that are not read by quadrature are told") {
    BoardBus bus(one_b5m(), link_of_this_test());
    bus.with_boards([](auto &boards) { boards[0].quadrature_mask = 0; });
    SerialTransport transport(settings_for(bus.link()));
    REQUIRE(usable(transport.open()));
    CHECK(transport.remarks().find("quadrature") != std::string::npos);
}

TEST_CASE("serial transport: what keeps a port from being opened is told with its remedy") {
    SUBCASE("no such port") {
        SerialTransport transport(settings_for("/tmp/spidar_serial_nothing"));
        CHECK(transport.open() == Status::no_device);
        CHECK(transport.problem().find("plug the device in") != std::string::npos);
    }
    SUBCASE("another program has it") {
        BoardBus bus(one_b5m(), link_of_this_test());
        Status status = Status::ok;
        std::string problem;
        const auto first = open_serial_port(bus.link(), kBoardBaud, status, problem);
        REQUIRE(first);
        SerialTransport transport(settings_for(bus.link()));
        CHECK(transport.open() == Status::device_in_use);
        CHECK(transport.problem().find("Another program") != std::string::npos);
    }
    SUBCASE("this user may not") {
        BoardBus bus(one_b5m(), link_of_this_test());
        REQUIRE(chmod(bus.link().c_str(), 0) == 0);
        const uid_t nobody = 65534;
        const bool was_root = geteuid() == 0;
        if (was_root) {
            REQUIRE(seteuid(nobody) == 0);
        }
        SerialTransport transport(settings_for(bus.link()));
        const Status status = transport.open();
        if (was_root) {
            REQUIRE(seteuid(0) == 0);
        }
        CHECK(status == Status::no_permission);
        CHECK(transport.problem().find("70-spidar-g.rules") != std::string::npos);
    }
    SUBCASE("no board answers") {
        BoardBus bus(bus_of({}), link_of_this_test());
        SerialTransport transport(settings_for(bus.link()));
        CHECK(transport.open() == Status::protocol_mismatch);
        CHECK(transport.problem().find("no motor board answers") != std::string::npos);
    }
    SUBCASE("too few motors") {
        BoardBus bus(bus_of({{0, kB3mInfo, 0}}), link_of_this_test());
        SerialTransport transport(settings_for(bus.link()));
        CHECK(transport.open() == Status::protocol_mismatch);
        CHECK(transport.problem().find("have 4 motors, and a SPIDAR-G needs 8") !=
              std::string::npos);
    }
    SUBCASE("a table that does not fit") {
        BoardBus bus(one_b5m(), link_of_this_test());
        SerialTransportSettings settings = settings_for(bus.link());
        settings.motors_in_order = false;
        settings.motors.fill({1, 0, 1, 1}); // all strings on one motor
        SerialTransport transport(settings);
        CHECK(transport.open() == Status::invalid_settings);
        CHECK(transport.problem().find("pulls string 1 already") != std::string::npos);
    }
}

TEST_CASE("serial transport: the link's latency is measured, and a slow bridge shows") {
    constexpr double kRate_hz = 1000.0;
    const auto latency_of = [](int delay_us) {
        BoardBus bus(one_b5m(), link_of_this_test());
        bus.faults.delay_us.store(delay_us);
        SerialTransport transport(settings_for(bus.link()));
        CHECK(transport.latency_s(kRate_hz) == 0.0);
        REQUIRE_MESSAGE(usable(transport.open()), transport.problem());
        return transport.latency_s(kRate_hz);
    };
    const double quick_s = latency_of(0);
    const double slow_s = latency_of(5000);
    MESSAGE("latency " << 1e3 * quick_s << " ms, behind a bridge of 5 ms " << 1e3 * slow_s
                       << " ms");
    CHECK(quick_s > 0.001);  // a whole cycle, and the wire
    CHECK(slow_s >= 0.0063); // that of the bridge in whole cycles, and the wire
    CHECK(slow_s < 0.020);
}

TEST_CASE("serial transport: without a guard it reads, but says that it cannot pull, and sends no "
          "current") {
    BoardBus bus(one_b5m(), link_of_this_test());
    SerialTransportSettings settings = settings_for(bus.link());
    settings.guard = "/tmp/spidar_serial_no_guard";
    SerialTransport transport(settings);
    REQUIRE(usable(transport.open()));
    CHECK(transport.remarks().find("guard") != std::string::npos);
    DriveCommand command;
    command.motors_on = true;
    command.currents_a.fill(0.5);
    DeviceReading reading;
    CHECK(exchange(transport, command, reading, 50) >= 30);
    CHECK(reading.device_status == Status::device_watchdog);
    CHECK(bus.seen().strongest_ever == 0);
}

TEST_CASE("serial transport: a line that loses bytes and adds garbage gives fewer readings, and no "
          "wrong one") {
    BoardBus bus(one_b5m(), link_of_this_test());
    SerialTransport transport(settings_for(bus.link()));
    REQUIRE(usable(transport.open()));
    DeviceReading reading;
    REQUIRE(exchange(transport, {}, reading, 20) > 0);
    bus.faults.lost_bytes.store(0.1);
    bus.faults.garbage.store(0.1);
    int good = 0;
    for (int i = 0; i < 1000; ++i) {
        bus.set_hand_target(wave(1.0 + 0.001 * i));
        REQUIRE(usable(transport.write({})));
        sleep_ms(1);
        const CountArray counts = bus.counts();
        if (transport.read(reading) == Status::ok) {
            ++good;
            for (std::size_t s = 0; s < kStringCount; ++s) {
                REQUIRE(std::abs(reading.counts[s] - counts[s]) <=
                        400); // 0.2 m/s, read some ms late
            }
        }
    }
    const SerialCounters counters = transport.counters();
    MESSAGE(good << " good readings of 1000, " << counters.garbage_bytes << " bytes of garbage, "
                 << counters.lost << " rounds lost");
    CHECK(good >= 400);
    CHECK(counters.garbage_bytes > 500);
    CHECK(counters.lost > 50);
    CHECK(counters.asked <= counters.rounds + counters.lost + ReplyReader::kInFlight);
}

TEST_SUITE_END();
