// The rule for motors as a table: every state, every reason to let go. What each cell has to do is written out here once
// more; a state or a reason without a row fails.
#include <doctest/doctest.h>

#include <array>
#include <string>

#include "device/safety/device_state_machine.h"

using namespace spidar;

namespace {

constexpr double kTick_s = 0.001;

constexpr std::array<DeviceState, kDeviceStates> kStates{
    DeviceState::closed, DeviceState::connected, DeviceState::arming, DeviceState::active,
    DeviceState::fading, DeviceState::fault,     DeviceState::taut,   DeviceState::calibrated};

DeviceStateMachine::Inputs all_well() {
    DeviceStateMachine::Inputs inputs;
    inputs.forces_enabled = true;
    inputs.tracking = true;
    inputs.may_arm_itself = true;
    return inputs;
}

void run(DeviceStateMachine &machine, const DeviceStateMachine::Inputs &inputs, int ticks) {
    for (int i = 0; i < ticks; ++i) {
        (void)machine.advance(inputs, kTick_s);
    }
}

DeviceStateMachine machine_in(DeviceState state) {
    DeviceStateMachine machine;
    machine.configure(1.0);
    if (state == DeviceState::closed) {
        return machine;
    }
    (void)machine.open(true);
    DeviceStateMachine::Inputs inputs = all_well();
    switch (state) {
    case DeviceState::closed:
        break;
    case DeviceState::connected:
        inputs.tracking = false; // it would arm itself
        run(machine, inputs, 5);
        break;
    case DeviceState::arming:
        run(machine, inputs, 500);
        break;
    case DeviceState::active:
        run(machine, inputs, 1100);
        break;
    case DeviceState::fading:
        run(machine, inputs, 1100);
        inputs.forces_enabled = false;
        run(machine, inputs, 5);
        break;
    case DeviceState::fault:
        run(machine, inputs, 1100);
        (void)machine.stop(StopReason::fault, Status::over_speed, 3);
        break;
    case DeviceState::taut:
    case DeviceState::calibrated:
        inputs.zero = true;
        run(machine, inputs, 1);
        inputs.zero = false;
        run(machine, inputs, 600);
        if (state == DeviceState::calibrated) {
            machine.confirm_zero();
        }
        break;
    }
    REQUIRE(machine.state() == state);
    return machine;
}

constexpr DeviceState kClosed = DeviceState::closed;
constexpr DeviceState kConnected = DeviceState::connected;
constexpr DeviceState kFading = DeviceState::fading;
constexpr DeviceState kFault = DeviceState::fault;
using After = std::array<DeviceState, kDeviceStates>;

// The state in the cycle of the reason, in the order of kStates.
constexpr After kSoft{kClosed, kConnected, kFading,    kFading,
                      kFading, kFault,     kConnected, kConnected};
constexpr After kHard{kClosed, kFault, kFault, kFault, kFault, kFault, kFault, kFault};
constexpr After kGone{kClosed, kClosed, kClosed, kClosed, kClosed, kClosed, kClosed, kClosed};

struct Row {
    StopReason reason;
    const char *name;
    After after;
    Rearm rearm;
};
constexpr std::array<Row, kStopReasons> kRows{{
    {StopReason::forces_off, "forces_off", kSoft, Rearm::by_itself},
    {StopReason::disarm_asked, "disarm_asked", kSoft, Rearm::by_toggle},
    {StopReason::game_silent, "game_silent", kSoft, Rearm::by_itself},
    {StopReason::overheated, "overheated", kSoft, Rearm::by_toggle},
    {StopReason::string_named, "string_named", kSoft, Rearm::by_toggle},
    {StopReason::clock_jumped, "clock_jumped", kSoft, Rearm::by_toggle},
    {StopReason::fault, "fault", kHard, Rearm::by_arm},
    {StopReason::panic, "panic", kHard, Rearm::by_arm},
    {StopReason::device_lost, "device_lost", kGone, Rearm::by_arm},
}};

constexpr bool rows_in_order() {
    for (std::size_t i = 0; i < kRows.size(); ++i) {
        if (static_cast<std::size_t>(kRows[i].reason) != i) {
            return false;
        }
    }
    return true;
}
static_assert(rows_in_order());

} // namespace

