// The simulated device as a transport: reports, currents, and each fault doing what it says.
#include <atomic>
#include <limits>
#include <thread>

#include <doctest/doctest.h>

#include "device/simulation/simulated_transport.h"
#include "support/plant_test_support.h"

using namespace spidar;
using namespace spidar::test;

namespace {

constexpr double kCycle_s = 0.001;

DriveCommand tensions_command(const StringArray &tensions_n) {
    DriveCommand command;
    command.tensions_n = tensions_n;
    command.currents_a = currents_for(PlantSettings{}.motors, tensions_n);
    command.motors_on = true;
    return command;
}

HandTarget at(const Vec3 &position_m) {
    HandTarget target;
    target.position_m = position_m;
    return target;
}

// One servo cycle; what read() gave.
Status cycle(SimulatedTransport &device, DeviceReading &reading, double tension_n = 1.0) {
    const Status status = device.read(reading);
    (void)device.write(tensions_command(equal_tensions(tension_n)));
    device.advance(kCycle_s);
    return status;
}

// Opened, armed at 1 N, hand on its way to +x so that every encoder moves.
struct Moving {
    explicit Moving(const PlantSettings &settings = frictionless(false)) : device(settings) {
        REQUIRE(device.open() == Status::ok);
        device.set_hand_target(at({0.15, 0.08, 0.05}));
        for (int i = 0; i < 50; ++i) {
            REQUIRE(cycle(device, reading) == Status::ok);
        }
    }
    SimulatedTransport device;
    DeviceReading reading;
};

} // namespace

TEST_CASE(
    "transport: the first read after open gives the home counts, the next waits for an advance") {
    SimulatedTransport device((PlantSettings()));
    DeviceReading reading;
    CHECK(device.read(reading) == Status::not_open);
    CHECK(device.write({}) == Status::not_open);
    REQUIRE(device.open() == Status::ok);
    CHECK(device.read(reading) == Status::ok);
    CHECK(reading.counts == device.home_counts());
    const double home_m = std::sqrt(0.24 * 0.24 * 2.0 + 0.20 * 0.20);
    CHECK(reading.counts[0] == std::lround(home_m / kPaperMetresPerCount));
    const std::uint16_t sequence = reading.sequence;
    CHECK(device.read(reading) == Status::read_timeout);
    device.advance(kCycle_s);
    CHECK(device.read(reading) == Status::ok);
    CHECK(reading.sequence == sequence + 1);
    CHECK(reading.device_time_us == 1000);
    CHECK(device.simulated());
}

TEST_CASE("transport: home counts are those of a device without errors") {
    PlantSettings settings = frictionless(false);
    settings.length_offset_error_m.fill(0.01);
    settings.length_gain_error.fill(0.02);
    SimulatedTransport device(settings);
    SimulatedTransport ideal(frictionless(false));
    CHECK(device.home_counts() == ideal.home_counts());
    REQUIRE(device.open() == Status::ok);
    DeviceReading reading;
    REQUIRE(device.read(reading) == Status::ok);
    CHECK(reading.counts[0] > device.home_counts()[0] + 600); // 0.01 m + 2 % of 0.39 m = 707 counts
}

TEST_CASE("transport: currents written reach the strings, none with motors off or after close") {
    SimulatedTransport device(frictionless(false));
    REQUIRE(device.open() == Status::ok);
    const auto run = [&device](const DriveCommand &command) {
        CHECK(device.write(command) == Status::ok);
        for (int i = 0; i < 20; ++i) {
            device.advance(kCycle_s);
        }
        return device.truth().tensions_n[2];
    };
    CHECK(run(tensions_command(equal_tensions(3.0))) == doctest::Approx(3.0).epsilon(1e-9));
    DriveCommand off = tensions_command(equal_tensions(3.0));
    off.motors_on = false;
    CHECK(run(off) < 1e-9);
    CHECK(run(tensions_command(equal_tensions(2.0))) == doctest::Approx(2.0).epsilon(1e-9));
    device.close();
    device.close(); // twice is safe
    for (int i = 0; i < 20; ++i) {
        device.advance(kCycle_s);
    }
    CHECK(device.truth().tensions_n[2] < 1e-9);
    DeviceReading reading;
    CHECK(device.read(reading) == Status::not_open);
    CHECK(device.open() == Status::ok);
    CHECK(device.read(reading) == Status::ok);
}

TEST_CASE("transport: settings that cannot be are refused at open") {
    PlantSettings settings;
    settings.rotor_mass_kg = std::numeric_limits<double>::quiet_NaN();
    SimulatedTransport device(settings);
    CHECK(device.open() == Status::invalid_settings);
    DeviceReading reading;
    CHECK(device.read(reading) == Status::not_open);
    device.advance(kCycle_s);
    CHECK(is_finite(device.truth()));
}

