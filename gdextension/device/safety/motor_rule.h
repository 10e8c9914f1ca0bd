// The one rule for motors: what each reason to let go does in each state. Whatever watches a device only names its reason;
// this table decides what follows, for every state that pulls and for those that do not.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "device/contract/device_state.h"

namespace spidar {

enum class StopReason : std::uint8_t {
    forces_off = 0,   // forces_enabled = false: by the game, by a lost focus, after a panic
    disarm_asked = 1, // disarm()
    game_silent = 2,  // no heartbeat of the game
    overheated = 3,   // a motor's thermal budget is spent
    string_named = 4, // the length of one string is known to be wrong
    clock_jumped = 5, // the computer slept, or its clock is wrong
    fault = 6,        // reports stopped, over-speed, shaking, strings, a fault of the device's own
    panic = 7,        // panic_stop()
    device_lost = 8,  // unplugged
};
inline constexpr std::size_t kStopReasons = 9;
static_assert(kStopReasons == static_cast<std::size_t>(StopReason::device_lost) + 1);

enum class StopAction : std::uint8_t {
    unset = 0,   // a cell that nobody filled in: does not compile
    nothing = 1, // the motors are off, or on their way to it
    disarm = 2,  // nothing pulls, and a device that would arm itself no longer does
    fade = 3,    // forces fall within 20 ms, then CONNECTED with the motors off
    let_go = 4,  // CONNECTED, motors off in this cycle
    fault = 5,   // FAULT, motors off in this cycle
    close = 6,   // CLOSED, motors off in this cycle
    latch = 7,   // CLOSED stays; the device opens in FAULT
};

// What makes a device arm again that would arm itself (a simulated one). A real one always waits for arm().
enum class Rearm : std::uint8_t {
    by_itself = 0, // as soon as the reason is gone
    by_toggle = 1, // by arm(), or by forces_enabled switched off and on
    by_arm = 2,    // by arm() alone
};

namespace motor_rule {

using A = StopAction;
using Row = std::array<StopAction, kDeviceStates>;

// A row for each reason, a column for each state, both in the order of their enumerations.
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
// may_arm_itself: a simulated device, which plays on when its game does.
[[nodiscard]] constexpr Rearm rearm_after(StopReason reason, bool may_arm_itself) noexcept {
    return reason == StopReason::game_silent && may_arm_itself
               ? Rearm::by_itself
               : motor_rule::kRearm[static_cast<std::size_t>(reason)];
}

} // namespace spidar
