// The firmware model against the protocol page: what a real controller must do, in its own words.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>

#include "hid/firmware_model.h"

using namespace spidar;
using spidar::test::FirmwareModel;

namespace {

constexpr std::uint32_t kTick_us = 1000;

struct Rig {
    FirmwareModel firmware;
    CommandReport command;

    Rig() {
        command.valid_for_ms = 20;
        firmware.inputs.raw_counts = {1, 2, 3, 4, 5, 6, 7, 8};
    }
    void send(std::uint8_t flags, std::uint16_t tension_mn) {
        command.flags = flags;
        command.sequence = next_sequence(command.sequence);
        command.tensions_mn.fill(tension_mn);
        firmware.receive(encode(command));
    }
    StateReport state() const {
        StateReport report;
        REQUIRE(decode(firmware.report(), report) == Decoded::ok);
        return report;
    }
    // Enabled, ramp over.
    void activate(std::uint16_t tension_mn) {
        for (int i = 0; i < 150; ++i) {
            send(command_flag::kEnable, tension_mn);
            firmware.advance(kTick_us);
        }
        REQUIRE(firmware.motors_mn()[7] == tension_mn);
    }
    bool off() const {
        const auto &motors = firmware.motors_mn();
        return std::all_of(motors.begin(), motors.end(), [](auto mn) { return mn == 0; });
    }
};

} // namespace

TEST_CASE("firmware: commands stop: minimum tension at 20 ms, nothing at 50 ms, latched") {
    Rig rig;
    rig.activate(5000);
    for (int ms = 1; ms <= 60; ++ms) {
        rig.firmware.advance(kTick_us);
        CAPTURE(ms);
        const std::uint16_t motor = rig.firmware.motors_mn()[0];
        // The last command came one tick before the first of these.
        CHECK(motor == (ms < 19 ? 5000 : ms < 49 ? 300 : 0));
    }
    CHECK((rig.state().flags & state_flag::kWatchdogTripped) != 0);
    rig.send(command_flag::kEnable, 5000);
    rig.firmware.advance(kTick_us);
    CHECK(rig.off());
    rig.send(command_flag::kClearFaults | command_flag::kEnable,
             5000); // clearing acts only when disabled
    CHECK((rig.state().flags & state_flag::kWatchdogTripped) != 0);
    rig.send(command_flag::kClearFaults, 0);
    CHECK((rig.state().flags & state_flag::kWatchdogTripped) == 0);
    rig.send(command_flag::kEnable, 5000);
    rig.firmware.advance(kTick_us);
    CHECK_FALSE(rig.off());
    CHECK(rig.firmware.motors_mn()[0] < 100); // the ramp begins anew
}

TEST_CASE("firmware: a pause shorter than the watchdog holds, and goes on after it") {
    Rig rig;
    rig.activate(5000);
    for (int i = 0; i < 40; ++i) {
        rig.firmware.advance(kTick_us);
    }
    CHECK(rig.firmware.mode() == FirmwareModel::Mode::holding);
    CHECK(rig.firmware.motors_mn()[0] == 300);
    rig.send(command_flag::kEnable, 5000);
    rig.firmware.advance(kTick_us);
    CHECK(rig.firmware.motors_mn()[0] == 1300); // 1 N a ms, its own limit
}

TEST_CASE("firmware: a longer validity than its limit is cut") {
    Rig rig;
    rig.command.valid_for_ms = 60000;
    rig.activate(2000);
    for (int i = 0; i < 25; ++i) {
        rig.firmware.advance(kTick_us);
    }
    CHECK(rig.firmware.mode() == FirmwareModel::Mode::holding);
}

TEST_CASE("firmware: enables only when powered and without fault") {
    Rig rig;
    rig.firmware.inputs.motor_power = false;
    rig.send(command_flag::kEnable, 1000);
    rig.firmware.advance(kTick_us);
    CHECK(rig.off());
    rig.firmware.inputs.motor_power = true;
    rig.firmware.inputs.emergency_stop = true;
    rig.firmware.advance(kTick_us);
    rig.firmware.inputs.emergency_stop = false;
    rig.send(command_flag::kEnable, 1000);
    rig.firmware.advance(kTick_us);
    CHECK(rig.off());
    CHECK((rig.state().flags & state_flag::kEmergencyStop) != 0);
    rig.send(command_flag::kClearFaults, 0);
    rig.activate(1000);
    rig.firmware.inputs.faulty_encoders = 0x20;
    rig.firmware.advance(kTick_us);
    CHECK(rig.off());
    CHECK(rig.state().fault_strings == 0x20);
    rig.send(command_flag::kClearFaults, 0); // still faulty: stays latched
    CHECK((rig.state().flags & state_flag::kEncoderFault) != 0);
}

TEST_CASE("firmware: old, equal and corrupt commands change nothing") {
    Rig rig;
    rig.activate(1000);
    CommandReport old = rig.command;
    old.tensions_mn.fill(9000);
    rig.firmware.receive(encode(old));
    old.sequence = static_cast<std::uint16_t>(old.sequence - 1);
    rig.firmware.receive(encode(old));
    auto bytes = encode(old);
    bytes[6] ^= 1U;
    rig.firmware.receive(bytes);
    rig.firmware.receive(ReportBytes(bytes).first(31));
    rig.firmware.advance(kTick_us);
    CHECK(rig.firmware.motors_mn()[0] == 1000);
    CHECK(rig.firmware.counters().stale == 2);
    CHECK(rig.firmware.counters().rejected == 2);
    rig.command.sequence = static_cast<std::uint16_t>(rig.command.sequence + 4);
    rig.send(command_flag::kEnable, 1000);
    CHECK(rig.firmware.counters().lost == 4);
}

TEST_CASE("firmware: keeps the stricter limits, and zeroes only while disabled") {
    Rig rig;
    REQUIRE(rig.firmware.set_feature(encode(HidLimits{3000, 500, 4000, 10, 200})));
    std::array<std::uint8_t, kLargestReport> bytes{};
    const std::size_t size = rig.firmware.get_feature(0x11, bytes);
    HidLimits kept;
    REQUIRE(decode(ReportBytes(bytes).first(size), kept) == Decoded::ok);
    CHECK(kept == HidLimits{3000, 500, 4000, 100, 200}); // the longer ramp is the stricter
    rig.activate(3000);
    rig.send(command_flag::kEnable, 9000);
    rig.firmware.advance(kTick_us);
    CHECK(rig.firmware.motors_mn()[0] == 3000);
    CHECK((rig.state().flags & state_flag::kCommandClipped) != 0);
    CHECK_FALSE(rig.firmware.set_feature(encode(HidZero{})));
    REQUIRE(rig.firmware.set_feature(encode(DeviceControl::stop_all)));
    CHECK(rig.off());
    CountArray home{};
    home.fill(-77);
    REQUIRE(rig.firmware.set_feature(encode(HidZero{home})));
    CHECK(rig.state().counts == home);
    rig.firmware.inputs.raw_counts[3] += 5;
    CHECK(rig.state().counts[3] == -72);
    rig.firmware.bus_reset();
    CHECK((rig.state().flags & state_flag::kZeroed) == 0);
    CHECK(rig.state().accepted_command == kNoSequence);
}
