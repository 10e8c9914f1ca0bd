// A real device behind USB HID (docs/reference/hid_protocol.md). read() belongs to the servo loop's
// thread and does not wait for a report. write() may block as long as the device does, and may run
// in a second thread. After a loss, a thread looks for the same device every 250 ms. When it is
// plugged in again, its readings count as not zeroed until zero().
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "device/contract/transport.h"
#include "device/hid/hid_bus.h"
#include "device/hid/hid_device_filter.h"
#include "device/hid/hid_statistics.h"
#include "device/hid/protocol/hid_protocol.h"

namespace spidar {

struct HidTransportSettings {
    HidDeviceFilter filter;
    // Sent to the device when it is opened. For each limit, the device keeps the stricter of this
    // value and its own.
    HidLimits limits{.max_tension_mn = 10000,
                     .tension_rate_mn_ms = 1000,
                     .string_speed_mm_s = 5000,
                     .ramp_in_ms = 100,
                     .min_tension_mn = 300};
    // Time after which the device drops a command unless a newer one has replaced it.
    std::uint16_t command_valid_ms = 20;
};

class HidTransport final : public Transport {
public:
    HidTransport(std::shared_ptr<HidBus> bus, const HidTransportSettings &settings);
    // Waits until a write() that blocks in another thread returns.
    ~HidTransport() override;

    // Returns ok, or no_device, no_permission, protocol_mismatch, invalid_settings, open_failed or
    // hid_unavailable.
    Status open() noexcept override;
    // Sends a last command that stops the motors, unless write() blocks in another thread. In that
    // case the device's watchdog stops them.
    void close() noexcept override;
    Status read(DeviceReading &reading) noexcept override;
    Status write(const DriveCommand &command) noexcept override;
    [[nodiscard]] bool write_may_block() const noexcept override { return true; }
    [[nodiscard]] bool wait_report(std::int64_t until_ns) noexcept override;
    [[nodiscard]] std::string device_name() const override { return claim_name(device()); }

    // Sets the encoders to home_counts. Requires the grip at its home pose with taut strings.
    // Returns ok, not_open, or write_failed if the device refuses, as it does while the motors are
    // on. Readings count as zeroed about 0.1 s later. Called, like the next four functions, from
    // the thread that opens and closes.
    Status zero(const CountArray &home_counts) noexcept;
    [[nodiscard]] HidCapabilities capabilities() const noexcept;
    [[nodiscard]] HidLimits limits() const noexcept; // the limits that the device reported back
    [[nodiscard]] HidDeviceInfo device() const;
    // Returns a sentence on why open() failed; empty after a success.
    [[nodiscard]] std::string problem() const;
    // Callable from any thread, like times() and latency_s().
    [[nodiscard]] HidCounters counters() const noexcept;
    [[nodiscard]] HidTimes times() const noexcept;
    // Returns link_latency_s() for this device; 0 while unknown.
    [[nodiscard]] double latency_s() const noexcept {
        return link_latency_s(times(), capabilities().report_rate_hz);
    }

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace spidar
