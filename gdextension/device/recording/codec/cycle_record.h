// One servo cycle as the loop passes it to the recorder: all inputs of ServoStep::step() and
// report_write(), and the outputs.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "device/contract/servo_snapshot.h"
#include "device/contract/transport.h"

namespace spidar {

// Outputs that change rarely and together.
struct CycleState {
    DeviceState state = DeviceState::closed;
    GraspPhase grasp = GraspPhase::open;
    std::int8_t fault_string = -1;
    bool motors_on = false;
    Status fault = Status::ok;
    Status pose_status = Status::ok;
    Status tension_status = Status::ok;
    bool operator==(const CycleState &) const = default;
};

// Outputs that a replay must reproduce bit for bit: commands to the motors and values for the game.
struct CycleOutput : CycleState {
    static constexpr std::size_t kValues = 42;
    // Order: currents_a 8, tensions_n 8, pose 9 (position_m, r1_m, r2_m), twist 7, requested wrench
    // 7, grasp angle, force scale, time_s.
    std::array<double, kValues> values{};
};

// Index of the first tension in CycleOutput::values.
inline constexpr std::size_t kOutputTensions = 8;

void fill_output(const ServoSnapshot &snapshot, const DriveCommand &drive,
                 CycleOutput &output) noexcept;

// Returns a hash of all bits of an output.
[[nodiscard]] std::uint32_t digest_of(const CycleOutput &output) noexcept;

// Rounded tensions, which can be read without a replay (unit: mN).
using MillinewtonArray = std::array<std::int32_t, kStringCount>;
[[nodiscard]] MillinewtonArray millinewtons_of(const CycleOutput &output) noexcept;

// A read of the device by the game: the game saw the snapshot of the cycle `tick`.
struct GameRead {
    std::uint64_t tick = 0; // of the cycle, as CycleRecord::tick
    // True for the read of a physics tick, false for one between two ticks.
    bool physics_tick = false;
    // Sequence number of the newest contacts that the game had requested.
    std::uint64_t contacts_sequence = 0;
    bool operator==(const GameRead &) const = default;
};

struct CycleRecord {
    CycleInput input;
    CycleOutput output;
    // Cycles that were dropped because the ring was full, since the recording began.
    std::uint64_t lost_before = 0;
    // Cycles since the device was opened, including this one.
    std::uint64_t tick = 0;
    bool segment_start = false; // first of a segment (recorder.h)
    // the command is recorded with this cycle: it is new, or a segment starts
    bool command_is_new = false;
};

} // namespace spidar
