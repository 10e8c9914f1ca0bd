// The servo loop through the serial transport: its rate, and what it does when the cable or the guard goes.
#include <doctest/doctest.h>

#include <csignal>
#include <filesystem>

#include "serial/serial_rig.h"

using namespace spidar;
using namespace spidar::test;

namespace {

struct Rates {
    double asked_hz = 0.0;
    double answered_hz = 0.0;
    SerialCounters counters;
    LoopStatistics loop;
};

// The loop at rest in CONNECTED, which asks as often as one that pulls.
Rates run_for(const BusSettings &bus_settings, double time_s) {
    BoardBus bus(bus_settings, link_of_this_test());
    SerialHost host(settings_for(bus.link()));
    REQUIRE(usable(host.start()));
    REQUIRE(host.run_until(DeviceState::connected, 1000));
    const SerialCounters before = host.transport->counters();
    const std::int64_t start_ns = monotonic_ns();
    while (monotonic_ns() - start_ns < static_cast<std::int64_t>(1e9 * time_s)) {
        host.tick();
    }
    Rates rates;
    rates.counters = host.transport->counters();
    const double took_s = 1e-9 * static_cast<double>(monotonic_ns() - start_ns);
    rates.asked_hz = static_cast<double>(rates.counters.asked - before.asked) / took_s;
    rates.answered_hz = static_cast<double>(rates.counters.rounds - before.rounds) / took_s;
    rates.loop = host.loop->statistics();
    CHECK(rates.counters.asked <=
          rates.counters.rounds + rates.counters.lost + ReplyReader::kInFlight);
    CHECK(rates.counters.implausible == 0);
    CHECK(rates.counters.write_failures == 0);
    MESSAGE("asked " << rates.asked_hz << " Hz, answered " << rates.answered_hz << " Hz, lost "
                     << rates.counters.lost << ", in pieces or cut " << rates.counters.damaged
                     << ", garbage " << rates.counters.garbage_bytes);
    return rates;
}

// A force of 2 N, while somebody moves the hand.
void pull(SerialHost &host, BoardBus &bus) {
    host.command.wrench.force_n = Vec3(0.0, 2.0, 0.0);
    REQUIRE(host.activate([&](double time_s) { bus.set_hand_target(wave(time_s)); }));
}

// Until the boards' currents show it.
void wait_for_pull(SerialHost &host, BoardBus &bus) {
    REQUIRE(wait_for(
        [&] {
            host.tick();
            return bus.seen().strongest > 50;
        },
        500));
}

// The loop by itself, without a word of the game.
bool comes_to(SerialHost &host, DeviceState state) {
    return wait_for(
        [&] {
            (void)host.loop->latest(host.now);
            return host.now.state == state;
        },
        1000);
}

} // namespace

TEST_SUITE_BEGIN("quick");

TEST_CASE("serial loop: a B5M is asked a thousand times a second") {
    const Rates rates = run_for(one_b5m(), 2.0);
    CHECK(rates.asked_hz >= 900.0); // less what a busy machine makes late
    CHECK(rates.answered_hz >= 0.9 * rates.asked_hz);
}

TEST_CASE("serial loop: cable pulled while it pulls, and plugged in again") {
    BoardBus bus(one_b5m(), link_of_this_test());
    SerialHost host(settings_for(bus.link()));
    REQUIRE(usable(host.start()));
    pull(host, bus);
    wait_for_pull(host, bus);

    const std::int64_t pulled_ns = monotonic_ns();
    bus.unplug();
    const bool closed = comes_to(host, DeviceState::closed);
    const double closed_ms = 1e-6 * static_cast<double>(monotonic_ns() - pulled_ns);
    MESSAGE("CLOSED " << closed_ms << " ms after the cable was pulled");
    CHECK(closed);
    CHECK(closed_ms <= 5.0);
    CHECK(bus.seen().strongest >
          0); // the boards hold their current: docs/reference/serial_boards.md

    REQUIRE(bus.plug());
    const std::int64_t plugged_ns = monotonic_ns();
    CHECK(wait_for([&] { return host.transport->counters().replugs == 1; }, 2000));
    CHECK(wait_for([&] { return bus.seen().strongest == 0; }, 1000)); // the handshake asks for none
    const double found_ms = 1e-6 * static_cast<double>(monotonic_ns() - plugged_ns);
    MESSAGE("found again after " << found_ms << " ms");
    CHECK(found_ms <= 1000.0);
    CHECK(host.recover());
    CHECK(!host.now.zero_known);
}

TEST_CASE("serial loop: boards that lost their power are found again, and their counts are not "
          "believed") {
    BoardBus bus(one_b5m(), link_of_this_test());
    SerialHost host(settings_for(bus.link()));
    REQUIRE(usable(host.start()));
    bus.set_hand_target(
        {Vec3(0.03, 0.0, 0.0), Mat3(1.0), 0.0});   // away from where it was switched on
    (void)host.run_until(DeviceState::fault, 600); // only where a busy machine held the bytes up
    REQUIRE(host.recover());
    REQUIRE(host.transport->counters().losses == 0);
    bus.restart_boards();
    CHECK(wait_for(
        [&] {
            host.tick();
            return host.transport->counters().losses == 1;
        },
        1000));
    CHECK(wait_for(
        [&] {
            host.tick();
            return host.transport->counters().replugs == 1;
        },
        1500));
    CHECK(!host.now.zero_known);
}

