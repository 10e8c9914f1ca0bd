// The rule for motors (device/safety/motor_rule.h) through the whole step, as a table: every state in which a device can be,
// every cause as it really comes about, with the time until the motors are off. docs/reference/safety.md has the times.
#include <doctest/doctest.h>

#include <cmath>
#include <string>

#include "support/servo_fixture.h"

using namespace spidar;
using spidar::test::Bench;
using spidar::test::moved_by;

namespace {

// A real device in play: its game beats, the hand moves.
struct Play : Bench {
    bool beats = true;
    bool moves = true;
    int ms = 0;
    std::array<std::int32_t, kStringCount> slip{};

    Play() {
        simulated = false;
        command.forces_enabled = true;
        command.heartbeat = 1;
    }
    void run(int times, double dt_s = spidar::test::kTick_s) {
        for (int i = 0; i < times; ++i) {
            ++ms;
            if (moves) {
                put(moved_by(
                    settings,
                    0.04 * Vec3(std::sin(0.004 * ms), std::sin(0.003 * ms), -std::sin(0.0035 * ms)),
                    0.2 * std::sin(0.002 * ms)));
                for (std::size_t k = 0; k < kStringCount; ++k) {
                    reading.counts[k] += slip[k];
                }
            }
            if (beats) {
                ++command.heartbeat;
            }
            tick(1, dt_s);
        }
    }
};

enum class Place {
    connected,
    arming,
    active,
    fading,
    fault,
    drawing_taut,
    checking_zero,
    calibrated
};
constexpr const char *kPlaces[] = {"connected", "arming",       "active",        "fading",
                                   "fault",     "drawing_taut", "checking_zero", "calibrated"};
constexpr std::size_t kPlaceCount = 8;

void go_to(Play &play, Place place) {
    play.run(20);
    REQUIRE(play.now().state == DeviceState::connected);
    switch (place) {
    case Place::connected:
        return;
    case Place::arming:
        ++play.command.arm_count;
        play.run(300);
        REQUIRE(play.now().state == DeviceState::arming);
        return;
    case Place::active:
    case Place::fading:
    case Place::fault:
        ++play.command.arm_count;
        play.run(1100);
        REQUIRE(play.now().state == DeviceState::active);
        if (place == Place::fading) {
            ++play.command.disarm_count;
            play.run(3);
            REQUIRE(play.now().state == DeviceState::fading);
        } else if (place == Place::fault) {
            ++play.command.stop_count;
            play.command.stop_reason = Status::loop_stalled;
            play.run(1);
            REQUIRE(play.now().state == DeviceState::fault);
        }
        return;
    case Place::drawing_taut:
    case Place::checking_zero:
    case Place::calibrated:
        // Taken at home.
        play.moves = false;
        play.put(moved_by(play.settings, Vec3(0.0)));
        play.run(400);
        ++play.command.zero_count;
        play.run(place == Place::drawing_taut ? 200 : 600);
        REQUIRE(play.now().state == DeviceState::taut);
        play.ms = 0;
        play.moves = place == Place::calibrated;
        for (int i = 0; place == Place::calibrated && i < 200; ++i) {
            play.run(20);
            if (play.now().state == DeviceState::calibrated) {
                break;
            }
        }
        REQUIRE((place != Place::calibrated || play.now().state == DeviceState::calibrated));
        REQUIRE(play.drive.motors_on);
        return;
    }
}

struct Cause {
    const char *name;
    void (*begin)(Play &);
    int limit_ms; // until the motors are off
    // The state after that, in the order of Place. A cell that is missing reads `closed`, and fails.
    DeviceState after[kPlaceCount];
};

constexpr DeviceState kConnected = DeviceState::connected;
constexpr DeviceState kFault = DeviceState::fault;
constexpr DeviceState kClosed = DeviceState::closed;

const Cause kCauses[] = {
    {"forces_enabled = false, as after a lost focus",
     [](Play &play) { play.command.forces_enabled = false; },
     21,
     {kConnected, kConnected, kConnected, kConnected, kFault, kConnected, kConnected, kConnected}},
    {"disarm()",
     [](Play &play) { ++play.command.disarm_count; },
     21,
     {kConnected, kConnected, kConnected, kConnected, kFault, kConnected, kConnected, kConnected}},
    {"the game is silent",
     [](Play &play) { play.beats = false; },
     525,
     {kConnected, kConnected, kConnected, kConnected, kFault, kConnected, kConnected, kConnected}},
    {"the motors are too warm",
     [](Play &play) {
         StringArray heat{};
         heat[4] = 2.0;
         play.step.set_heat(heat);
     },
     22,
     {kConnected, kConnected, kConnected, kConnected, kFault, kConnected, kConnected, kConnected}},
    {"the clock jumped",
     [](Play &play) { play.run(1, 0.2); },
     21,
     {kConnected, kConnected, kConnected, kConnected, kFault, kConnected, kConnected, kConnected}},
    {"no reports",
     [](Play &play) { play.read_status = Status::read_timeout; },
     20,
     {kFault, kFault, kFault, kFault, kFault, kFault, kFault, kFault}},
    {"the device says that an encoder is faulty",
     [](Play &play) {
         play.reading.device_status = Status::device_encoder_fault;
         play.reading.fault_strings = 0x20;
     },
     1,
     {kConnected, kFault, kFault, kFault, kFault, kFault, kFault, kFault}},
    {"panic_stop()",
     [](Play &play) {
         ++play.command.stop_count;
         play.command.stop_reason = Status::panic_stopped;
     },
     1,
     {kFault, kFault, kFault, kFault, kFault, kFault, kFault, kFault}},
    {"unplugged",
     [](Play &play) { play.read_status = Status::read_failed; },
     1,
     {kClosed, kClosed, kClosed, kClosed, kClosed, kClosed, kClosed, kClosed}},
};

} // namespace

