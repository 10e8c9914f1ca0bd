// The border to a device: encoder counts in, motor currents out. One thread owns a transport; only write() of
// one that says write_may_block() may run in a second thread at the same time.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "core/base/status.h"
#include "core/base/types.h"

namespace spidar {

struct DeviceReading {
    CountArray counts{};
    std::uint64_t device_time_us = 0; // the device's own clock; 0 when it has none
    std::uint16_t sequence = 0;
    std::uint8_t buttons = 0;
    // False: the counts have no reference yet (a real device before it was zeroed, or plugged in anew).
    bool zeroed = true;
    // Good reports that came in since the reading before and were overtaken by this one: not lost.
    std::uint16_t overtaken = 0;
    // ok, or why the device cannot pull: its emergency stop, watchdog, supply, encoders, temperature.
    Status device_status = Status::ok;
    std::uint8_t fault_strings = 0; // bit i: string i, where an encoder fault says which
    // What else is wired to the device, such as a pressure sensor in the grip, in its own units. 0 where there is nothing.
    std::array<std::int16_t, kSensorCount> sensors{};
};

// What a cycle sends. Both forms, so that a device may take either: tensions after the tension gain, and
// the motor currents that MotorCalibration makes of them.
struct DriveCommand {
    StringArray tensions_n{};
    StringArray currents_a{};
    bool motors_on = false; // false: currents are zero and the device may cut power
    bool clear_faults =
        false; // acts only with motors_on false: the device may forget latched faults
};

// What a servo cycle takes in from outside, beside the game's command.
struct CycleInput {
    DeviceReading reading; // stays what it was when nothing new came
    double dt_s = 0.001;
    Status read_status = Status::ok;
    Status write_status = Status::ok; // of what this cycle sends: for ServoStep::report_write()
    bool may_arm_itself = false;
};

class Transport {
public:
    Transport() = default;
    Transport(const Transport &) = delete;
    Transport &operator=(const Transport &) = delete;
    virtual ~Transport() = default;

    // Opens the device. Never called from a servo step: it may allocate and wait.
    virtual Status open() noexcept = 0;
    // Switches the motors off, then closes the operating system's handle. Does nothing when not open. Like open(), it may
    // wait.
    virtual void close() noexcept = 0;

    // The newest reading. read_timeout: nothing new (reading untouched); read_failed: device lost.
    virtual Status read(DeviceReading &reading) noexcept = 0;
    virtual Status write(const DriveCommand &command) noexcept = 0;

    // write() waits for the device, for seconds if that hangs: keep it out of the loop's thread.
    [[nodiscard]] virtual bool write_may_block() const noexcept { return false; }

    // Waits for the next report, until this instant of monotonic_ns() at the latest, and leaves it to read(). False at
    // once: this device cannot clock the loop. True: a report waits, or the time is up.
    [[nodiscard]] virtual bool wait_report(std::int64_t until_ns) noexcept {
        (void)until_ns;
        return false;
    }

    // Under which name this device's motors are known while it is open, whoever opens it: its serial number, or its place.
    // Empty: its motors are new each time, as those of a simulated device are.
    [[nodiscard]] virtual std::string device_name() const { return {}; }

    // Simulated devices move on by this much time, once a servo cycle. Real ones ignore it.
    virtual void advance(double dt_s) noexcept { (void)dt_s; }
    // A simulated device may arm itself when forces are enabled; a real one arms only on arm().
    [[nodiscard]] virtual bool simulated() const noexcept { return false; }
};

} // namespace spidar
