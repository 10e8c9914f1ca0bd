// A controller's firmware as docs/reference/hid_protocol.md asks for it, without hardware: bytes and encoder counts in, bytes
// and motor tensions out, on a clock that the caller moves. Integers only; what a firmware author may start from.
#pragma once

#include <array>
#include <cstdint>

#include "device/hid/protocol/hid_codec.h"
#include "device/hid/protocol/report_sequence.h"

namespace spidar::test {

using MotorTensions_mn = std::array<std::uint16_t, kStringCount>;

struct FirmwareSettings {
    HidCapabilities capabilities{.counts_per_turn = 2000,
                                 .max_tension_mn = 15000,
                                 .max_tension_rate_mn_ms = 2000,
                                 .watchdog_limit_ms = 20,
                                 .report_rate_hz = 1000,
                                 .max_force_mn = 8000,
                                 .max_moment_mnm = 400,
                                 .max_grasp_torque_mnm = 400,
                                 .max_stiffness_n_m = 1000,
                                 .workspace_mm = {200, 200, 200},
                                 .max_string_speed_mm_s = 5000};
    HidLimits limits{.max_tension_mn = 12000,
                     .tension_rate_mn_ms = 1000,
                     .string_speed_mm_s = 5000,
                     .ramp_in_ms = 100,
                     .min_tension_mn = 300};
    // Without a command for this long the motors are off, until faults are cleared.
    std::uint32_t motors_off_after_us = 50'000;
};

class FirmwareModel {
public:
    enum class Mode : std::uint8_t {
        disabled, // motors off
        active,   // follows commands; their tensions rise with the ramp at first
        holding,  // the last command has expired: minimum tension
    };

    // What the outside does to the device.
    struct Inputs {
        CountArray raw_counts{}; // of the encoders since power-up
        std::uint8_t buttons = 0;
        bool motor_power = true;
        bool emergency_stop = false;
        bool too_hot = false;
        std::uint8_t faulty_encoders = 0;
    };
    // What a real firmware would count for its maker.
    struct Counters {
        std::uint64_t accepted = 0;
        std::uint64_t rejected = 0; // length, id, CRC or value
        std::uint64_t stale = 0;    // not newer than the last
        std::uint64_t lost = 0;     // gaps in the sequence
        std::uint64_t holds = 0;
        std::uint64_t trips = 0;
    };

    explicit FirmwareModel(const FirmwareSettings &settings = {});

    // An OUT report as it comes from the endpoint.
    void receive(ReportBytes bytes) noexcept;
    // False: refused; the device answers the control transfer with a stall.
    bool set_feature(ReportBytes bytes) noexcept;
    // Size of the report; 0 for an unknown one.
    std::size_t get_feature(std::uint8_t id,
                            std::array<std::uint8_t, kLargestReport> &bytes) const noexcept;
    // The plug was pulled or the bus was reset: motors off, zero and sequences forgotten.
    void bus_reset() noexcept;
    // Time moves on: watchdog, ramp, motor tensions, next report.
    void advance(std::uint32_t dt_us) noexcept;

    [[nodiscard]] std::array<std::uint8_t, kStateSize> report() const noexcept;
    [[nodiscard]] const MotorTensions_mn &motors_mn() const noexcept { return motors_mn_; }
    [[nodiscard]] Mode mode() const noexcept { return mode_; }
    [[nodiscard]] const Counters &counters() const noexcept { return counters_; }
    [[nodiscard]] std::uint32_t time_us() const noexcept { return time_us_; }
    [[nodiscard]] std::uint8_t flags() const noexcept;
    Inputs inputs;

private:
    [[nodiscard]] bool healthy() const noexcept;
    void latch_faults() noexcept;
    void switch_off() noexcept;

    FirmwareSettings settings_;
    HidLimits limits_;
    Counters counters_;
    Mode mode_ = Mode::disabled;
    MotorTensions_mn motors_mn_{};
    CommandReport command_;
    std::uint16_t accepted_ = kNoSequence;
    std::uint16_t sequence_ = 0;
    std::uint32_t time_us_ = 0;
    std::uint32_t since_command_us_ = 0;
    std::uint32_t ramp_us_ = 0;
    std::uint8_t latched_ = 0; // state_flag bits of faults
    std::uint8_t fault_strings_ = 0;
    CountArray zero_offset_{};
    bool zeroed_ = false;
    bool clipped_ = false;
    bool paused_ = false;
};

} // namespace spidar::test
