// The fingers of a rigid grip: which input counts, and how they follow it.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "device/tracking/fingers.h"

using namespace spidar;

namespace {

constexpr double kTick_s = 0.001;

Fingers fingers_of(const FingerSettings &settings) {
    Fingers fingers;
    fingers.configure(settings, GripKind::rigid);
    return fingers;
}

double settled(Fingers &fingers, double time_s = 1.0) {
    for (double t = 0.0; t < time_s; t += kTick_s) {
        fingers.advance(kTick_s);
    }
    return fingers.motion().angle_rad;
}

} // namespace

TEST_CASE("fingers: a crossed grip has none of these") {
    Fingers fingers;
    fingers.configure({}, GripKind::crossed);
    DeviceReading reading;
    reading.buttons = 0xFF;
    fingers.take(reading);
    CHECK(settled(fingers) == 0.0);
    CHECK_FALSE(fingers.motion().given);
    CHECK(fingers.at_rest());
}

TEST_CASE(
    "fingers: each input closes them as far as it says, and the one that closes most counts") {
    FingerSettings settings;
    settings.button_mask = 0x04;
    settings.sensor = 3;
    settings.sensor_open = 400.0;
    settings.sensor_closed = -100.0; // falls as they close
    Fingers fingers = fingers_of(settings);
    DeviceReading reading;
    HapticCommand command;
    const auto angle_for = [&](int buttons, int sensor, double game) {
        reading.buttons = static_cast<std::uint8_t>(buttons);
        reading.sensors[3] = static_cast<std::int16_t>(sensor);
        command.grasp_share = game;
        fingers.take(reading);
        fingers.take(command);
        return settled(fingers) / settings.closed_rad;
    };
    CHECK(angle_for(0, 400, 0.0) == 0.0);
    CHECK(angle_for(0x04, 400, 0.0) == 1.0);
    CHECK(angle_for(0xFB, 400, 0.0) == 0.0); // every other button
    CHECK(angle_for(0, 150, 0.0) == doctest::Approx(0.5));
    CHECK(angle_for(0, -32768, 0.0) == 1.0);
    CHECK(angle_for(0, 32767, 0.0) == 0.0);
    CHECK(angle_for(0, 150, 0.75) == doctest::Approx(0.75));
    CHECK(angle_for(0, 150, 0.25) == doctest::Approx(0.5));
    CHECK(angle_for(0, 400, 7.0) == 1.0);
    CHECK(angle_for(0, 400, std::numeric_limits<double>::quiet_NaN()) == 0.0);
    CHECK(angle_for(0, 400, -std::numeric_limits<double>::infinity()) == 0.0);
}

TEST_CASE(
    "fingers: they close within 0.3 s, never too far, and no step of angle or speed is seen") {
    for (const double dt_s : {0.00025, 0.001, 0.02}) {
        CAPTURE(dt_s);
        Fingers fingers = fingers_of({});
        DeviceReading reading;
        reading.buttons = 1;
        fingers.take(reading);
        const double closed_rad = FingerSettings().closed_rad;
        double before_rad = 0.0;
        double before_rad_s = 0.0;
        for (double t = 0.0; t < 0.3; t += dt_s) {
            fingers.advance(dt_s);
            const FingerMotion &now = fingers.motion();
            CHECK(now.angle_rad >= before_rad);
            CHECK(now.angle_rad <= closed_rad);
            // The pace squared bounds the acceleration.
            CHECK(std::abs(now.rate_rad_s - before_rad_s) <= 900.0 * closed_rad * dt_s * 1.001);
            CHECK(now.angle_rad - before_rad <= 12.0 * closed_rad * dt_s);
            before_rad = now.angle_rad;
            before_rad_s = now.rate_rad_s;
        }
        CHECK(fingers.motion().angle_rad > 0.998 * closed_rad);
    }
}

TEST_CASE("fingers: they come to rest, and wake for whatever would move them") {
    Fingers fingers = fingers_of({});
    DeviceReading reading;
    HapticCommand command;
    CHECK(fingers.at_rest());
    CHECK(fingers.has_seen(reading, command));
    reading.buttons = 1;
    CHECK_FALSE(fingers.has_seen(reading, command));
    fingers.take(reading);
    CHECK(fingers.has_seen(reading, command));
    CHECK_FALSE(fingers.at_rest());
    CHECK(settled(fingers, 2.0) == FingerSettings().closed_rad);
    CHECK(fingers.at_rest());
    command.grasp_share = 0.5; // the button closes them further
    fingers.take(command);
    CHECK(fingers.at_rest());
}
