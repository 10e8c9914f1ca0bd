// A real device behind USB HID (docs/reference/hid_protocol.md). read() is for the servo loop's thread and never waits; write()
// may block for as long as the device does and may run in a thread of its own. A device that is unplugged is looked
// for every 250 ms by a thread of this transport; plugged in again it is read, but it counts as not zeroed.
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
    // Sent to the device when it is opened; it keeps the stricter of these and its own.
    HidLimits limits{.max_tension_mn = 10000,
                     .tension_rate_mn_ms = 1000,
                     .string_speed_mm_s = 5000,
                     .ramp_in_ms = 100,
                     .min_tension_mn = 300};
    std::uint16_t command_valid_ms = 20;
};

class HidTransport final : public Transport {
public:
    HidTransport(std::shared_ptr<HidBus> bus, const HidTransportSettings &settings);
    // Waits for a write() that still hangs in another thread.
    ~HidTransport() override;

    // no_device, no_permission, protocol_mismatch, open_failed, hid_unavailable.
    Status open() noexcept override;
    // May be called while write() hangs in another thread: then it is not told, and its watchdog stops the motors.
    void close() noexcept override;
    Status read(DeviceReading &reading) noexcept override;
    Status write(const DriveCommand &command) noexcept override;
    [[nodiscard]] bool write_may_block() const noexcept override { return true; }
    [[nodiscard]] bool wait_report(std::int64_t until_ns) noexcept override;
    [[nodiscard]] std::string device_name() const override { return claim_name(device()); }

    // From the controlling thread.
    // The grip is at its home pose and its strings are taut: the encoders are to read `home_counts` here. Refused while
    // the motors are on (write_failed). Readings count as zeroed about 0.1 s later.
    Status zero(const CountArray &home_counts) noexcept;
    [[nodiscard]] HidCapabilities capabilities() const noexcept;
    [[nodiscard]] HidLimits limits() const noexcept; // those that the device keeps
    [[nodiscard]] HidDeviceInfo device() const;
    // Why open() failed, with what was asked for and what was found; empty after a success.
    [[nodiscard]] std::string problem() const;
    // From any thread.
    [[nodiscard]] HidCounters counters() const noexcept;
    [[nodiscard]] HidTimes times() const noexcept;
    // Measured (link_latency_s); 0 while it is not known.
    [[nodiscard]] double latency_s() const noexcept {
        return link_latency_s(times(), capabilities().report_rate_hz);
    }

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace spidar