TEST_CASE("serial guard: killed while the motors pull, they are off and the loop in FAULT") {
    BoardBus bus(one_b5m(), link_of_this_test());
    SerialHost host(settings_for(bus.link()));
    REQUIRE(usable(host.start()));
    pull(host, bus);
    wait_for_pull(host, bus);
    const int guard = host.transport->guard_process();
    REQUIRE(guard > 0);
    REQUIRE(kill(guard, SIGKILL) == 0);
    const std::int64_t killed_ns = monotonic_ns();
    CHECK(wait_for([&] { return bus.seen().strongest == 0; }, 1000));
    const double off_ms = 1e-6 * static_cast<double>(monotonic_ns() - killed_ns);
    CHECK(comes_to(host, DeviceState::fault));
    const double fault_ms = 1e-6 * static_cast<double>(monotonic_ns() - killed_ns);
    MESSAGE("motors off after " << off_ms << " ms, FAULT after " << fault_ms << " ms");
    CHECK(off_ms <= 25.0);
    CHECK(fault_ms <= 25.0);
    CHECK(host.now.fault == Status::device_watchdog);
    // Another guard is started, and the way back is the usual one.
    CHECK(wait_for([&] { return host.transport->guard_process() != guard; }, 2000));
    sleep_ms(300);
    CHECK(host.recover());
    CHECK(host.transport->counters().guard_losses == 1);
}

TEST_CASE("serial guard: one that hangs counts as lost") {
    BoardBus bus(one_b5m(), link_of_this_test());
    SerialHost host(settings_for(bus.link()));
    REQUIRE(usable(host.start()));
    pull(host, bus);
    const int guard = host.transport->guard_process();
    REQUIRE(kill(guard, SIGSTOP) == 0);
    const std::int64_t stopped_ns = monotonic_ns();
    CHECK(wait_for(
        [&] {
            host.tick();
            return host.now.state == DeviceState::fault;
        },
        1000));
    const double fault_ms = 1e-6 * static_cast<double>(monotonic_ns() - stopped_ns);
    MESSAGE("FAULT " << fault_ms << " ms after the guard was stopped");
    CHECK(fault_ms <= 60.0); // it may be silent for 40 ms
    CHECK(wait_for([&] { return bus.seen().strongest == 0; }, 100));
    CHECK(wait_for([&] { return host.transport->guard_process() != guard; }, 2000));
}

TEST_CASE("serial guard: a file that lost its mark of a program is started all the same") {
    const std::string file = link_of_this_test();
    std::filesystem::copy_file(kGuardProgram, file);
    std::filesystem::permissions(file, std::filesystem::perms::owner_read);
    BoardBus bus(one_b5m(), link_of_this_test());
    SerialTransportSettings settings = settings_for(bus.link());
    settings.guard = file;
    SerialTransport transport(settings);
    REQUIRE(usable(transport.open()));
    CHECK(transport.remarks() == "");
    CHECK(kill(transport.guard_process(), 0) == 0);
    std::filesystem::remove(file);
}

TEST_CASE("serial guard: it ends with the transport") {
    BoardBus bus(one_b5m(), link_of_this_test());
    SerialTransport transport(settings_for(bus.link()));
    REQUIRE(usable(transport.open()));
    const int guard = transport.guard_process();
    REQUIRE(guard > 0);
    CHECK(kill(guard, 0) == 0);
    transport.close();
    CHECK(kill(guard, 0) != 0);
    CHECK(transport.guard_process() == -1);
}

TEST_SUITE_END();

TEST_SUITE_BEGIN("long");

TEST_CASE("serial loop: a minute with each bus, and no loss that is not counted") {
    const BusSettings mixed = bus_of({{0, kB5mInfo, 0}, {3, kB3mInfo, 0}, {5, kB3mInfo, 0}});
    for (const BusSettings &bus : {one_b5m(), two_b3m(), mixed}) {
        const Rates rates = run_for(bus, 60.0);
        CHECK(rates.asked_hz >= 950.0);
        CHECK(rates.answered_hz >= 0.95 * rates.asked_hz);
    }
}

TEST_CASE("serial loop: eight boards are asked as often as the wire allows") {
    std::vector<BoardLayout> boards;
    for (std::uint8_t id = 0; id < 8; ++id) {
        boards.push_back({id, kB3mInfo, 0});
    }
    const Rates rates = run_for(bus_of(boards), 10.0);
    CHECK(rates.asked_hz >= 400.0); // every second cycle of 1 ms: a round takes 1.48 ms
    CHECK(rates.asked_hz <= 676.0);
    CHECK(rates.counters.postponed > 0);
}

TEST_SUITE_END();
