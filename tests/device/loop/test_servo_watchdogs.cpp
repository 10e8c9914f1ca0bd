// The loop's own watchdogs, in real threads: blocked writes, a stalled thread, panic from anywhere, late cycles, a
// device that opens later, a device that clocks the loop.
#include <doctest/doctest.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <thread>

#include "device/threads/real_time_thread.h"
#include "support/servo_fixture.h"

using namespace spidar;
using spidar::test::ideal_settings;

namespace {

using namespace std::chrono_literals;

// Stands still at home. Each call can be told to take long.
struct SlowDevice {
    std::atomic<int> write_takes_ms{0};
    std::atomic<int> read_takes_ms{0};
    std::atomic<int> opens_fail{0};
    std::atomic<bool> clocks{false};
    std::atomic<bool> is_gone{false};
    std::atomic<bool> is_real{false};
    std::atomic<bool> is_moved{false}; // on a path through the workspace, from home on
    int path_ms = 0;                   // the loop's own
    std::atomic<int> opens{0};
    std::atomic<int> writes{0};
    std::atomic<bool> motors_on{false};
    std::atomic<std::int64_t> off_ns{0}; // when the motors went off last
    std::atomic<bool> writing{false};
    std::atomic<bool> two_writers{false};
    std::atomic<bool> motors_on_at_close{false};
};

class SlowTransport final : public Transport {
public:
    SlowTransport(SlowDevice &device, bool may_block) : device_(device), may_block_(may_block) {}
    Status open() noexcept override {
        return ++device_.opens <= device_.opens_fail ? Status::open_failed : Status::ok;
    }
    void close() noexcept override { device_.motors_on_at_close = device_.motors_on.load(); }
    Status read(DeviceReading &reading) noexcept override {
        nap(device_.read_takes_ms);
        device_.path_ms = device_.is_moved ? device_.path_ms + 1 : 0;
        reading.counts = counts_on_path(0.001 * device_.path_ms);
        return device_.is_gone ? Status::read_failed : Status::ok;
    }
    Status write(const DriveCommand &command) noexcept override {
        if (device_.writing.exchange(true)) {
            device_.two_writers = true;
        }
        nap(device_.write_takes_ms);
        if (device_.motors_on.exchange(command.motors_on) && !command.motors_on) {
            device_.off_ns = monotonic_ns();
        }
        ++device_.writes;
        device_.writing = false;
        return Status::ok;
    }
    [[nodiscard]] bool write_may_block() const noexcept override { return may_block_; }
    [[nodiscard]] bool wait_report(std::int64_t until_ns) noexcept override {
        if (!device_.clocks) {
            return false;
        }
        sleep_until_ns(
            std::min(until_ns, monotonic_ns() + 500'000)); // reports each half millisecond
        return true;
    }
    [[nodiscard]] bool simulated() const noexcept override { return !device_.is_real; }

private:
    [[nodiscard]] CountArray counts_on_path(double way) const noexcept {
        const Vec3 place(std::sin(4.0 * way), std::sin(3.0 * way), -std::sin(3.5 * way));
        return spidar::test::counts_of(settings_, spidar::test::moved_by(settings_, 0.04 * place));
    }
    const ServoSettings settings_ = ideal_settings();
    static void nap(const std::atomic<int> &takes_ms) {
        if (takes_ms > 0) {
            std::this_thread::sleep_for(std::chrono::milliseconds(takes_ms.load()));
        }
    }
    SlowDevice &device_;
    bool may_block_;
};

ServoSettings quick_settings() {
    ServoSettings settings = ideal_settings();
    settings.safety.arming_time_s = 0.01;
    return settings;
}

HapticCommand forces_on() {
    HapticCommand command;
    command.forces_enabled = true;
    return command;
}

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

bool told(ServoLoop &loop, DeviceEventKind kind) {
    DeviceEvent event;
    while (loop.next_event(event)) {
        if (event.kind == kind) {
            return true;
        }
    }
    return false;
}

std::uint64_t ticks_of(ServoLoop &loop) {
    ServoSnapshot snapshot;
    std::uint64_t ticks = 0;
    while (loop.latest(snapshot)) {
        ticks = snapshot.counters.ticks;
    }
    return ticks;
}

} // namespace

TEST_CASE(
    "watchdog: a write that blocks for 5 s never holds the loop; newest only; no force after it") {
    SlowDevice device;
    ServoLoop loop(std::make_unique<SlowTransport>(device, true));
    REQUIRE(loop.start_threaded(quick_settings()) == Status::ok);
    loop.publish(forces_on());
    REQUIRE(soon([&] { return device.motors_on.load(); }));
    device.write_takes_ms = 5000;
    REQUIRE(soon([&] { return device.writing.load(); }));
    std::this_thread::sleep_for(50ms);
    const int writes = device.writes;
    const std::uint64_t before = ticks_of(loop);
    ServoSnapshot snapshot;
    REQUIRE(soon([&] {
        (void)loop.latest(snapshot);
        return snapshot.counters.ticks >= before + 500;
    }));
    CHECK(device.writes <=
          writes + 1); // half a second of cycles while the device took one write at most
    CHECK(snapshot.state == DeviceState::fault); // a device that takes nothing is not to be driven
    CHECK(snapshot.fault == Status::write_failed);
    CHECK(told(loop, DeviceEventKind::write_blocked));
    device.write_takes_ms = 0;
    REQUIRE(soon([&] { return device.writes > writes + 2; }));
    CHECK_FALSE(device.motors_on); // the newest command was: off
    CHECK_FALSE(device.two_writers);
    loop.stop();
    CHECK_FALSE(device.motors_on_at_close);
}

TEST_CASE("watchdog: a servo thread that stands still: the writer thread switches the motors off") {
    SlowDevice device;
    ServoLoop loop(std::make_unique<SlowTransport>(device, true));
    REQUIRE(loop.start_threaded(quick_settings()) == Status::ok);
    loop.publish(forces_on());
    REQUIRE(soon([&] { return device.motors_on.load(); }));
    std::this_thread::sleep_for(20ms);
    device.off_ns = 0;
    device.read_takes_ms = 400;                                     // the thread hangs in a read
    REQUIRE(soon([&] { return loop.since_last_cycle_s() > 0.1; })); // what a game sees
    CHECK(soon([&] { return device.off_ns != 0; }));
    CHECK_FALSE(device.motors_on);
    device.read_takes_ms = 0;
    ServoSnapshot snapshot;
    REQUIRE(soon([&] {
        (void)loop.latest(snapshot);
        return snapshot.state == DeviceState::fault;
    }));
    CHECK(snapshot.fault == Status::loop_stalled);
    std::this_thread::sleep_for(30ms);
    CHECK_FALSE(device.motors_on); // and stays off
}

TEST_CASE("panic stop: from any thread, with and without a writer thread; latched") {
    for (const bool may_block : {false, true}) {
        SlowDevice device;
        ServoLoop loop(std::make_unique<SlowTransport>(device, may_block));
        REQUIRE(loop.start_threaded(quick_settings()) == Status::ok);
        HapticCommand command = forces_on();
        loop.publish(command);
        REQUIRE(soon([&] { return device.motors_on.load(); }));
        std::thread other([&] { loop.panic_stop(); });
        other.join();
        REQUIRE(soon([&] { return !device.motors_on.load(); }));
        ServoSnapshot snapshot;
        REQUIRE(soon([&] {
            (void)loop.latest(snapshot);
            return snapshot.state == DeviceState::fault;
        }));
        CHECK(snapshot.fault == Status::panic_stopped);
        CHECK(told(loop, DeviceEventKind::panic_stopped));
        ++command.arm_count; // alone it does not help
        loop.publish(command);
        std::this_thread::sleep_for(50ms);
        CHECK_FALSE(device.motors_on);
        ++command.clear_fault_count;
        loop.publish(command);
        REQUIRE(soon([&] {
            (void)loop.latest(snapshot);
            return snapshot.state != DeviceState::fault;
        }));
        ++command.arm_count;
        loop.publish(command);
        CHECK(soon([&] { return device.motors_on.load(); }));
    }
}

TEST_CASE("panic stop: of a loop that does not run: the device opens stopped, until the fault is "
          "cleared") {
    for (const bool threaded : {false, true}) {
        CAPTURE(threaded);
        SlowDevice device;
        ServoLoop loop(std::make_unique<SlowTransport>(device, false));
        const ServoSettings settings = quick_settings();
        HapticCommand command = forces_on();
        ServoSnapshot snapshot;
        const auto start = [&] {
            REQUIRE((threaded ? loop.start_threaded(settings) : loop.start_stepped(settings)) ==
                    Status::ok);
        };
        const auto becomes = [&](DeviceState state) {
            return soon([&] {
                loop.advance(1, 1000);
                (void)loop.latest(snapshot);
                return snapshot.state == state;
            });
        };
        const auto stays_off = [&] {
            for (int ms = 0; ms < 60; ++ms) {
                loop.advance(1, 1000);
                std::this_thread::sleep_for(1ms);
                (void)loop.latest(snapshot);
                CHECK_FALSE(device.motors_on);
            }
        };
        std::thread([&] { loop.panic_stop(); }).join(); // before it ever ran
        loop.publish(command);
        start();
        CHECK(becomes(DeviceState::fault));
        CHECK(snapshot.fault == Status::panic_stopped);
        CHECK(told(loop, DeviceEventKind::panic_stopped));
        stays_off();
        loop.stop(); // and opened again without a word of the game: still stopped
        start();
        CHECK(becomes(DeviceState::fault));
        ++command.arm_count;
        loop.publish(command);
        stays_off();
        ++command.clear_fault_count;
        loop.publish(command);
        CHECK(becomes(DeviceState::connected));
        stays_off(); // it never arms itself again
        ++command.arm_count;
        loop.publish(command);
        CHECK(becomes(DeviceState::active));
        loop.stop();
        // A stop that was cleared is over: no run afterwards is stopped by it, with a new command or without.
        start();
        CHECK(becomes(DeviceState::active));
        loop.stop();
        loop.publish(command);
        start();
        CHECK(becomes(DeviceState::active));
        loop.stop();
        loop.panic_stop();
        ++command.clear_fault_count; // while closed
        loop.publish(command);
        start();
        CHECK(becomes(DeviceState::fault)); // nobody knows which came first: the stop holds
        loop.stop();
        ++command.clear_fault_count;
        loop.publish(command);
        start();
        CHECK(becomes(DeviceState::active)); // nothing holds it any more
        loop.stop();
        CHECK_FALSE(device.motors_on_at_close);
    }
}

TEST_CASE("panic stop: while the thread waits for a device that does not open") {
    SlowDevice device;
    device.opens_fail = 1'000'000;
    ServoSettings settings = quick_settings();
    settings.reopen_interval_s = 0.01;
    ServoLoop loop(std::make_unique<SlowTransport>(device, true));
    REQUIRE(loop.start_threaded(settings) == Status::ok);
    loop.publish(forces_on());
    loop.panic_stop();
    device.opens_fail = 0;
    ServoSnapshot snapshot;
    CHECK(soon([&] {
        (void)loop.latest(snapshot);
        return snapshot.state == DeviceState::fault;
    }));
    CHECK(snapshot.fault == Status::panic_stopped);
    CHECK_FALSE(device.motors_on);
}

TEST_CASE("panic stop: while the device is unplugged: back again it is stopped until cleared, and "
          "waits for arm()") {
    SlowDevice device;
    ServoLoop loop(std::make_unique<SlowTransport>(device, false));
    REQUIRE(loop.start_stepped(quick_settings()) == Status::ok);
    HapticCommand command = forces_on();
    loop.publish(command);
    loop.advance(1, 10);
    REQUIRE(device.motors_on);
    device.is_gone = true;
    loop.advance(1, 1000);
    CHECK_FALSE(device.motors_on);
    loop.panic_stop();
    loop.advance(1, 1000);
    device.is_gone = false;
    loop.advance(1, 10);
    CHECK_FALSE(device.motors_on);
    ++command.clear_fault_count;
    loop.publish(command);
    loop.advance(1, 10);
    CHECK_FALSE(device.motors_on);
    ++command.arm_count;
    loop.publish(command);
    loop.advance(1, 10);
    CHECK(device.motors_on);
}

TEST_CASE("panic stop: stepped, the very next cycle is off") {
    SlowDevice device;
    ServoLoop loop(std::make_unique<SlowTransport>(device, true));
    REQUIRE(loop.start_stepped(quick_settings()) == Status::ok);
    loop.publish(forces_on());
    loop.advance(1, 10);
    REQUIRE(device.motors_on);
    loop.panic_stop();
    loop.advance(1, 1000);
    CHECK_FALSE(device.motors_on);
}

TEST_CASE(
    "watchdog: a game whose thread stands still, in TAUT and CALIBRATED: a real device lets go") {
    for (const DeviceState wanted : {DeviceState::taut, DeviceState::calibrated}) {
        CAPTURE(describe(wanted));
        SlowDevice device;
        device.is_real = true;
        ServoLoop loop(std::make_unique<SlowTransport>(device, true));
        REQUIRE(loop.start_threaded(quick_settings()) == Status::ok);
        HapticCommand command = forces_on();
        command.heartbeat = 1;
        ServoSnapshot snapshot;
        double asked_at_s = -1.0;
        REQUIRE(soon([&] { // a game's frame each millisecond
            ++command.heartbeat;
            (void)loop.latest(snapshot);
            const bool waits = snapshot.state == DeviceState::connected &&
                               (asked_at_s < 0.0 || snapshot.time_s > asked_at_s + 0.1);
            if (waits) { // also when a busy machine made it let go on the way
                ++command.zero_count;
                asked_at_s = snapshot.time_s;
            }
            command.clear_fault_count += snapshot.state == DeviceState::fault ? 1U : 0U;
            loop.publish(command);
            const bool zero_taken = asked_at_s >= 0.0 && snapshot.time_s > asked_at_s + 0.7;
            device.is_moved = wanted == DeviceState::calibrated && zero_taken;
            return snapshot.state == wanted && zero_taken && device.motors_on;
        }));
        // A breakpoint: nothing is published any more.
        CHECK(soon([&] { return !device.motors_on; }));
        DeviceEvent why;
        REQUIRE(soon([&] {
            DeviceEvent event;
            while (loop.next_event(event)) {
                why = event;
                if (event.kind == DeviceEventKind::game_stalled) {
                    return true;
                }
            }
            // A machine that is too busy for the loop lets go for that.
            return why.kind == DeviceEventKind::clock_jumped ||
                   why.kind == DeviceEventKind::loop_stalled;
        }));
        if (why.kind == DeviceEventKind::game_stalled) {
            // By the loop's own measure, one cycle after the limit: cycles of a busy machine are longer.
            CHECK(why.value >= quick_settings().safety.game_timeout_s);
            CHECK(why.value <= quick_settings().safety.game_timeout_s + kLongestStep_s);
        }
        std::this_thread::sleep_for(30ms);
        CHECK_FALSE(device.motors_on);
    }
}

TEST_CASE("watchdog: cycles that come late are counted, dropped and told") {
    SlowDevice device;
    device.read_takes_ms = 5;
    ServoLoop loop(std::make_unique<SlowTransport>(device, false));
    REQUIRE(loop.start_threaded(quick_settings()) == Status::ok);
    REQUIRE(soon([&] { return ticks_of(loop) >= 150; }));
    const LoopStatistics statistics = loop.statistics();
    // Five periods a cycle: four are dropped, never caught up. The last cycles may not be counted yet.
    CHECK(statistics.missed_deadlines >= 4 * 140);
    device.read_takes_ms = 0;
    // One wake-up in ten comes 5 ms late: told once the hundred is full.
    std::uint64_t seen = ticks_of(loop);
    bool heard = false;
    for (int i = 0; i < 400 && !heard; ++i) {
        device.read_takes_ms = 0;
        seen = std::max(seen, ticks_of(loop));
        heard = told(loop, DeviceEventKind::cycles_late);
        std::this_thread::sleep_for(1ms);
    }
    // Being late is what the system does to a thread; a slow device is not it. Both counters only grow.
    CHECK(loop.statistics().late_cycles >= statistics.late_cycles);
}

TEST_CASE("open: a device that does not open is tried again by the thread, and told once") {
    SlowDevice device;
    device.opens_fail = 3;
    ServoSettings settings = quick_settings();
    {
        ServoLoop impatient(std::make_unique<SlowTransport>(device, false));
        CHECK(impatient.start_threaded(settings) == Status::open_failed);
        CHECK_FALSE(impatient.running());
    }
    device.opens = 0;
    settings.reopen_interval_s = 0.02; // a second in real life
    ServoLoop loop(std::make_unique<SlowTransport>(device, false));
    CHECK(loop.start_threaded(settings) == Status::ok);
    CHECK(loop.running());
    ServoSnapshot snapshot;
    REQUIRE(soon([&] {
        (void)loop.latest(snapshot);
        return snapshot.state != DeviceState::closed;
    }));
    CHECK(device.opens == 4);
    int failures_told = 0;
    DeviceEvent event;
    while (loop.next_event(event)) {
        failures_told += event.kind == DeviceEventKind::open_failed ? 1 : 0;
    }
    CHECK(failures_told == 1);
    loop.stop();

    device.opens = 0;
    device.opens_fail = 1'000'000;
    settings.reopen_interval_s = 60.0;
    REQUIRE(loop.start_threaded(settings) == Status::ok);
    loop.stop(); // at once, not in a minute
    CHECK(device.opens == 1);
}

TEST_CASE("loop: a device that clocks it sets the rate; one that does not leaves the timer") {
    SlowDevice device;
    device.clocks = true;
    ServoSettings settings = quick_settings();
    settings.rate_hz = 100.0; // the timer would give a hundred cycles a second
    ServoLoop loop(std::make_unique<SlowTransport>(device, false));
    REQUIRE(loop.start_threaded(settings) == Status::ok);
    const std::int64_t start_ns = monotonic_ns();
    REQUIRE(soon([&] { return ticks_of(loop) >= 100; }));
    const double took_s = static_cast<double>(monotonic_ns() - start_ns) * 1e-9;
    loop.stop();
    // The timer alone needs a second for as many: a ratio within one run.
    CHECK(took_s < 0.9);
}
