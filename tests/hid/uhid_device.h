// A virtual HID device of the Linux kernel (/dev/uhid) with the firmware model inside: what /dev/hidraw shows of it is
// what it would show of hardware.
#pragma once

#include <span>
#include <string>
#include <thread>

#include "hid/virtual_device.h"

namespace spidar::test {

struct UhidOptions {
    std::string product = "SPIDAR-G model";
    std::string serial = "VM-1";
    // Numbers that are set aside for tests.
    std::uint16_t vendor_id = 0x1209;
    std::uint16_t product_id = 0x0001;
    FirmwareSettings firmware{};
};

class UhidDevice final : public VirtualDevice {
public:
    explicit UhidDevice(UhidOptions options);
    ~UhidDevice();
    UhidDevice(const UhidDevice &) = delete;
    UhidDevice &operator=(const UhidDevice &) = delete;

    // False when the kernel has no /dev/uhid, or refuses.
    bool plug();
    void unplug();
    [[nodiscard]] std::int64_t unplugged_ns() const { return unplugged_ns_; }

private:
    void run();
    void handle_event();
    bool send(const void *event, std::size_t size) const;

    UhidOptions options_;
    int uhid_ = -1;
    int timer_ = -1;
    std::int64_t unplugged_ns_ = 0;
    std::atomic<bool> stop_{false};
    std::thread thread_;
};

} // namespace spidar::test
