#include <doctest/doctest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <thread>

#include "device/calibration/calibration_rig.h"
#include "device/safety/motor_heat.h"
#include "device/simulation/simulated_transport.h"
#include "device/threads/real_time_thread.h"

using namespace spidar;

namespace {

struct Fixture {
    PlantSettings plant;
    RigSettings settings;
    SimulatedTransport *device = nullptr;
    std::unique_ptr<CalibrationRig> rig;
    RigOrders orders;
    RigNews news;

    void make(FaultInjection fault = {}, bool with_fault = false) {
        settings.scale_m_per_count.fill(plant.metres_per_count);
        settings.plant = plant;
        rig = std::make_unique<CalibrationRig>(settings, [=, this](std::string &) {
            auto made = std::make_unique<SimulatedTransport>(plant);
            device = made.get();
            if (with_fault) {
                made->inject(fault);
            }
            return made;
        });
    }
    void step(double seconds) {
        for (double left = seconds; left > 1e-9; left -= 0.1) {
            ++orders.beat;
            rig->give(orders);
            rig->advance(0.1);
        }
        rig->latest(news);
    }
    TaskResult run(CalibrationTask task, int string, double weight_n = 0.0) {
        orders.task = {task, string, weight_n, orders.task.number + 1};
        for (int k = 0; k < 100 && (k == 0 || news.task.verdict == TaskVerdict::running); ++k) {
            step(0.1);
        }
        return news.task;
    }
};

} // namespace

TEST_CASE("rig: each motor pulls its own string, and wrong wiring is named") {
    Fixture sound;
    sound.make();
    sound.rig->start_stepped();
    REQUIRE(sound.rig->state() == RigState::open);
    for (int string = 0; string < kStringCount; ++string) {
        const TaskResult result = sound.run(CalibrationTask::wiring, string);
        CAPTURE(string);
        CHECK(result.verdict == TaskVerdict::done);
        CHECK(result.moved_m[static_cast<std::size_t>(string)] < -kMoved_m);
        sound.step(0.5);
        CHECK_FALSE(sound.news.motors_on);
    }
    Fixture swapped;
    swapped.make({SimulatedFault::swapped_encoders, 2, 0.0, 0.0}, true);
    swapped.rig->start_stepped();
    const TaskResult wrong = swapped.run(CalibrationTask::wiring, 2);
    CHECK(wrong.verdict == TaskVerdict::wrong_string);
    CHECK(wrong.moved_string == 3);

    Fixture reversed;
    reversed.make({SimulatedFault::reversed_encoder, 5, 0.0, 0.0}, true);
    reversed.rig->start_stepped();
    CHECK(reversed.run(CalibrationTask::wiring, 5).verdict == TaskVerdict::wrong_sign);
    CHECK(reversed.run(CalibrationTask::wiring, 4).verdict == TaskVerdict::done);

    Fixture cut;
    cut.make({SimulatedFault::output_cut, 0, 0.0, 0.0}, true);
    cut.rig->start_stepped();
    CHECK(cut.run(CalibrationTask::wiring, 1).verdict == TaskVerdict::no_movement);
}

TEST_CASE("rig: a known weight gives the gain of the motor, friction cancelled") {
    Fixture f;
    f.plant.motors.tension_gain[3] = 0.87;
    f.plant.motors.tension_gain[6] = 1.12;
    f.make();
    f.rig->start_stepped();
    for (const int string : {3, 6}) {
        const TaskResult result = f.run(CalibrationTask::weighing, string, 2.0);
        CAPTURE(string);
        REQUIRE(result.verdict == TaskVerdict::done);
        CHECK(result.rise_n > result.fall_n);
        const double truth = f.plant.motors.tension_gain[static_cast<std::size_t>(string)];
        const double found = 2.0 / (0.5 * (result.rise_n + result.fall_n));
        CHECK(found == doctest::Approx(truth).epsilon(0.01));
    }
    CHECK(f.run(CalibrationTask::weighing, 3, 9.0).verdict == TaskVerdict::stopped);
    CHECK(f.run(CalibrationTask::weighing, 8, 2.0).verdict == TaskVerdict::stopped);
    CHECK(f.run(CalibrationTask::weighing, 3, NAN).verdict == TaskVerdict::stopped);
    Fixture weak;
    weak.plant.motors.tension_gain[0] = 0.3;
    weak.make();
    weak.rig->start_stepped();
    CHECK(weak.run(CalibrationTask::weighing, 0, 3.0).verdict == TaskVerdict::not_lifted);
}