TEST_CASE("transport: the hand follows its target and firmness; bad targets are ignored") {
    SimulatedTransport device(frictionless(false));
    REQUIRE(device.open() == Status::ok);
    device.set_hand_target(at({0.05, 0.0, 0.0}));
    device.set_hand_target(at({std::numeric_limits<double>::quiet_NaN(), 0.0, 0.0}));
    device.set_hand_firmness(HandFirmness::firm);
    StringArray tensions = equal_tensions(0.5);
    tensions[0] = 2.0;
    CHECK(device.write(tensions_command(tensions)) == Status::ok);
    for (int i = 0; i < 3; ++i) {
        device.advance(1.0);
    }
    const PlantTruth truth = device.truth();
    REQUIRE(is_finite(truth));
    CHECK(truth.pose.position_m.x > 0.045);
    const Vec3 moved_m = truth.pose.position_m - Vec3(0.05, 0.0, 0.0);
    CHECK(glm::length(moved_m) > 1e-3);
    CHECK(glm::length(moved_m * kFirmHand.stiffness_n_m - truth.strings.force_n) < 1e-5);
}

TEST_CASE("fault: output_cut takes the currents away and leaves the counts") {
    Moving m;
    REQUIRE(m.device.inject({SimulatedFault::output_cut, 0, 0.0, 0.1}));
    CountArray before = m.reading.counts;
    for (int i = 0; i < 50; ++i) {
        CHECK(cycle(m.device, m.reading) == Status::ok);
    }
    CHECK(m.device.truth().tensions_n[0] < 1e-9);
    CHECK(m.reading.counts != before);
    for (int i = 0; i < 100; ++i) {
        CHECK(cycle(m.device, m.reading) == Status::ok);
    }
    CHECK(m.device.truth().tensions_n[0] == doctest::Approx(1.0));
}

TEST_CASE("fault: frozen_counts and stuck_encoder hold counts while the grip moves on") {
    for (const SimulatedFault fault :
         {SimulatedFault::frozen_counts, SimulatedFault::stuck_encoder}) {
        Moving m;
        REQUIRE(m.device.read(m.reading) == Status::ok);
        REQUIRE(m.device.inject({fault, 3, 0.0, 0.04}));
        const CountArray before = m.reading.counts;
        const std::uint16_t sequence = m.reading.sequence;
        m.device.advance(kCycle_s);
        for (int i = 0; i < 30; ++i) {
            CHECK(cycle(m.device, m.reading) == Status::ok);
        }
        CHECK(m.reading.sequence == sequence + 30);
        for (std::size_t i = 0; i < kStringCount; ++i) {
            CAPTURE(i);
            const bool held = fault == SimulatedFault::frozen_counts || i == 3;
            CHECK((m.reading.counts[i] == before[i]) == held);
        }
        for (int i = 0; i < 20; ++i) {
            CHECK(cycle(m.device, m.reading) == Status::ok);
        }
        CHECK(m.reading.counts[3] != before[3]);
    }
}

TEST_CASE("fault: count_jump adds 1000 to one string, from its start to its end") {
    Moving m;
    SimulatedTransport sound(frictionless(false)); // the same life without the fault
    DeviceReading expected;
    REQUIRE(sound.open() == Status::ok);
    sound.set_hand_target(at({0.15, 0.08, 0.05}));
    for (int i = 0; i < 50; ++i) {
        REQUIRE(cycle(sound, expected) == Status::ok);
    }
    REQUIRE(m.device.inject({SimulatedFault::count_jump, 6, 0.010, 0.005}));
    int jumped = 0;
    for (int i = 0; i < 30; ++i) {
        CHECK(cycle(m.device, m.reading) == Status::ok);
        CHECK(cycle(sound, expected) == Status::ok);
        const bool now = i >= 10 && i < 15;
        jumped += now ? 1 : 0;
        CountArray counts = expected.counts;
        counts[6] += now ? kCountJump : 0;
        CAPTURE(i);
        CHECK(m.reading.counts == counts);
    }
    CHECK(jumped == 5);
}

TEST_CASE("fault: read_timeout gives no reports and leaves the reading untouched") {
    Moving m;
    REQUIRE(m.device.inject({SimulatedFault::read_timeout, 0, 0.0, 0.02}));
    DeviceReading untouched = m.reading;
    for (int i = 0; i < 20; ++i) {
        CHECK(cycle(m.device, m.reading) == Status::read_timeout);
    }
    CHECK(m.reading.counts == untouched.counts);
    CHECK(m.reading.sequence == untouched.sequence);
    CHECK(cycle(m.device, m.reading) == Status::ok);
    CHECK(m.reading.sequence != untouched.sequence);
}

TEST_CASE("fault: unplugged fails read, write and open, cuts power, and comes back without it") {
    Moving m;
    REQUIRE(m.device.inject({SimulatedFault::unplugged, 0, 0.0, 0.05}));
    CHECK(m.device.read(m.reading) == Status::read_failed);
    for (int i = 0; i < 20; ++i) {
        CHECK(m.device.write(tensions_command(equal_tensions(1.0))) == Status::write_failed);
        m.device.advance(kCycle_s);
        CHECK(m.device.read(m.reading) == Status::read_failed);
    }
    CHECK(m.device.truth().tensions_n[0] < 1e-9);
    m.device.close();
    CHECK(m.device.open() == Status::open_failed);
    m.device.advance(0.05);
    REQUIRE(m.device.open() == Status::ok);
    m.device.advance(0.02);
    CHECK(m.device.truth().tensions_n[0] < 1e-9); // nobody has written yet
    CHECK(m.device.read(m.reading) == Status::ok);
}