TEST_CASE("motor rule: every state, every cause: the motors are off in time, and stay off") {
    for (const Cause &cause : kCauses) {
        for (std::size_t i = 0; i < kPlaceCount; ++i) {
            CAPTURE(cause.name);
            CAPTURE(std::string(kPlaces[i]));
            Play play;
            go_to(play, static_cast<Place>(i));
            cause.begin(play);
            int off_ms = 0;
            while (off_ms < cause.limit_ms &&
                   (!play.motors_off() || play.now().state != cause.after[i])) {
                play.run(1);
                ++off_ms;
            }
            CHECK(play.motors_off());
            CHECK(play.now().state == cause.after[i]);
            play.run(1500);
            CHECK(play.motors_off());
            CHECK(play.now().state == cause.after[i]);
        }
    }
}

TEST_CASE("motor rule: an encoder fault of the device names its string") {
    Play play;
    go_to(play, Place::active);
    play.reading.device_status = Status::device_encoder_fault;
    play.reading.fault_strings = 0x28; // strings 3 and 5: the first is told
    play.run(1);
    CHECK(play.now().fault == Status::device_encoder_fault);
    CHECK(play.now().fault_string == 3);
    bool told = false;
    for (const DeviceEvent &event : play.step.events()) {
        told = told || (event.kind == DeviceEventKind::device_stopped && event.string == 3);
    }
    CHECK(told);
}

TEST_CASE("motor rule: a string that is named ends every state that knows a pose") {
    for (const Place place : {Place::active, Place::calibrated, Place::arming}) {
        CAPTURE(std::string(kPlaces[static_cast<std::size_t>(place)]));
        Play play;
        play.settings.safety.arming_time_s = place == Place::arming ? 60.0 : 1.0;
        play.start();
        go_to(play, place);
        int told_string = -1;
        for (int ms = 0; ms < 6000 && play.drive.motors_on; ++ms) {
            // It creeps by 5 mm, too slowly to be told from what is usual.
            play.slip[2] = std::min(200, ms / 2);
            play.run(1);
            for (const DeviceEvent &event : play.step.events()) {
                told_string =
                    event.kind == DeviceEventKind::string_named ? event.string : told_string;
            }
        }
        CHECK(told_string == 2);
        play.run(25);
        CHECK(play.motors_off());
        CHECK(play.now().state == DeviceState::connected);
    }
}

TEST_CASE("motor rule: a motor that is too warm refuses arm() and a zero, and says so") {
    Play play;
    go_to(play, Place::connected);
    StringArray heat{};
    heat[6] = 1.2;
    play.step.set_heat(heat);
    for (const bool zero : {false, true}) {
        ++(zero ? play.command.zero_count : play.command.arm_count);
        int told = 0;
        for (int ms = 0; ms < 300; ++ms) {
            play.run(1);
            CHECK(play.motors_off());
            for (const DeviceEvent &event : play.step.events()) {
                told += event.kind == DeviceEventKind::overheated && event.string == 6 ? 1 : 0;
            }
        }
        CHECK(told == 1);
    }
    play.run(5000); // it cools with a time constant of 12 s
    CHECK(play.now().thermal_share < 1.0);
    ++play.command.arm_count;
    play.run(10);
    CHECK(play.now().state == DeviceState::arming);
}

TEST_CASE("motor rule: pretension leaves broken strings alone, in TAUT, CALIBRATED and in play") {
    for (const Place place :
         {Place::drawing_taut, Place::checking_zero, Place::calibrated, Place::active}) {
        CAPTURE(std::string(kPlaces[static_cast<std::size_t>(place)]));
        Play play;
        play.settings.tension.broken_mask = 0x08;
        play.settings.tension.dof_mask = kTranslationOnly;
        play.settings.render.compensated_friction_n = 0.1;
        play.start();
        REQUIRE(play.started == Status::ok);
        go_to(play, place);
        for (int ms = 0; ms < 50; ++ms) {
            play.run(1);
            CHECK(play.drive.motors_on);
            CHECK(play.drive.tensions_n[3] == 0.0);
            CHECK(play.drive.currents_a[3] == 0.0);
            CHECK(play.drive.tensions_n[2] > 0.0);
        }
    }
}
