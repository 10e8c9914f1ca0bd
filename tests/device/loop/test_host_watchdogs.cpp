// What the host's own reasons to stop become: an edge in the command of each run that they hold for, and of no other.
#include <doctest/doctest.h>

#include "device/loop/host_watchdogs.h"

using namespace spidar;

namespace {

struct Rig {
    HostWatchdogs watchdogs;
    HapticCommand command;
    EventLog events;
    std::uint32_t acknowledged = 0;

    // As ServoLoop does before its first cycle: what the command holds now is old.
    void start() {
        watchdogs.restart(command);
        acknowledged = command.stop_count;
    }
    // A cycle: the reason to stop that it brings; ok: none.
    Status cycle() {
        const bool told = watchdogs.watch(nullptr, command, events);
        const bool edge = command.stop_count != acknowledged;
        acknowledged = command.stop_count;
        if (!edge) {
            CHECK_FALSE(told);
            return Status::ok;
        }
        return command.stop_reason;
    }
};

} // namespace

TEST_CASE("host watchdogs: a panic is an edge of one cycle, and of the first cycle of each run "
          "until it is cleared") {
    Rig rig;
    for (int life = 0; life < 3;
         ++life) { // the same each time, however often a fault was cleared before
        CAPTURE(life);
        rig.start();
        CHECK(rig.cycle() == Status::ok);
        rig.watchdogs.panic();
        CHECK(rig.cycle() == Status::panic_stopped);
        CHECK(rig.cycle() == Status::ok);
        rig.start();
        CHECK(rig.cycle() == Status::panic_stopped);
        CHECK(rig.cycle() == Status::ok);
        rig.start(); // a second one without a word of the game
        CHECK(rig.cycle() == Status::panic_stopped);
        if (life == 1) { // cleared while it runs
            ++rig.command.clear_fault_count;
            CHECK(rig.cycle() == Status::ok);
            rig.start();
        } else { // or while it does not
            ++rig.command.clear_fault_count;
            rig.start();
        }
        CHECK(rig.cycle() == Status::ok);
        rig.start();
        CHECK(rig.cycle() == Status::ok);
    }
}

TEST_CASE("host watchdogs: a panic beside a clear_fault() holds, whichever came first") {
    Rig rig;
    rig.start();
    rig.watchdogs.panic();
    ++rig.command.clear_fault_count;
    CHECK(rig.cycle() == Status::panic_stopped);
    rig.start();
    CHECK(rig.cycle() == Status::panic_stopped);
    ++rig.command.clear_fault_count;
    rig.watchdogs.panic();
    rig.start();
    CHECK(rig.cycle() == Status::panic_stopped);
    ++rig.command.clear_fault_count;
    rig.start();
    CHECK(rig.cycle() == Status::ok);
}

TEST_CASE(
    "host watchdogs: a game's own command, which knows of no stop, makes no edge in a later run") {
    Rig rig;
    rig.start();
    rig.watchdogs.panic();
    CHECK(rig.cycle() == Status::panic_stopped);
    ++rig.command.clear_fault_count;
    CHECK(rig.cycle() == Status::ok);
    rig.command.stop_count = 0; // as a game publishes it
    rig.start();
    CHECK(rig.cycle() == Status::ok);
    rig.command.stop_count = 0;
    CHECK(rig.cycle() == Status::ok);
}
