// A USB HID device made by the kernel's gadget driver on its dummy host controller: interrupt endpoints that can be
// left unanswered, which uhid has not. The gadget's HID function cannot answer feature reports, so bus() answers those.
#pragma once

#include <memory>
#include <thread>

#include "device/hid/hid_bus.h"
#include "hid/virtual_device.h"

namespace spidar::test {

class GadgetDevice final : public VirtualDevice {
public:
    GadgetDevice() : VirtualDevice(FirmwareSettings{}) {}
    ~GadgetDevice();
    GadgetDevice(const GadgetDevice &) = delete;
    GadgetDevice &operator=(const GadgetDevice &) = delete;

    // False when the kernel lacks a part. Waits until the host side has its hidraw node.
    bool plug();
    void stop_taking_commands() { take_commands_.store(false); }
    // The system's HID devices, with feature reports going to the firmware model.
    [[nodiscard]] std::shared_ptr<HidBus> bus();

private:
    void run();

    int file_ = -1;
    std::atomic<bool> take_commands_{true};
    std::atomic<bool> stop_{false};
    std::thread thread_;
};

} // namespace spidar::test
