// One servo cycle as it is handed from the loop to whoever writes it down: everything that ServoStep::step and
// report_write() were given, and what came out.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "device/contract/servo_snapshot.h"
#include "device/contract/transport.h"

namespace spidar {

// What changes rarely in an output, and together.
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

// What a replay must reproduce to the bit: what went to the motors, and what the game was told.
struct CycleOutput : CycleState {
    static constexpr std::size_t kValues = 42;
    // currents_a 8, tensions_n 8, pose 9, twist 7, requested wrench 7, grasp angle, force scale, time_s
    std::array<double, kValues> values{};
};

inline constexpr std::size_t kOutputTensions = 8; // where tensions_n begin in CycleOutput::values

void fill_output(const ServoSnapshot &snapshot, const DriveCommand &drive,
                 CycleOutput &output) noexcept;

// All bits of an output as one number.
[[nodiscard]] std::uint32_t digest_of(const CycleOutput &output) noexcept;

// Tensions as they are stored to be read without a replay (unit: mN).
using MillinewtonArray = std::array<std::int32_t, kStringCount>;
[[nodiscard]] MillinewtonArray millinewtons_of(const CycleOutput &output) noexcept;

// The game looked at the device: what it saw then is the snapshot of this cycle.
struct GameRead {
    std::uint64_t tick = 0;    // of the cycle, as CycleRecord::tick
    bool physics_tick = false; // the look of a physics tick; else one between two of them
    std::uint64_t contacts_sequence =
        0; // of the newest set of contacts that the game had asked for
    bool operator==(const GameRead &) const = default;
};

struct CycleRecord {
    CycleInput input;
    CycleOutput output;
    std::uint64_t lost_before = 0; // cycles that found the ring full, since the recording began
    std::uint64_t tick = 0;        // cycles since the device was opened; this one included
    bool segment_start = false;    // a memory of the step goes before it
    bool command_is_new = false;   // differs from the cycle before
};

} // namespace spidar
