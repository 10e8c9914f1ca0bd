// The loop around the step: stepped and threaded, start and stop, and what a transport sees of it.
#include <doctest/doctest.h>

#include <atomic>
#include <chrono>
#include <thread>

#include "support/servo_fixture.h"

using namespace spidar;
using spidar::test::ideal_settings;

namespace {

struct Log {
    std::atomic<int> opens{0};
    std::atomic<int> closes{0};
    std::atomic<int> reads{0};
    std::atomic<int> writes{0};
    std::atomic<int> writes_when_closed{0};
    std::atomic<int> out_of_order{0};
    std::atomic<bool> motors_on{false};
    std::atomic<bool> motors_on_at_close{false};
    std::atomic<double> simulated_s{0.0};
};

// Stands still at the home pose, and keeps a log.
class LoggingTransport final : public Transport {
public:
    explicit LoggingTransport(Log &log, Status open_status = Status::ok)
        : log_(log), open_status_(open_status) {}
    Status open() noexcept override {
        ++log_.opens;
        open_ = usable(open_status_);
        return open_status_;
    }
    void close() noexcept override {
        ++log_.closes;
        log_.motors_on_at_close = log_.motors_on.load();
        open_ = false;
    }
    Status read(DeviceReading &reading) noexcept override {
        log_.out_of_order += stage_ == 0 ? 0 : 1;
        stage_ = 1;
        ++log_.reads;
        reading.counts = {};
        return Status::ok;
    }
    Status write(const DriveCommand &command) noexcept override {
        stage_ = 2;
        ++log_.writes;
        log_.writes_when_closed += open_ ? 0 : 1;
        log_.motors_on = command.motors_on;
        return Status::ok;
    }
    void advance(double dt_s) noexcept override {
        log_.out_of_order += stage_ == 2 ? 0 : 1;
        stage_ = 0;
        log_.simulated_s = log_.simulated_s + dt_s;
    }
    [[nodiscard]] bool simulated() const noexcept override { return true; }

private:
    Log &log_;
    Status open_status_;
    bool open_ = false;
    int stage_ = 0;
};

HapticCommand forces_on() {
    HapticCommand command;
    command.forces_enabled = true;
    return command;
}

} // namespace

TEST_CASE("loop: 60 ticks of 1/60 s at 1 kHz are exactly 1000 cycles, 16 or 17 a tick") {
    Log log;
    ServoLoop loop(std::make_unique<LoggingTransport>(log));
    REQUIRE(loop.start_stepped(ideal_settings()) == Status::ok);
    for (int second = 0; second < 3; ++second) {
        int cycles = 0;
        for (int tick = 0; tick < 60; ++tick) {
            const int run = loop.advance(1, 60);
            CHECK((run == 16 || run == 17));
            cycles += run;
        }
        CHECK(cycles == 1000);
    }
    CHECK(log.reads == 3000);
    CHECK(log.writes == 3000);
    CHECK(log.out_of_order == 0);
    CHECK(log.simulated_s == doctest::Approx(3.0));
    ServoSnapshot snapshot;
    CHECK(loop.latest(snapshot));
    CHECK_FALSE(loop.latest(snapshot));
    CHECK(snapshot.counters.ticks == 3000);
    CHECK(snapshot.time_s == doctest::Approx(3.0));
    CHECK(loop.statistics().measured_rate_hz == doctest::Approx(1000.0));
}

TEST_CASE("loop: other rates and tick lengths lose no cycle; nonsense runs none") {
    Log log;
    ServoLoop loop(std::make_unique<LoggingTransport>(log));
    CHECK(loop.advance(1, 60) == 0); // not started
    ServoSettings settings = ideal_settings();
    settings.rate_hz = 333.3;
    REQUIRE(loop.start_stepped(settings) == Status::ok);
    int cycles = 0;
    for (int tick = 0; tick < 1440; ++tick) {
        cycles += loop.advance(1, 144);
    }
    CHECK(cycles == 3333);
    CHECK(loop.advance(1, 0) == 0);
    CHECK(loop.advance(0, 60) == 0);
    loop.stop();
    CHECK(loop.advance(1, 60) == 0);
}