TEST_CASE("rig: motors rest until asked, never pull hard, and stop when nobody watches") {
    Fixture f;
    f.settings.max_tension_n = 1.0; // below the wiring pull: the limit holds
    f.make();
    f.rig->start_stepped();
    f.step(1.0);
    CHECK_FALSE(f.news.motors_on);
    f.orders.task = {CalibrationTask::taut, 0, 0.0, 1};
    f.step(0.5);
    CHECK(f.news.motors_on);
    for (const double tension : f.news.tensions_n) {
        CHECK(tension == doctest::Approx(kTaut_n));
    }
    f.orders.task = {CalibrationTask::wiring, 0, 0.0, 2};
    f.step(0.9);
    CHECK(f.news.tensions_n[0] == 1.0);
    f.orders.task = {CalibrationTask::taut, 0, 0.0, 3};
    f.step(0.5);
    f.rig->advance(0.9 * kUnwatched_s); // nobody gives orders
    f.rig->latest(f.news);
    CHECK(f.news.motors_on);
    f.rig->advance(0.2 * kUnwatched_s);
    f.rig->latest(f.news);
    CHECK_FALSE(f.news.motors_on);
    CHECK(f.news.task.verdict == TaskVerdict::stopped);
    f.step(0.5); // watched again: the old order does not come back
    CHECK_FALSE(f.news.motors_on);
}

TEST_CASE("rig: a device that falls silent lets go") {
    Fixture f;
    f.make({SimulatedFault::read_timeout, 0, 1.0, 0.0}, true);
    f.rig->start_stepped();
    f.orders.task = {CalibrationTask::taut, 0, 0.0, 1};
    f.step(0.9);
    CHECK(f.news.motors_on);
    f.step(0.4);
    CHECK_FALSE(f.news.motors_on);
    CHECK(f.news.task.verdict == TaskVerdict::not_ready);
}

