// A SPIDAR behind one to eight serial motor boards on a bus, normally of 2 Mbit/s
// (docs/reference/serial_boards.md). read() belongs to the servo loop's thread and does not wait
// for bytes. write() waits at most kLongestWrite_ms and may run in a second thread. A write sends
// currents to all boards unless the wire is still busy. The boards reply with their counts, which a
// later read() returns. The motors pull only while a guard process runs, which switches them off
// when this process dies. After a loss, a thread looks for the device every 100 ms. The boards
// cannot zero the counts.
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
    // True: strings 1 to 8 belong to the motors in the order of the boards' ids, and `motors`
    // gives only the signs. False: `motors` is the whole table.
    bool motors_in_order = true;
    SerialMotorTable motors{};
    double units_per_a = kUsualUnitsPerAmpere; // board units of current per ampere
    // Largest current in board units. A B5M does not limit the currents of CURRENT itself; 1024 is
    // 100 % of its driver's reference.
    int most_units = 1024;
    CountLimits counts;
    std::string guard; // path of the guard's program; empty: guard_beside_library()
};

class SerialTransport final : public Transport {
public:
    static constexpr int kLongestWrite_ms = 15;

    explicit SerialTransport(const SerialTransportSettings &settings);
    ~SerialTransport() override;

    // Returns ok, or no_device, no_permission, device_in_use, protocol_mismatch, invalid_settings
    // or open_failed. Returns ok at once if the device is open and read() was not called yet. If
    // the guard does not start, the device opens all the same: each reading then reports
    // device_watchdog, so that nothing arms.
    Status open() noexcept override;
    // Like open(); ends early, usually with protocol_mismatch, once another thread sets `give_up`.
    Status open_unless(const std::atomic<bool> &give_up) noexcept;
    // Called repeatedly between open() and the first read(): sends zero currents, so that the
    // boards reply and do not count as lost, and keeps the newest reading for read().
    void keep_asking() noexcept;
    void close() noexcept override;
    Status read(DeviceReading &reading) noexcept override;
    Status write(const DriveCommand &command) noexcept override;
    [[nodiscard]] bool write_may_block() const noexcept override { return true; }
    [[nodiscard]] std::string device_name() const override;
    // Returns the path of the chosen port; empty while the transport is closed.
    [[nodiscard]] std::string port() const;

    // Called from the thread that opens and closes, like the functions up to guard_process().
    [[nodiscard]] std::vector<BoardLayout> boards() const;
    // Highest rate of the servo loop that the wire allows (unit: Hz). In a faster loop, write()
    // drops commands and counts them (SerialCounters::postponed).
    [[nodiscard]] double highest_rate_hz() const;
    // Estimated time from the sampling of counts to the currents computed from them, for a servo
    // loop of rate_hz (unit: s). From a measurement when the boards were found; 0: unknown.
    [[nodiscard]] double latency_s(double rate_hz) const;
    // Returns why open() failed; empty after a success.
    [[nodiscard]] std::string problem() const;
    // Returns problems with which the device still opens: no guard, a slow bridge, encoders that a
    // board does not read. Empty: none.
    [[nodiscard]] std::string remarks() const;
    [[nodiscard]] int guard_process() const noexcept; // -1: no guard
    // Called from any thread.
    [[nodiscard]] SerialCounters counters() const noexcept;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace spidar
