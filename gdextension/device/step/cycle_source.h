// Where the cycles of a servo loop come from: a device that a game drives, or a recording that is played again.
#pragma once

#include <cstdint>
#include <string>

#include "device/contract/device_event.h"
#include "device/contract/haptic_command.h"
#include "device/contract/servo_snapshot.h"
#include "device/contract/transport.h"

namespace spidar {

class ServoStep;

// What one servo cycle is given.
struct CycleGiven {
    CycleInput input;
    HapticCommand command;
    bool command_is_new = false; // may differ from the cycle before
};

class CycleSource {
public:
    CycleSource() = default;
    CycleSource(const CycleSource &) = delete;
    CycleSource &operator=(const CycleSource &) = delete;
    virtual ~CycleSource() = default;

    // Not from a servo cycle: may allocate and wait. close() is safe when not open.
    virtual Status open() noexcept = 0;
    virtual void close() noexcept = 0;
    // Each cycle lasts one period exactly, however long it took.
    [[nodiscard]] virtual bool simulated() const noexcept = 0;

    // In each cycle, in this order. next() brings `given` up to date; input.dt_s holds the time that the loop
    // measured. It may set `step` to another state. False: there is no cycle left.
    virtual bool next(CycleGiven &given, ServoStep &step, EventLog &events) noexcept = 0;
    virtual Status write(const DriveCommand &drive) noexcept = 0;
    // Between write() and finish(): what a game sees in place of the step's snapshot. Null: the step's snapshot.
    virtual const ServoSnapshot *shown(const ServoSnapshot & /*snapshot*/) noexcept {
        return nullptr;
    }
    virtual void finish(const ServoSnapshot &snapshot, const DriveCommand &drive,
                        double dt_s) noexcept = 0;

    // What follows has a meaning for devices only.
    // Before the first cycle. threaded: cycles come in real time, from a thread of the loop's own.
    virtual Status begin(bool /*threaded*/) noexcept { return Status::ok; }
    // After the last cycle.
    virtual void motors_off() noexcept {}
    // As Transport::wait_report().
    [[nodiscard]] virtual bool wait_report(std::int64_t /*until_ns*/) noexcept { return false; }
    // What a game wants. From the controlling thread; the newest command wins. Wait-free.
    virtual void publish(const HapticCommand & /*command*/) noexcept {}
    // Before a start: the newest published command, of which nothing acts any more but a panic stop that still holds.
    virtual void restart(HapticCommand & /*command*/) noexcept {}
    // Once open, before the first cycle. True: `step` is as it was before that cycle, which a game may see.
    virtual bool recall(ServoStep & /*step*/) noexcept { return false; }
    // As Transport::device_name(), once open.
    [[nodiscard]] virtual std::string device_name() const { return {}; }
    // Motors off as soon as can be, and in every later run too until the fault is cleared. From any thread, one atomic.
    virtual void panic() noexcept {}
};

} // namespace spidar