namespace {

// A real device whose endpoint takes its time for each write, and may stop to take any.
struct SlowEndpoint {
    std::string name;
    std::atomic<int> write_takes_ms{15};
    std::atomic<int> read_takes_ms{0};
    std::atomic<bool> motors_on{false};
    std::atomic<int> writes{0};
    std::atomic<int> reads{0};
    std::atomic<bool> motors_on_at_close{false};
};

class SlowEndpointTransport final : public Transport {
public:
    explicit SlowEndpointTransport(SlowEndpoint &device) : device_(device) {}
    Status open() noexcept override { return Status::ok; }
    void close() noexcept override { device_.motors_on_at_close = device_.motors_on.load(); }
    Status read(DeviceReading &reading) noexcept override {
        ++device_.reads;
        std::this_thread::sleep_for(std::chrono::milliseconds(device_.read_takes_ms.load()));
        reading.counts = {};
        return Status::ok;
    }
    Status write(const DriveCommand &command) noexcept override {
        std::this_thread::sleep_for(std::chrono::milliseconds(device_.write_takes_ms.load()));
        device_.motors_on = command.motors_on;
        ++device_.writes;
        return Status::ok;
    }
    [[nodiscard]] bool write_may_block() const noexcept override { return true; }
    [[nodiscard]] std::string device_name() const override { return device_.name; }

private:
    SlowEndpoint &device_;
};

template <typename Condition>
bool in_time(Condition condition) {
    for (int k = 0; k < 30000; ++k) { // a busy machine may take long; it must not take for ever
        if (condition()) {
            return true;
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return false;
}

// A rig with a thread of its own, on this device.
void start_on(SlowEndpoint &device, Fixture &f) {
    f.settings.scale_m_per_count.fill(f.plant.metres_per_count);
    f.rig = std::make_unique<CalibrationRig>(
        f.settings, [&](std::string &) { return std::make_unique<SlowEndpointTransport>(device); });
    REQUIRE(f.rig->start_threaded());
}

void watch(Fixture &f) {
    ++f.orders.beat;
    f.rig->give(f.orders);
    (void)f.rig->latest(f.news);
}

// Watched until the motors are on; a busy machine may end the task: then again.
void pull_taut(const SlowEndpoint &device, Fixture &f) {
    f.orders.task = {CalibrationTask::taut, 0, 0.0, 1};
    REQUIRE(in_time([&] {
        f.orders.task.number += f.news.task.verdict == TaskVerdict::stopped ? 1U : 0U;
        watch(f);
        return device.motors_on.load();
    }));
}

} // namespace

TEST_CASE("rig: an endpoint that takes 15 ms a write delays nothing: nobody watches, and a second "
          "later it is off") {
    SlowEndpoint device;
    Fixture f;
    start_on(device, f);
    REQUIRE(in_time([&] { return f.rig->latest(f.news) && f.news.readings > 0; }));
    pull_taut(device, f);
    // Nobody gives orders any more. A write takes 15 ms, so a second has no more than 67 of them: counting cycles
    // that each write would have taken a thousand.
    const int writes = device.writes;
    CHECK(in_time([&] { return !device.motors_on; }));
    CHECK(device.writes - writes <= 1.2 * kUnwatched_s / 0.015);
    CHECK(device.reads > device.writes); // the rig reads on while the device takes its time
    CHECK(in_time([&] {
        (void)f.rig->latest(f.news);
        return !f.news.motors_on && f.news.task.verdict == TaskVerdict::stopped;
    }));
    f.rig.reset();
    CHECK_FALSE(device.motors_on_at_close);
}

TEST_CASE("rig: a device that takes 5 ms a reading: a second is a second, not a thousand cycles") {
    SlowEndpoint device;
    device.write_takes_ms = 0;
    device.read_takes_ms = 5;
    Fixture f;
    start_on(device, f);
    pull_taut(device, f);
    const int reads = device.reads;
    CHECK(in_time([&] { return !device.motors_on; }));
    CHECK(device.reads - reads <= 1.2 * kUnwatched_s / 0.005);
}

TEST_CASE("rig: a device that takes no more commands ends the task") {
    SlowEndpoint device;
    device.write_takes_ms = 0;
    Fixture f;
    start_on(device, f);
    pull_taut(device, f);
    device.write_takes_ms = 300;
    CHECK(in_time([&] {
        watch(f);
        return f.news.task.verdict == TaskVerdict::not_ready ||
               f.news.task.verdict == TaskVerdict::stopped;
    }));
    CHECK_FALSE(f.news.motors_on);
    device.write_takes_ms = 0;
    CHECK(in_time([&] { return !device.motors_on; }));
    f.rig.reset();
    CHECK_FALSE(device.motors_on_at_close);
}

TEST_CASE(
    "rig: the heat of a motor comes from before and stays for whoever opens the device next") {
    SlowEndpoint device;
    device.write_takes_ms = 0;
    device.name = "rig/heat";
    Fixture f;
    f.settings.scale_m_per_count.fill(f.plant.metres_per_count);
    const auto open = [&] {
        f.rig = std::make_unique<CalibrationRig>(f.settings, [&](std::string &) {
            return std::make_unique<SlowEndpointTransport>(device);
        });
        f.rig->start_stepped();
    };
    open();
    f.orders.task = {CalibrationTask::taut, 0, 0.0, 1};
    f.step(10.0);
    CHECK(device.motors_on);
    f.rig.reset();
    CHECK_FALSE(device.motors_on);
    // Ten seconds at 0.5 N of 3.5 N, with a time constant of 12 s; the ramp is 25 ms.
    const double share = 0.5 * 0.5 / (3.5 * 3.5) * (1.0 - std::exp(-10.0 / 12.0));
    const StringArray kept = recall_motor_heat("rig/heat", monotonic_ns());
    CHECK(kept[5] / share == doctest::Approx(1.0).epsilon(0.05));

    StringArray hot{};
    hot[2] = 1.2;
    keep_motor_heat("rig/heat", hot, 12.0, monotonic_ns());
    open();
    f.orders.task.number = 2;
    f.step(0.2);
    CHECK(f.news.task.verdict == TaskVerdict::too_warm);
    CHECK_FALSE(f.news.motors_on);
    CHECK_FALSE(device.motors_on);
    f.step(5.0); // it cools
    ++f.orders.task.number;
    f.step(0.2);
    CHECK(f.news.task.verdict == TaskVerdict::running);
    CHECK(device.motors_on);
}

TEST_CASE("rig: the scripted hand of the simulated device covers the workspace") {
    Fixture f;
    f.make();
    f.rig->start_stepped();
    f.orders.hand = HandScript::place;
    f.orders.hand_place = 6;
    f.orders.hand_number = 1;
    f.step(3.0);
    CHECK(f.news.hand_has_arrived);
    f.orders.hand = HandScript::free_motion;
    f.orders.hand_number = 2;
    f.orders.collecting = true;
    CountArray low{};
    CountArray high{};
    CountArray counts{};
    low.fill(INT32_MAX);
    high.fill(INT32_MIN);
    int samples = 0;
    constexpr int kSeconds = 10;
    for (int k = 0; k < kSeconds; ++k) {
        f.step(1.0);
        for (; f.rig->next_sample(counts); ++samples) {
            for (std::size_t i = 0; i < kStringCount; ++i) {
                low[i] = std::min(low[i], counts[i]);
                high[i] = std::max(high[i], counts[i]);
            }
        }
    }
    CHECK(samples == doctest::Approx(kSeconds / kSampleInterval_s).epsilon(0.1));
    for (std::size_t i = 0; i < kStringCount; ++i) {
        CHECK((high[i] - low[i]) * f.plant.metres_per_count > 0.2);
    }
}

TEST_CASE("rig: opens in a thread of its own, says why not, and closes without waiting") {
    Fixture f;
    f.make();
    REQUIRE(f.rig->start_threaded());
    const auto until = [](auto condition) {
        for (int k = 0; k < 20000; ++k) {
            if (condition()) {
                return true;
            }
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
        return false;
    };
    CHECK(until([&] { return f.rig->latest(f.news) && f.news.readings > 10; }));
    CHECK(f.news.simulated);
    f.rig->ask_close();
    CHECK(until([&] { return f.rig->state() == RigState::closed; }));

    CalibrationRig none(f.settings, [](std::string &problem) -> std::unique_ptr<Transport> {
        problem = "nothing is plugged in";
        return nullptr;
    });
    REQUIRE(none.start_threaded());
    CHECK(until([&] { return none.state() == RigState::failed; }));
    CHECK(none.problem() == "nothing is plugged in");
}
