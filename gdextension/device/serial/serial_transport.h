// A SPIDAR behind one to eight serial motor boards on a bus of 2 Mbit/s
// (docs/reference/serial_boards.md). read() belongs to the servo loop's thread and never waits.
// write() waits at most kLongestWrite_ms and may run in a second thread. Each write sends currents
// to all boards, and the next read returns the counts that they answered with. The motors pull only
// while a guard runs, which switches them off when this process dies. An unplugged device is looked
// for every 100 ms. The counts are never zeroed by the device.
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
    std::string port; // system path; empty: the only port of a USB bridge
    std::uint32_t baud = kBoardBaud;
    // True: boards and motors in order, `motors` gives only signs. False: `motors` is the table.
    bool motors_in_order = true;
    SerialMotorTable motors{};
    double units_per_a = kUsualUnitsPerAmpere; // board units of current per ampere
    // Largest current in board units. A B5M has no limit of its own in this mode; 1024 is 100 % of
    // its driver's reference.
    int most_units = 1024;
    CountLimits counts;
    std::string guard; // path of its program; empty: beside the add-on's library
};

class SerialTransport final : public Transport {
public:
    static constexpr int kLongestWrite_ms = 15;

    explicit SerialTransport(const SerialTransportSettings &settings);
    ~SerialTransport() override;

    // Returns no_device, no_permission, device_in_use, protocol_mismatch, invalid_settings or
    // open_failed. Does nothing to a device that was opened and not read yet. Without a guard the
    // device opens too: readings then report device_watchdog, so that nothing arms.
    Status open() noexcept override;
    // Like open(); ends early with open_failed once another thread sets `give_up`.
    Status open_unless(const std::atomic<bool> &give_up) noexcept;
    // Called between open() and the first read(): asks the boards once, so that they do not count
    // as lost, and keeps the answer for read().
    void keep_asking() noexcept;
    void close() noexcept override;
    Status read(DeviceReading &reading) noexcept override;
    Status write(const DriveCommand &command) noexcept override;
    [[nodiscard]] bool write_may_block() const noexcept override { return true; }
    [[nodiscard]] std::string device_name() const override;
    // The chosen port; empty while not open.
    [[nodiscard]] std::string port() const;

    // Called from the controlling thread, like the functions up to guard_process().
    [[nodiscard]] std::vector<BoardLayout> boards() const;
    // Highest rate that the wire allows (unit: Hz). A faster loop drops commands and counts them.
    [[nodiscard]] double highest_rate_hz() const;
    // Estimated time from the sampling of counts to the currents computed from them, for a loop of
    // rate_hz (unit: s). Measured whenever the boards are found; 0 while unknown.
    [[nodiscard]] double latency_s(double rate_hz) const;
    // Returns why open() failed; empty after a success.
    [[nodiscard]] std::string problem() const;
    // Returns problems that do not prevent operation: no guard, a slow bridge, encoders that are
    // not read. Empty: none.
    [[nodiscard]] std::string remarks() const;
    [[nodiscard]] int guard_process() const noexcept; // -1: no guard
    // Called from any thread.
    [[nodiscard]] SerialCounters counters() const noexcept;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace spidar
