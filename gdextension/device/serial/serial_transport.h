// A SPIDAR behind serial motor boards (docs/reference/serial_boards.md): one to eight of them on a bus of 2 Mbit/s. read() is for the
// servo loop's thread and never waits; write() waits no longer than kLongestWrite_ms and may run in a thread of its own.
// Each write asks all boards and gives them their currents; the next read finds the counts that they answered with. The
// motors pull only while a guard runs that switches them off when this process dies. A device that is unplugged is looked
// for every 100 ms; its counts are never zeroed.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "device/contract/transport.h"
#include "device/serial/motor_table.h"
#include "device/serial/protocol/count_step.h"
#include "device/serial/serial_statistics.h"

namespace spidar {

struct SerialTransportSettings {
    std::string port; // of the system; empty: the only port of a USB bridge
    std::uint32_t baud = kBoardBaud;
    bool motors_in_order = true; // then only the signs of `motors` count; else it is the table
    SerialMotorTable motors{};
    double units_per_a = kUsualUnitsPerAmpere; // of the boards' currents
    int most_units =
        1024; // B5M: 100 % of its driver's reference. It keeps no limit of its own in this mode.
    CountLimits counts;
    std::string guard; // its program; empty: beside the add-on's library
};

class SerialTransport final : public Transport {
public:
    static constexpr int kLongestWrite_ms = 15;

    explicit SerialTransport(const SerialTransportSettings &settings);
    ~SerialTransport() override;

    // no_device, no_permission, device_in_use, protocol_mismatch, invalid_settings, open_failed. One that was opened and
    // not read yet stays open. Opens without a guard too:
    // then readings come, and say device_watchdog, so that nothing arms.
    Status open() noexcept override;
    // The same; ends early with open_failed once another thread sets `give_up`.
    Status open_unless(const std::atomic<bool> &give_up) noexcept;
    // Between open() and the first read(): asks the boards once, so that they are not taken for lost, and keeps what
    // they answer for that read().
    void keep_asking() noexcept;
    void close() noexcept override;
    Status read(DeviceReading &reading) noexcept override;
    Status write(const DriveCommand &command) noexcept override;
    [[nodiscard]] bool write_may_block() const noexcept override { return true; }
    [[nodiscard]] std::string device_name() const override;
    // As chosen; empty while it is not open.
    [[nodiscard]] std::string port() const;

    // From the controlling thread.
    [[nodiscard]] std::vector<BoardLayout> boards() const;
    // How often the wire lets all boards be asked (unit: Hz). A loop that is faster leaves commands out, and counts them.
    [[nodiscard]] double highest_rate_hz() const;
    // From counts being taken to the currents made from them acting, for a loop of this rate (unit: s). Measured whenever the
    // boards are found; 0 while it is not known.
    [[nodiscard]] double latency_s(double rate_hz) const;
    // Why open() failed; empty after a success.
    [[nodiscard]] std::string problem() const;
    // What works, but not as it should: no guard, a slow bridge, encoders that are not read. Empty: nothing.
    [[nodiscard]] std::string remarks() const;
    [[nodiscard]] int guard_process() const noexcept; // -1: none
    // From any thread.
    [[nodiscard]] SerialCounters counters() const noexcept;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace spidar
