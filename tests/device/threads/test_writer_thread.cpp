// The thread that writes to a device: it begins empty, and believes that the motors are off only when the device took it.
#include <doctest/doctest.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <thread>

#include "device/threads/writer_thread.h"

using namespace spidar;
using namespace std::chrono_literals;

namespace {

// Takes commands, or refuses them; a write can be held up.
class MoodyDevice final : public Transport {
public:
    std::atomic<int> refuse_off{0};         // so many commands without motors fail
    std::atomic<bool> refuse_on{false};     // commands with motors fail...
    std::atomic<bool> takes_refused{false}; // ...but arrive all the same
    std::atomic<bool> holds{false};
    std::atomic<bool> held{false};
    std::atomic<bool> motors_on{false};
    std::atomic<int> ons{0}; // that arrived
    std::atomic<int> offs{0};
    std::atomic<int> tries{0};

    Status open() noexcept override { return Status::ok; }
    void close() noexcept override {}
    Status read(DeviceReading & /*reading*/) noexcept override { return Status::read_timeout; }
    Status write(const DriveCommand &command) noexcept override {
        ++tries;
        while (holds) {
            held = true;
            std::this_thread::sleep_for(1ms);
        }
        held = false;
        if (!command.motors_on && refuse_off > 0) {
            --refuse_off;
            return Status::write_failed;
        }
        const bool refused = command.motors_on && refuse_on;
        if (!refused || takes_refused) {
            motors_on = command.motors_on;
            ++(command.motors_on ? ons : offs);
        }
        return refused ? Status::write_failed : Status::ok;
    }
};

template <typename Condition>
bool soon(Condition condition) {
    for (int ms = 0; ms < 20000; ++ms) { // a busy machine may take long; it must not take for ever
        if (condition()) {
            return true;
        }
        std::this_thread::sleep_for(1ms);
    }
    return condition();
}

DriveCommand on() {
    DriveCommand command;
    command.motors_on = true;
    command.tensions_n.fill(2.0);
    return command;
}

} // namespace

TEST_CASE("writer: what was posted before a stop is never written after the next start") {
    MoodyDevice device;
    WriterThread writer(device);
    REQUIRE(writer.start() == Status::ok);
    device.holds = true;
    writer.post(DriveCommand());
    REQUIRE(soon([&] { return device.held.load(); }));
    writer.post(on()); // waits behind the write that hangs
    std::thread stopping([&] { writer.stop(); });
    std::this_thread::sleep_for(20ms);
    device.holds = false;
    stopping.join();
    CHECK(device.ons == 0);
    REQUIRE(writer.start() == Status::ok);
    const int before = device.offs;
    std::this_thread::sleep_for(30ms);
    writer.post(DriveCommand());
    REQUIRE(soon([&] { return device.offs > before; }));
    CHECK(device.ons == 0);
    writer.stop();
    // A post between two runs is not written either.
    writer.post(on());
    REQUIRE(writer.start() == Status::ok);
    std::this_thread::sleep_for(30ms);
    writer.stop();
    CHECK(device.ons == 0);
}

TEST_CASE("writer: a switch-off that fails is tried again until the device takes it") {
    MoodyDevice device;
    WriterThread writer(device);
    REQUIRE(writer.start() == Status::ok);
    writer.post(on());
    REQUIRE(soon([&] { return device.motors_on.load(); }));
    device.refuse_off = 4;
    writer.post(DriveCommand()); // once; nobody posts after it
    REQUIRE(soon([&] { return !device.motors_on; }));
    CHECK(device.refuse_off == 0);
    CHECK(writer.take_result() == Status::write_failed); // of what was posted
    CHECK(writer.take_result() == Status::ok);
    // It took it: no more writes.
    const int tries = device.tries;
    std::this_thread::sleep_for(40ms);
    CHECK(device.tries == tries);
    CHECK_FALSE(writer.take_stalled()); // motors that are off need no post
}

TEST_CASE("writer: a switch-on that fails may have arrived: when the loop stands still it is "
          "switched off") {
    MoodyDevice device;
    device.refuse_on = true;
    device.takes_refused = true;
    WriterThread writer(device);
    REQUIRE(writer.start() == Status::ok);
    writer.post(on());
    REQUIRE(soon([&] { return device.ons > 0; }));
    CHECK(soon([&] { return !device.motors_on; }));
    CHECK(writer.take_stalled());
}

TEST_CASE("writer: stop() switches off, again and again if need be, and not for ever") {
    MoodyDevice device;
    WriterThread writer(device);
    REQUIRE(writer.start() == Status::ok);
    writer.post(on());
    REQUIRE(soon([&] { return device.motors_on.load(); }));
    device.refuse_off = 3;
    writer.stop();
    CHECK_FALSE(device.motors_on);
    // A device that is gone takes nothing: stop() ends all the same, and the next run goes on trying.
    REQUIRE(writer.start() == Status::ok);
    writer.post(on());
    REQUIRE(soon([&] { return device.motors_on.load(); }));
    device.refuse_off = 1'000'000;
    writer.stop();
    CHECK(device.motors_on);
    REQUIRE(writer.start() == Status::ok);
    device.refuse_off = 0;
    CHECK(soon([&] { return !device.motors_on; }));
    CHECK(writer.take_result() == Status::ok); // nothing was posted
}

TEST_CASE("writer: after it found the loop standing still it believes no command before allow()") {
    MoodyDevice device;
    WriterThread writer(device);
    REQUIRE(writer.start() == Status::ok);
    writer.post(on());
    REQUIRE(soon([&] { return device.motors_on.load(); }));
    REQUIRE(soon([&] { return writer.take_stalled(); }));
    CHECK_FALSE(device.motors_on);
    const int ons = device.ons;
    const int offs = device.offs;
    writer.post(on()); // the loop wakes up and posts what it had computed
    REQUIRE(soon([&] { return device.offs > offs; }));
    CHECK(device.ons == ons);
    writer.post(DriveCommand());
    writer.allow();
    writer.post(on());
    CHECK(soon([&] { return device.ons > ons; }));
}
