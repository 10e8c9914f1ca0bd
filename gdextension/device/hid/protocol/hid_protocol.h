// The reports of the HID protocol, version 1, of a SPIDAR-G controller
// (docs/reference/hid_protocol.md). All fields are integers; their names end with the unit.
// hid_codec.h converts the reports to bytes and back.
#pragma once

#include <array>
#include <cstdint>

#include "core/base/types.h"

namespace spidar {

inline constexpr std::uint8_t kHidProtocolVersion = 1;
inline constexpr std::uint16_t kHidUsagePage = 0xFF00; // vendor defined

enum class HidReportId : std::uint8_t {
    state = 0x01,          // input report, sent once per control cycle of the device
    command = 0x02,        // output report
    capabilities = 0x10,   // feature report, read only
    limits = 0x11,         // feature report
    zero = 0x12,           // feature report
    device_control = 0x13, // feature report
};

// Sizes of the reports in bytes, with the report id and the two CRC bytes.
inline constexpr std::size_t kStateSize = 64;
inline constexpr std::size_t kCommandSize = 32;
inline constexpr std::size_t kCapabilitiesSize = 64;
inline constexpr std::size_t kLimitsSize = 16;
inline constexpr std::size_t kZeroSize = 40;
inline constexpr std::size_t kDeviceControlSize = 4;
inline constexpr std::size_t kLargestReport = 64; // one full-speed transaction

namespace state_flag {
inline constexpr std::uint8_t kActuatorsEnabled = 0x01;
inline constexpr std::uint8_t kEmergencyStop = 0x02;   // latched
inline constexpr std::uint8_t kWatchdogTripped = 0x04; // latched
inline constexpr std::uint8_t kActuatorPower = 0x08;   // the motors' supply is present
inline constexpr std::uint8_t kEncoderFault = 0x10;    // latched; see StateReport::fault_strings
inline constexpr std::uint8_t kOverTemperature = 0x20; // latched
inline constexpr std::uint8_t kCommandClipped = 0x40;  // a limit of the device changed the command
// The encoders were zeroed after the last power-up and the last USB reset.
inline constexpr std::uint8_t kZeroed = 0x80;
} // namespace state_flag

namespace command_flag {
inline constexpr std::uint8_t kEnable = 0x01;
inline constexpr std::uint8_t kEmergencyStop = 0x02;
inline constexpr std::uint8_t kClearFaults = 0x04; // ignored together with kEnable
inline constexpr std::uint8_t kHold = 0x08;        // keep HidLimits::min_tension_mn
inline constexpr std::uint8_t kAll = 0x0F;
} // namespace command_flag

// Value in StateReport::tensions_mn for a string whose tension the device does not measure.
inline constexpr std::uint16_t kNotMeasured = 0xFFFF;

struct StateReport {
    std::uint8_t flags = 0; // state_flag
    std::uint16_t sequence = 0;
    // Sequence number of the last accepted command; 0xFFFF: none.
    std::uint16_t accepted_command = 0xFFFF;
    std::uint32_t device_time_us = 0; // clock of the device; wraps at 32 bits
    CountArray counts{};
    std::array<std::uint16_t, kStringCount> tensions_mn{}; // measured, or kNotMeasured
    std::uint8_t buttons = 0;
    std::uint8_t fault_strings = 0; // bit i: the encoder of string i (0 to 7) is faulty
    std::uint16_t supply_mv = 0;
    bool operator==(const StateReport &) const = default;
};

struct CommandReport {
    std::uint8_t flags = 0; // command_flag
    std::uint16_t sequence = 0;
    std::uint16_t valid_for_ms = 0; // time from the command's arrival at the device; at least 1
    std::array<std::uint16_t, kStringCount> tensions_mn{};
    // Sequence number of the state from which the command was computed.
    std::uint16_t answers_state = 0xFFFF;
    std::uint32_t host_time_us = 0; // for logs only
    bool operator==(const CommandReport &) const = default;
};

// Kind of device, version and largest values.
struct HidCapabilities {
    std::uint8_t protocol_version = kHidProtocolVersion;
    std::uint8_t motor_count = kStringCount;
    std::uint16_t capabilities = 0; // bit 0: measures tension, bit 1: has a local impedance
    std::uint16_t firmware_version = 0;
    std::array<std::uint8_t, 12> unique_id{};
    std::uint32_t counts_per_turn = 0;
    std::uint16_t max_tension_mn = 0;
    std::uint16_t max_tension_rate_mn_ms = 0;
    std::uint16_t watchdog_limit_ms = 0; // a longer valid_for_ms is clamped to it
    std::uint16_t report_rate_hz = 0;
    std::uint16_t max_force_mn = 0; // at the center of the workspace
    std::uint16_t max_moment_mnm = 0;
    std::uint16_t max_grasp_torque_mnm = 0;
    std::uint16_t max_stiffness_n_m = 0;
    std::array<std::uint16_t, 3> workspace_mm{}; // full width along X, Y, Z
    std::uint16_t max_string_speed_mm_s = 0;
    bool operator==(const HidCapabilities &) const = default;
};

// For each limit the device keeps the stricter of its own value and this one. Reading the report
// returns the values that it keeps.
struct HidLimits {
    std::uint16_t max_tension_mn = 0;
    std::uint16_t tension_rate_mn_ms = 0;
    std::uint16_t string_speed_mm_s = 0;
    std::uint16_t ramp_in_ms = 0;
    std::uint16_t min_tension_mn = 0; // tension that the device keeps when commands stop
    bool operator==(const HidLimits &) const = default;
};

// Makes the device set its encoders to these counts. It accepts this only while the motors are off.
struct HidZero {
    CountArray counts{};
    bool operator==(const HidZero &) const = default;
};

// The values are those of the device control usages of the USB PID (physical interface device)
// class.
enum class DeviceControl : std::uint8_t {
    enable = 1,
    disable = 2,
    stop_all = 3,
    reset = 4,
    pause = 5,
    proceed = 6,
};

} // namespace spidar
