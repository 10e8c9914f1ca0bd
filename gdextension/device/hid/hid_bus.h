// The system's HID access as HidTransport needs it: hidapi in the add-on, a model of it in tests.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/base/status.h"

namespace spidar {

struct HidDeviceInfo {
    std::string path; // of the system; may change with every plug-in
    std::uint16_t vendor_id = 0;
    std::uint16_t product_id = 0;
    std::uint16_t usage_page = 0; // 0: the system does not tell
    std::string serial;
    std::string product;
};

// An open device. One thread at a time; several handles on one device, each used by its own thread, are fine.
// Closed by its destructor.
class HidHandle {
public:
    HidHandle() = default;
    HidHandle(const HidHandle &) = delete;
    HidHandle &operator=(const HidHandle &) = delete;
    virtual ~HidHandle() = default;

    // The next input report with its id: its length, 0 when none comes within the time (0: no waiting), -1 when the
    // device is gone.
    virtual int read(std::span<std::uint8_t> bytes, int timeout_ms) noexcept = 0;
    // An output report that begins with its id: its length, or -1. May block for seconds.
    virtual int write(std::span<const std::uint8_t> bytes) noexcept = 0;
    // A feature report whose id is bytes[0]: its length, or -1. May block.
    virtual int get_feature(std::span<std::uint8_t> bytes) noexcept = 0;
    virtual int send_feature(std::span<const std::uint8_t> bytes) noexcept = 0;
};

class HidBus {
public:
    HidBus() = default;
    HidBus(const HidBus &) = delete;
    HidBus &operator=(const HidBus &) = delete;
    virtual ~HidBus() = default;

    // All HID devices now plugged in. hid_unavailable when the system's HID access does not start.
    virtual Status enumerate(std::vector<HidDeviceInfo> &devices) = 0;
    // Null on failure, with the reason: no_permission, open_failed, hid_unavailable.
    virtual std::unique_ptr<HidHandle> open(const std::string &path, Status &status) = 0;
    // A clock that never goes back (unit: us).
    [[nodiscard]] virtual std::uint64_t now_us() noexcept = 0;
};

// The system's own, through hidapi; shared by all transports of the process.
[[nodiscard]] std::shared_ptr<HidBus> system_hid_bus();

} // namespace spidar