TEST_CASE(
    "motor rule: every state, every reason: the state that follows, and no force after 20 ms") {
    for (const Row &row : kRows) {
        for (std::size_t i = 0; i < kStates.size(); ++i) {
            CAPTURE(row.name);
            CAPTURE(std::string(describe(kStates[i])));
            DeviceStateMachine machine = machine_in(kStates[i]);
            const bool changed = machine.stop(row.reason, Status::unstable, 5);
            CHECK(machine.state() == row.after[i]);
            CHECK(changed == (row.after[i] != kStates[i]));
            CHECK(machine.motors_on() == (row.after[i] == kFading));
            // The reason goes on: nothing pulls, however long.
            DeviceStateMachine::Inputs inputs = all_well();
            inputs.tracking = false;
            run(machine, inputs, 21);
            CHECK_FALSE(machine.motors_on());
            CHECK(machine.scale() == 0.0);
            if (row.reason == StopReason::fault && kStates[i] == kFault) {
                CHECK(machine.fault() == Status::over_speed); // the first one stands
                CHECK(machine.fault_string() == 3);
            } else if (row.after[i] == kFault && kStates[i] != kFault) {
                CHECK(machine.fault() == Status::unstable);
                CHECK(machine.fault_string() == 5);
            }
        }
    }
}

TEST_CASE("motor rule: what arms a device again that arms itself") {
    for (const Row &row : kRows) {
        CAPTURE(row.name);
        CHECK(rearm_after(row.reason, true) == row.rearm);
        DeviceStateMachine machine = machine_in(DeviceState::active);
        (void)machine.stop(row.reason, Status::unstable);
        DeviceStateMachine::Inputs inputs = all_well();
        run(machine, inputs, 30);
        machine.clear(true);
        run(machine, inputs, 1200);
        CHECK((machine.state() == DeviceState::active) == (row.rearm == Rearm::by_itself));
        inputs.forces_enabled = false;
        run(machine, inputs, 30);
        inputs.forces_enabled = true;
        run(machine, inputs, 1200);
        CHECK((machine.state() == DeviceState::active) == (row.rearm != Rearm::by_arm));
        inputs.arm = true;
        run(machine, inputs, 1);
        inputs.arm = false;
        run(machine, inputs, 1200);
        CHECK(machine.state() == DeviceState::active);
    }
}

TEST_CASE("motor rule: a real device arms by arm() alone, whatever let it go") {
    for (const Row &row : kRows) {
        CAPTURE(row.name);
        DeviceStateMachine machine = machine_in(DeviceState::active);
        DeviceStateMachine::Inputs inputs = all_well();
        inputs.may_arm_itself = false;
        run(machine, inputs, 1);
        (void)machine.stop(row.reason, Status::unstable);
        machine.clear(true);
        run(machine, inputs, 1200);
        inputs.forces_enabled = false;
        run(machine, inputs, 30);
        inputs.forces_enabled = true;
        run(machine, inputs, 1200);
        CHECK(machine.state() == DeviceState::connected);
    }
}

TEST_CASE("motor rule: an arm() that still waits is forgotten with every reason to let go") {
    for (const Row &row : kRows) {
        if (row.reason == StopReason::forces_off || row.reason == StopReason::game_silent) {
            continue; // these stand, so that nothing arms meanwhile, and nothing is taken back by them
        }
        CAPTURE(row.name);
        DeviceStateMachine machine = machine_in(DeviceState::connected);
        DeviceStateMachine::Inputs inputs = all_well();
        inputs.may_arm_itself = false;
        inputs.tracking = false; // no pose yet: arm() waits for one
        inputs.arm = true;
        run(machine, inputs, 1);
        inputs.arm = false;
        (void)machine.stop(row.reason, Status::unstable);
        machine.clear(true);
        inputs.forces_enabled = false;
        run(machine, inputs, 1);
        inputs.forces_enabled = true;
        inputs.tracking = true;
        run(machine, inputs, 80);
        CHECK(machine.state() == DeviceState::connected);
    }
}