TEST_CASE("fault: broken_string pulls no more and the others do") {
    for (const bool elastic : {false, true}) {
        Moving m(frictionless(elastic));
        REQUIRE(m.device.inject({SimulatedFault::broken_string, 5, 0.0, 0.0}));
        for (int i = 0; i < 50; ++i) {
            CHECK(cycle(m.device, m.reading) == Status::ok);
        }
        CHECK(m.device.truth().tensions_n[5] == 0.0);
        CHECK(m.device.truth().tensions_n[4] > 0.5);
        m.device.clear_faults();
        for (int i = 0; i < 50; ++i) {
            CHECK(cycle(m.device, m.reading) == Status::ok);
        }
        CHECK(m.device.truth().tensions_n[5] > 0.5);
    }
}

TEST_CASE("fault: eight at a time; places come free; malformed ones are refused") {
    Moving m;
    for (int i = 0; i < kMaxFaults; ++i) {
        CHECK(m.device.inject({SimulatedFault::count_jump, i, 0.0, 0.01}));
    }
    CHECK_FALSE(m.device.inject({SimulatedFault::output_cut, 0, 0.0, 0.0}));
    for (int i = 0; i < 20; ++i) {
        (void)cycle(m.device, m.reading);
    }
    CHECK(m.device.inject({SimulatedFault::output_cut, 0, 0.0, 0.0}));
    m.device.clear_faults();
    const double nan = std::numeric_limits<double>::quiet_NaN();
    CHECK_FALSE(m.device.inject({SimulatedFault::count_jump, -1, 0.0, 0.0}));
    CHECK_FALSE(m.device.inject({SimulatedFault::count_jump, 8, 0.0, 0.0}));
    CHECK_FALSE(m.device.inject({SimulatedFault::count_jump, 0, nan, 0.0}));
    CHECK_FALSE(m.device.inject({SimulatedFault::count_jump, 0, -1.0, 0.0}));
    CHECK_FALSE(m.device.inject({SimulatedFault::count_jump, 0, 0.0, nan}));
    CHECK_FALSE(m.device.inject({static_cast<SimulatedFault>(18), 0, 0.0, 0.0}));
    const CountArray sound = m.device.home_counts();
    m.device.set_hand_target(HandTarget{});
    for (int i = 0; i < 2000; ++i) {
        (void)cycle(m.device, m.reading);
    }
    CHECK(m.reading.counts == sound); // no fault is left
    CHECK(m.device.truth().tensions_n[0] == doctest::Approx(1.0));
}

TEST_CASE("transport: two devices given the same run give the same bits, faults and all") {
    const auto run = [] {
        SimulatedTransport device((PlantSettings()));
        REQUIRE(device.open() == Status::ok);
        CHECK(device.inject({SimulatedFault::broken_string, 2, 0.05, 0.1}));
        Random random(77);
        DeviceReading reading;
        std::uint64_t hash = 1469598103934665603U;
        for (int i = 0; i < 300; ++i) {
            if (i % 16 == 0) {
                device.set_hand_target(random.pose(0.1, 0.3, 0.3));
            }
            (void)cycle(device, reading, 0.5 + 0.01 * i);
            for (const std::int32_t count : reading.counts) {
                hash = (hash ^ static_cast<std::uint32_t>(count)) * 1099511628211U;
            }
        }
        return std::pair(hash, device.truth().energy_to_hand_j);
    };
    CHECK(run() == run());
}

TEST_CASE("transport: hand, faults and truth from one thread while another runs the device") {
    SimulatedTransport device((PlantSettings()));
    REQUIRE(device.open() == Status::ok);
    std::atomic<bool> finished{false};
    std::thread servo([&device, &finished] {
        DeviceReading reading;
        for (int i = 0; i < 1000; ++i) {
            (void)cycle(device, reading);
        }
        finished.store(true);
    });
    Random random(9);
    double last_s = 0.0;
    bool in_order = true;
    bool finite = true;
    for (int round = 0; !finished.load(); ++round) {
        device.set_hand_target(random.pose(0.1, 0.3, 0.3));
        device.set_hand_firmness(static_cast<HandFirmness>(round % 3));
        (void)device.inject({SimulatedFault::count_jump, round % 8, 0.0, 0.002});
        const PlantTruth truth = device.truth();
        in_order = in_order && truth.time_s >= last_s;
        finite = finite && is_finite(truth);
        last_s = truth.time_s;
    }
    servo.join();
    CHECK(in_order);
    CHECK(finite);
    CHECK(device.truth().time_s == doctest::Approx(1.0));
}
