// Interface to the system's HID access: hidapi implements it in the add-on, a model in tests.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/base/status.h"

namespace spidar {

struct HidDeviceInfo {
    std::string path; // system path; may change with every plug-in
    std::uint16_t vendor_id = 0;
    std::uint16_t product_id = 0;
    std::uint16_t usage_page = 0; // 0: the system does not report it
    std::string serial;
    std::string product;
};

// A handle on an open device; the destructor closes the handle. Only one thread at a time may use a
// handle. Different threads may use different handles on one device.
class HidHandle {
public:
    HidHandle() = default;
    HidHandle(const HidHandle &) = delete;
    HidHandle &operator=(const HidHandle &) = delete;
    virtual ~HidHandle() = default;

    // Reads the next input report with its id. Returns its length, 0 when none arrives within
    // timeout_ms (0: no waiting), or -1 when the device is gone or fails.
    virtual int read(std::span<std::uint8_t> bytes, int timeout_ms) noexcept = 0;
    // Writes an output report, id first. Returns its length or -1. May block for seconds.
    virtual int write(std::span<const std::uint8_t> bytes) noexcept = 0;
    // Reads the feature report whose id is bytes[0]. Returns its length or -1. May block.
    virtual int get_feature(std::span<std::uint8_t> bytes) noexcept = 0;
    // Sends the feature report whose id is bytes[0]. Returns its length or -1. May block.
    virtual int send_feature(std::span<const std::uint8_t> bytes) noexcept = 0;
};

class HidBus {
public:
    HidBus() = default;
    HidBus(const HidBus &) = delete;
    HidBus &operator=(const HidBus &) = delete;
    virtual ~HidBus() = default;

    // Lists all HID devices. Returns ok, or hid_unavailable when the system's HID access does not
    // start.
    virtual Status enumerate(std::vector<HidDeviceInfo> &devices) = 0;
    // Opens a handle. On failure returns null, with no_permission, open_failed or hid_unavailable
    // in `status`.
    virtual std::unique_ptr<HidHandle> open(const std::string &path, Status &status) = 0;
    // Monotonic clock (unit: us).
    [[nodiscard]] virtual std::uint64_t now_us() noexcept = 0;
};

// Returns the HID access through hidapi, which all transports of the process share.
[[nodiscard]] std::shared_ptr<HidBus> system_hid_bus();

} // namespace spidar