TEST_CASE("loop: stop writes zero before it closes, twice is fine, and readers see closed") {
    Log log;
    ServoLoop loop(std::make_unique<LoggingTransport>(log));
    REQUIRE(loop.start_stepped(ideal_settings()) == Status::ok);
    loop.publish(forces_on());
    loop.advance(3, 2);
    CHECK(log.motors_on);
    ServoSnapshot snapshot;
    REQUIRE(loop.latest(snapshot));
    CHECK(snapshot.state == DeviceState::active);
    loop.stop();
    loop.stop();
    CHECK_FALSE(loop.running());
    CHECK(log.closes == 1);
    CHECK_FALSE(log.motors_on_at_close);
    CHECK(log.writes_when_closed == 0);
    REQUIRE(loop.latest(snapshot));
    CHECK(snapshot.state == DeviceState::closed);
    CHECK(snapshot.tensions_n == StringArray{});
}

TEST_CASE("loop: a start that fails leaves nothing running") {
    Log log;
    ServoLoop loop(std::make_unique<LoggingTransport>(log, Status::open_failed));
    CHECK(loop.start_threaded(ideal_settings()) == Status::open_failed);
    CHECK_FALSE(loop.running());
    CHECK(loop.start_stepped(ideal_settings()) == Status::open_failed);
    CHECK(log.opens == 2);
    ServoSettings bad = ideal_settings();
    bad.rate_hz = -1.0;
    CHECK(loop.start_threaded(bad) == Status::invalid_settings);
    CHECK(log.opens == 2); // settings are checked before the device is touched
    loop.stop();
    CHECK(log.closes == 0);
    CHECK(log.reads == 0);
    CHECK(log.writes == 0);
}

TEST_CASE("loop: a restart does not arm by what was asked before it") {
    Log log;
    ServoLoop loop(std::make_unique<LoggingTransport>(log));
    HapticCommand command = forces_on();
    command.disarm_count = 1;
    command.wrench_sequence = 4;
    command.wrench.force_n.x = 5.0;
    command.wrench_duration_s = 10.0;
    loop.publish(command);
    REQUIRE(loop.start_stepped(ideal_settings()) == Status::ok);
    loop.advance(2, 1);
    ServoSnapshot snapshot;
    REQUIRE(loop.latest(snapshot));
    CHECK(snapshot.state == DeviceState::active); // the old disarm() is history, forces are enabled
    CHECK(snapshot.requested.force_n.x == 0.0);   // and so is the old wrench
}

TEST_CASE("loop: 200 threads started and stopped: motors off, joined, closed every time") {
    Log log;
    ServoLoop loop(std::make_unique<LoggingTransport>(log));
    ServoSettings settings = ideal_settings();
    settings.rate_hz = 4000.0;
    settings.safety.arming_time_s = 0.001;
    int seen_on = 0;
    for (int round = 0; round < 200; ++round) {
        REQUIRE(loop.start_threaded(settings) == Status::ok);
        REQUIRE(loop.running());
        REQUIRE(loop.threaded());
        loop.publish(forces_on());
        if (round % 4 == 0) { // others stop in whatever state the thread is
            while (!log.motors_on.load()) {
                std::this_thread::yield();
            }
            ++seen_on;
        }
        CHECK(loop.advance(1, 60) == 0); // not while a thread drives
        loop.stop();
        REQUIRE_FALSE(loop.running());
        REQUIRE(log.closes == round + 1);
        REQUIRE_FALSE(log.motors_on_at_close);
    }
    CHECK(seen_on == 50);
    CHECK(log.opens == 200);
    CHECK(log.writes_when_closed == 0);
}

TEST_CASE("loop: threaded, commands arrive, snapshots come in order, statistics are filled") {
    Log log;
    ServoLoop loop(std::make_unique<LoggingTransport>(log));
    REQUIRE(loop.start_threaded(ideal_settings()) == Status::ok);
    loop.publish(forces_on());
    ServoSnapshot snapshot;
    std::uint64_t last = 0;
    while (snapshot.state != DeviceState::active) { // 1000 cycles of arming
        if (!loop.latest(snapshot)) {
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
            continue;
        }
        REQUIRE(snapshot.counters.ticks > last);
        last = snapshot.counters.ticks;
    }
    CHECK(last >= 1000);
    loop.stop();
    const LoopStatistics statistics = loop.statistics();
    CHECK(statistics.step_p50_us > 0.0);
    CHECK(statistics.step_p99_us >= statistics.step_p50_us);
    CHECK(statistics.lateness_p99_us >= statistics.lateness_p50_us);
    CHECK(statistics.lateness_max_us >= statistics.lateness_p99_us);
    CHECK(log.simulated_s == doctest::Approx(1e-3 * log.reads).epsilon(1e-9));
}
