// The heat of a motor stays with its device, whoever opens it next, and cools with the winding's time constant.
#include <doctest/doctest.h>

#include <cmath>

#include "device/safety/motor_heat.h"
#include "device/threads/real_time_thread.h"
#include "support/servo_fixture.h"

using namespace spidar;
using spidar::test::ideal_settings;

namespace {

constexpr std::int64_t kSecond_ns = 1'000'000'000;

// Stands still at home.
class NamedDevice final : public Transport {
public:
    explicit NamedDevice(std::string name) : name_(std::move(name)) {}
    Status open() noexcept override { return Status::ok; }
    void close() noexcept override { is_closed_ = true; }
    Status read(DeviceReading &reading) noexcept override {
        reading.counts = {};
        return Status::ok;
    }
    Status write(const DriveCommand & /*command*/) noexcept override { return Status::ok; }
    [[nodiscard]] bool simulated() const noexcept override { return true; } // arms itself
    [[nodiscard]] std::string device_name() const override {
        return is_closed_ ? std::string() : name_; // known while it is open
    }

private:
    std::string name_;
    bool is_closed_ = false;
};

ServoSettings hot_settings() {
    ServoSettings settings = ideal_settings();
    settings.safety.arming_time_s = 0.01;
    settings.safety.continuous_tension_n = 0.55; // little more than pretension
    settings.safety.thermal_time_s = 1000.0;
    return settings;
}

// Opens the device, pulls for so long and closes it. The share of the budget at the end.
double play(const std::string &name, double pull_s, double *at_start = nullptr) {
    ServoLoop loop(std::make_unique<NamedDevice>(name));
    const ServoSettings settings = hot_settings();
    REQUIRE(loop.start_stepped(settings) == Status::ok);
    ServoSnapshot now;
    loop.advance(1, 1000);
    REQUIRE(loop.latest(now));
    if (at_start != nullptr) {
        *at_start = now.thermal_share;
    }
    HapticCommand command;
    command.forces_enabled = true;
    for (int ms = 0; ms < 1000.0 * pull_s; ms += 50) {
        ++command.wrench_sequence;
        command.wrench.force_n = Vec3(0.0, 8.0, 0.0);
        command.wrench_duration_s = 0.1;
        loop.publish(command);
        loop.advance(50, 1000);
    }
    (void)loop.latest(now);
    loop.stop();
    return now.thermal_share;
}

} // namespace

TEST_CASE("motor heat: kept by name, cooling by its time constant, forgotten when cold") {
    StringArray heat{};
    heat[2] = 0.8;
    heat[7] = 0.1;
    keep_motor_heat("heat/a", heat, 12.0, 100 * kSecond_ns);
    CHECK(recall_motor_heat("heat/a", 100 * kSecond_ns) == heat);
    const StringArray later = recall_motor_heat("heat/a", 112 * kSecond_ns);
    CHECK(later[2] == doctest::Approx(0.8 / std::exp(1.0)));
    CHECK(later[7] == doctest::Approx(0.1 / std::exp(1.0)));
    CHECK(later[0] == 0.0);
    CHECK(recall_motor_heat("heat/b", 100 * kSecond_ns) == StringArray{});
    CHECK(recall_motor_heat("heat/a", 0) == heat); // a clock that went back cools nothing
    keep_motor_heat("", heat, 12.0, 0);
    CHECK(recall_motor_heat("", 0) == StringArray{});
    keep_motor_heat("heat/b", {}, 12.0, 200 * kSecond_ns); // by now the first is cold
    CHECK(recall_motor_heat("heat/a", 100 * kSecond_ns) == StringArray{});
}

TEST_CASE(
    "motor heat: a device that is opened anew is as warm as it was left; another one is cold") {
    const double left = play("heat/device", 0.5);
    REQUIRE(left > 0.02);
    double found = 0.0;
    (void)play("heat/device", 0.0, &found);
    CHECK(found / left == doctest::Approx(1.0).epsilon(0.01));
    double other = 1.0;
    (void)play("heat/other", 0.0, &other);
    CHECK(other < 1e-3);
    double nameless = 1.0;
    (void)play("", 0.5);
    (void)play("", 0.0, &nameless);
    CHECK(nameless < 1e-3);
}

TEST_CASE("motor heat: opening it again does not help a device that is too warm") {
    StringArray heat{};
    heat.fill(1.1);
    keep_motor_heat("heat/hot", heat, 1000.0, monotonic_ns());
    ServoLoop loop(std::make_unique<NamedDevice>("heat/hot"));
    REQUIRE(loop.start_stepped(hot_settings()) == Status::ok);
    HapticCommand command;
    command.forces_enabled = true;
    ++command.arm_count;
    loop.publish(command);
    loop.advance(1, 2);
    ServoSnapshot now;
    REQUIRE(loop.latest(now));
    CHECK(now.state == DeviceState::connected);
    CHECK(now.tensions_n == StringArray{});
    bool told = false;
    DeviceEvent event;
    while (loop.next_event(event)) {
        told = told || event.kind == DeviceEventKind::overheated;
    }
    CHECK(told);
}
