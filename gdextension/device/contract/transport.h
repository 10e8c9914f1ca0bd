// The interface to a device: encoder counts in, motor currents out. One thread owns a transport.
// Only write(), and only when write_may_block() is true, may run in a second thread at the same
// time.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "core/base/status.h"
#include "core/base/types.h"

namespace spidar {

struct DeviceReading {
    CountArray counts{};
    std::uint64_t device_time_us = 0; // clock of the device; 0 when it has none
    std::uint16_t sequence = 0;
    std::uint8_t buttons = 0;
    // False: the device has no reference for its counts. A USB device reports this before it is
    // zeroed and after it was plugged in again; serial boards always do, and the servo step keeps
    // their zero.
    bool zeroed = true;
    // Number of valid reports that arrived since the last reading, before this one, and were not
    // read. They do not count as lost.
    std::uint16_t overtaken = 0;
    // ok, or why the device cannot pull: emergency stop, watchdog, supply, encoders or temperature.
    Status device_status = Status::ok;
    // Bit i: string i, when an encoder fault names strings.
    std::uint8_t fault_strings = 0;
    // Other sensors, such as grip pressure, in their own units. 0 when there is none.
    std::array<std::int16_t, kSensorCount> sensors{};
};

// What a cycle sends. A device may use either of two forms: the tensions divided by
// MotorCalibration::tension_gain, or the motor currents for the same tensions.
struct DriveCommand {
    StringArray tensions_n{};
    StringArray currents_a{};
    // False: currents are zero and the device may cut the motors' power.
    bool motors_on = false;
    // True: the device may clear its latched faults. It has effect only if motors_on is false.
    bool clear_faults = false;
};

// Input of a servo cycle besides the game's command.
struct CycleInput {
    // Unchanged when no new reading arrived.
    DeviceReading reading;
    double dt_s = 0.001;
    Status read_status = Status::ok;
    // Status of writing this cycle's command, for ServoStep::report_write().
    Status write_status = Status::ok;
    bool may_arm_itself = false;
};

class Transport {
public:
    Transport() = default;
    Transport(const Transport &) = delete;
    Transport &operator=(const Transport &) = delete;
    virtual ~Transport() = default;

    // Opens the device. May allocate and wait: never call it from a servo step.
    virtual Status open() noexcept = 0;
    // Switches the motors off, then closes the handle. Does nothing when not open. May wait.
    virtual void close() noexcept = 0;

    // Reads the newest report. Returns read_timeout and leaves `reading` unchanged when there is no
    // new one, and read_failed when the device is lost.
    virtual Status read(DeviceReading &reading) noexcept = 0;
    virtual Status write(const DriveCommand &command) noexcept = 0;

    // True: write() may wait for the device for seconds and must not run in the loop's thread.
    [[nodiscard]] virtual bool write_may_block() const noexcept { return false; }

    // Waits until a report has arrived, which read() then reads, or until monotonic_ns() reaches
    // until_ns, and returns true. A device that cannot clock the loop returns false at once.
    [[nodiscard]] virtual bool wait_report(std::int64_t until_ns) noexcept {
        (void)until_ns;
        return false;
    }

    // Name under which the heat of the device's motors is stored while it is open: serial number or
    // path. Empty: the motors start cold each time, as those of a simulated device do.
    [[nodiscard]] virtual std::string device_name() const { return {}; }

    // Advances a simulated device by this time, once per servo cycle. Real devices ignore it.
    virtual void advance(double dt_s) noexcept { (void)dt_s; }
    // True for a simulated device, which may arm itself when forces are on. Real ones need arm().
    [[nodiscard]] virtual bool simulated() const noexcept { return false; }
};

} // namespace spidar
