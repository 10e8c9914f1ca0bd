// Source of a servo loop's cycles: a device that a game drives, or a recording.
#pragma once

#include <cstdint>
#include <string>

#include "device/contract/device_event.h"
#include "device/contract/haptic_command.h"
#include "device/contract/servo_snapshot.h"
#include "device/contract/transport.h"

namespace spidar {

class ServoStep;

// Input of one servo cycle.
struct CycleGiven {
    CycleInput input;
    HapticCommand command;
    // True if the command may differ from that of the last cycle.
    bool command_is_new = false;
};

class CycleSource {
public:
    CycleSource() = default;
    CycleSource(const CycleSource &) = delete;
    CycleSource &operator=(const CycleSource &) = delete;
    virtual ~CycleSource() = default;

    // open() and close() may allocate and wait: never call them from a servo cycle. close() does
    // nothing when not open.
    virtual Status open() noexcept = 0;
    virtual void close() noexcept = 0;
    // True: each cycle advances the time by exactly one period, however long it took.
    [[nodiscard]] virtual bool simulated() const noexcept = 0;

    // Updates `given` for the next cycle; input.dt_s already holds the measured time. May set
    // `step` to another state. Returns false when no cycle is left. Each cycle calls next(),
    // write(), shown() and finish() in this order.
    virtual bool next(CycleGiven &given, ServoStep &step, EventLog &events) noexcept = 0;
    virtual Status write(const DriveCommand &drive) noexcept = 0;
    // Returns the snapshot that the game sees instead of the step's, or null for the step's.
    virtual const ServoSnapshot *shown(const ServoSnapshot & /*snapshot*/) noexcept {
        return nullptr;
    }
    virtual void finish(const ServoSnapshot &snapshot, const DriveCommand &drive,
                        double dt_s) noexcept = 0;

    // Prepares the first cycle. threaded: cycles run in real time in the loop's thread. This
    // function and those below have defaults for a source without device and game.
    virtual Status begin(bool /*threaded*/) noexcept { return Status::ok; }
    // Called after the last cycle.
    virtual void motors_off() noexcept {}
    // Like Transport::wait_report().
    [[nodiscard]] virtual bool wait_report(std::int64_t /*until_ns*/) noexcept { return false; }
    // Publishes the game's command; the newest wins. Called from the controlling thread. Wait-free.
    virtual void publish(const HapticCommand & /*command*/) noexcept {}
    // Called before a start. Sets `command` to the newest published one, so that the step can take
    // it as seen. A panic stop that was not cleared still has effect.
    virtual void restart(HapticCommand & /*command*/) noexcept {}
    // Called once after open(), before the first cycle. Returns true when `step` was set to the
    // state before that cycle, which a game may see.
    virtual bool recall(ServoStep & /*step*/) noexcept { return false; }
    // Like Transport::device_name(), after open().
    [[nodiscard]] virtual std::string device_name() const { return {}; }
    // Switches the motors off as soon as possible, and keeps them off in later runs until the fault
    // is cleared. Called from any thread; never waits.
    virtual void panic() noexcept {}
};

} // namespace spidar