TEST_CASE("motor rule: what stands ends every state that pulls, and keeps it from beginning") {
    struct Standing {
        const char *name;
        void (*set)(DeviceStateMachine::Inputs &);
    };
    const Standing kStanding[] = {
        {"forces_off", [](DeviceStateMachine::Inputs &in) { in.forces_enabled = false; }},
        {"game_silent", [](DeviceStateMachine::Inputs &in) { in.game_alive = false; }},
        {"overheated", [](DeviceStateMachine::Inputs &in) { in.too_warm = true; }},
    };
    for (const Standing &standing : kStanding) {
        CAPTURE(standing.name);
        for (const DeviceState state : kStates) {
            CAPTURE(std::string(describe(state)));
            DeviceStateMachine machine = machine_in(state);
            DeviceStateMachine::Inputs inputs = all_well();
            standing.set(inputs);
            run(machine, inputs, 21);
            CHECK_FALSE(machine.motors_on());
            // Neither arm() nor zero_at_home() help against it.
            for (const bool zero : {false, true}) {
                inputs.arm = !zero;
                inputs.zero = zero;
                run(machine, inputs, 3);
                CHECK_FALSE(machine.motors_on());
            }
        }
    }
    // What a motor that is too warm refuses is told, once for each time that it was asked for.
    DeviceStateMachine machine = machine_in(DeviceState::connected);
    DeviceStateMachine::Inputs inputs = all_well();
    inputs.too_warm = true;
    inputs.arm = true;
    CHECK(machine.advance(inputs, kTick_s).too_warm);
    inputs.arm = false;
    CHECK_FALSE(machine.advance(inputs, kTick_s).too_warm);
}

TEST_CASE(
    "motor rule: a panic stop of a closed device: it opens in FAULT, until the fault is cleared") {
    DeviceStateMachine machine = machine_in(DeviceState::closed);
    CHECK_FALSE(machine.stop(StopReason::panic, Status::panic_stopped));
    CHECK(machine.needs_clearing());
    CHECK(machine.open(true));
    CHECK(machine.state() == DeviceState::fault);
    CHECK(machine.fault() == Status::panic_stopped);
    machine.clear(true);
    CHECK(machine.state() == DeviceState::connected);
    run(machine, all_well(), 1200);
    CHECK(machine.state() == DeviceState::connected); // and does not arm itself

    machine = machine_in(DeviceState::closed);
    (void)machine.stop(StopReason::panic, Status::panic_stopped);
    machine.clear(false);
    CHECK_FALSE(machine.needs_clearing());
    CHECK_FALSE(machine.open(true));
    CHECK(machine.state() == DeviceState::connected);
    run(machine, all_well(), 1200);
    CHECK(machine.state() == DeviceState::connected);

    // Lost, stopped while away, back again.
    machine = machine_in(DeviceState::active);
    (void)machine.stop(StopReason::device_lost, Status::read_failed);
    (void)machine.stop(StopReason::panic, Status::panic_stopped);
    CHECK(machine.fault() == Status::read_failed);
    machine.clear(true);
    CHECK(machine.state() == DeviceState::connected);
    CHECK_FALSE(machine.needs_clearing());
    // Lost once more, for another reason.
    (void)machine.stop(StopReason::device_lost, Status::write_failed);
    CHECK(machine.state() == DeviceState::closed);
    CHECK(machine.fault() == Status::write_failed);
    // Other reasons mean nothing to a device that is closed.
    machine = machine_in(DeviceState::closed);
    (void)machine.stop(StopReason::fault, Status::loop_stalled);
    CHECK_FALSE(machine.open(true));
    CHECK(machine.state() == DeviceState::connected);
}

TEST_CASE("motor rule: a zero outlasts letting go from CALIBRATED, not from TAUT") {
    for (const Row &row : kRows) {
        CAPTURE(row.name);
        DeviceStateMachine machine = machine_in(DeviceState::taut);
        (void)machine.stop(row.reason, Status::unstable);
        CHECK_FALSE(machine.zero_known());
        CHECK_FALSE(machine.checking_zero());
        machine = machine_in(DeviceState::calibrated);
        (void)machine.stop(row.reason, Status::unstable);
        CHECK(machine.zero_known());
    }
    // From FADING too: it ends in CONNECTED with the motors off, and arm() needs no new zero.
    DeviceStateMachine machine = machine_in(DeviceState::calibrated);
    DeviceStateMachine::Inputs inputs = all_well();
    inputs.may_arm_itself = false;
    inputs.arm = true;
    run(machine, inputs, 1);
    inputs.arm = false;
    run(machine, inputs, 1200);
    REQUIRE(machine.state() == DeviceState::active);
    inputs.disarm = true;
    run(machine, inputs, 1);
    inputs.disarm = false;
    run(machine, inputs, 25);
    CHECK(machine.state() == DeviceState::connected);
    CHECK_FALSE(machine.motors_on());
    CHECK(machine.zero_known());
    inputs.arm = true;
    run(machine, inputs, 1);
    CHECK(machine.state() == DeviceState::arming);
}
