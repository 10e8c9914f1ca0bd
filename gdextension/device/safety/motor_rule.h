// The one rule for switching motors off: the action of each reason in each state. A monitor only
// gives its reason; this table decides what follows.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "device/contract/device_state.h"

namespace spidar {

enum class StopReason : std::uint8_t {
    forces_off = 0,   // forces_enabled = false: by the game, lost focus, or after a panic
    disarm_asked = 1, // disarm()
    game_silent = 2,  // no heartbeat of the game
    overheated = 3,   // a motor's thermal budget is spent
    string_named = 4, // one string is known to have a wrong length
    clock_jumped = 5, // the computer slept, or its clock is wrong
    fault = 6,        // reports stopped, over-speed, shaking, strings, or a device fault
    panic = 7,        // panic_stop()
    device_lost = 8,  // unplugged
};
inline constexpr std::size_t kStopReasons = 9;
static_assert(kStopReasons == static_cast<std::size_t>(StopReason::device_lost) + 1);

enum class StopAction : std::uint8_t {
    unset = 0,   // a cell that was not filled in: does not compile
    nothing = 1, // the motors are off or going off
    // The state stays (the motors are off or going off), but the device does not arm itself again.
    disarm = 2,
    // Forces fall within 20 ms, then CONNECTED with the motors off.
    fade = 3,
    let_go = 4, // CONNECTED, motors off in this cycle
    fault = 5,  // FAULT, motors off in this cycle
    close = 6,  // CLOSED, motors off in this cycle
    latch = 7,  // stays CLOSED; the device opens in FAULT
};

// What must happen before a simulated device, which arms itself, arms again. A real device always
// waits for arm().
enum class Rearm : std::uint8_t {
    by_itself = 0, // the reason ends
    by_toggle = 1, // arm(), or forces_enabled switched off and on
    by_arm = 2,    // arm() alone
};

namespace motor_rule {

using A = StopAction;
using Row = std::array<StopAction, kDeviceStates>;

// One row per reason and one column per state, both in the order of their enumerations.
inline constexpr std::array<Row, kStopReasons> kActions{{
    //  closed      connected  arming    active    fading     fault       taut       calibrated
    {A::nothing, A::nothing, A::fade, A::fade, A::nothing, A::nothing, A::let_go, A::let_go},
    {A::disarm, A::disarm, A::fade, A::fade, A::disarm, A::disarm, A::let_go, A::let_go},
    {A::nothing, A::nothing, A::fade, A::fade, A::nothing, A::nothing, A::let_go, A::let_go},
    {A::disarm, A::disarm, A::fade, A::fade, A::disarm, A::disarm, A::let_go, A::let_go},
    {A::disarm, A::disarm, A::fade, A::fade, A::disarm, A::disarm, A::let_go, A::let_go},
    {A::disarm, A::disarm, A::fade, A::fade, A::disarm, A::disarm, A::let_go, A::let_go},
    {A::nothing, A::fault, A::fault, A::fault, A::fault, A::nothing, A::fault, A::fault},
    {A::latch, A::fault, A::fault, A::fault, A::fault, A::nothing, A::fault, A::fault},
    {A::close, A::close, A::close, A::close, A::close, A::close, A::close, A::close},
}};

inline constexpr std::array<Rearm, kStopReasons> kRearm{
    Rearm::by_itself, // forces_off
    Rearm::by_toggle, // disarm_asked
    Rearm::by_toggle, // game_silent
    Rearm::by_toggle, // overheated
    Rearm::by_toggle, // string_named
    Rearm::by_toggle, // clock_jumped
    Rearm::by_arm,    // fault
    Rearm::by_arm,    // panic
    Rearm::by_arm,    // device_lost
};

[[nodiscard]] constexpr bool is_whole() noexcept {
    for (const Row &row : kActions) {
        for (const StopAction action : row) {
            if (action == StopAction::unset) {
                return false;
            }
        }
    }
    return true;
}
static_assert(is_whole(), "a state or a reason is missing in the rule for motors");

} // namespace motor_rule

[[nodiscard]] constexpr StopAction stop_action(DeviceState state, StopReason reason) noexcept {
    return motor_rule::kActions[static_cast<std::size_t>(reason)][static_cast<std::size_t>(state)];
}
// may_arm_itself: true for a simulated device. It arms again when its silent game comes back.
[[nodiscard]] constexpr Rearm rearm_after(StopReason reason, bool may_arm_itself) noexcept {
    return reason == StopReason::game_silent && may_arm_itself
               ? Rearm::by_itself
               : motor_rule::kRearm[static_cast<std::size_t>(reason)];
}

} // namespace spidar
