#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <random>

#include "device/safety/safety_gate.h"

using namespace spidar;

namespace {

constexpr double kTick_s = 0.001;

StringArray all(double value) {
    StringArray array{};
    array.fill(value);
    return array;
}

} // namespace

TEST_CASE("safety gate: 0 to 8 N takes 8 ms at 1 N/ms, and 8 ms back") {
    SafetyGate gate;
    gate.configure(all(10.0), 1.0);
    for (int tick = 1; tick <= 10; ++tick) {
        const SafetyGate::Output out = gate.pass(all(8.0), kTick_s);
        CHECK(out.tensions_n[0] == doctest::Approx(std::min(8.0, tick * 1.0)).epsilon(1e-12));
        CHECK((tick > 7 || out.slewed));
        CHECK_FALSE(out.clamped);
    }
    for (int tick = 1; tick <= 8; ++tick) {
        CHECK(gate.pass(all(0.0), kTick_s).tensions_n[7] ==
              doctest::Approx(8.0 - tick).epsilon(1e-12));
    }
}

TEST_CASE("safety gate: NaN, negative and too large") {
    constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    SafetyGate gate;
    gate.configure(all(10.0), 100.0);
    gate.pass(all(5.0), kTick_s);
    const SafetyGate::Output out =
        gate.pass({kNan, kInfinity, -kInfinity, -1.0, 11.0, 1e308, 5.0, -0.0}, kTick_s);
    CHECK(out.clamped);
    CHECK(out.tensions_n == StringArray{0.0, 10.0, 0.0, 0.0, 10.0, 10.0, 5.0, 0.0});
}

TEST_CASE("safety gate: bad limits and time steps keep it shut") {
    constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
    for (const double bad : {kNan, -1.0, 0.0}) {
        SafetyGate gate;
        gate.configure(all(bad), 1.0);
        CHECK(gate.pass(all(5.0), kTick_s).tensions_n == StringArray{});
        gate.configure(all(10.0), bad);
        CHECK(gate.pass(all(5.0), kTick_s).tensions_n == StringArray{});
        gate.configure(all(10.0), 1.0);
        CHECK(gate.pass(all(5.0), bad).tensions_n == StringArray{});
    }
}

TEST_CASE("safety gate: any input gives tensions in [0, max] that move no faster than the slew") {
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> size(-5.0, 20.0);
    const double odd[] = {std::numeric_limits<double>::quiet_NaN(), 1e308, -1e308, 5e-324,
                          std::numeric_limits<double>::infinity()};
    SafetyGate gate;
    gate.configure(all(10.0), 1.0);
    StringArray last{};
    for (int i = 0; i < 20000; ++i) {
        StringArray in{};
        for (double &tension : in) {
            tension = random() % 8 == 0 ? odd[random() % 5] : size(random);
        }
        const StringArray out = gate.pass(in, kTick_s).tensions_n;
        for (std::size_t k = 0; k < out.size(); ++k) {
            REQUIRE(std::isfinite(out[k]));
            REQUIRE(out[k] >= 0.0);
            REQUIRE(out[k] <= 10.0);
            REQUIRE(out[k] - last[k] <= 1.0 + 1e-12); // falls may be at once: towards safety
        }
        last = out;
    }
}
