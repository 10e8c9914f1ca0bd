// Looks for devices that are plugged in later. It does so in a thread, since listing devices may
// take many milliseconds.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "device/hid/hid_bus.h"
#include "device/hid/hid_device_filter.h"

namespace spidar {

class HidWatch {
public:
    // known: devices that were already tried. They are skipped while they stay plugged in.
    HidWatch(std::shared_ptr<HidBus> bus, HidDeviceFilter filter, std::vector<HidDeviceInfo> known,
             std::chrono::milliseconds period = std::chrono::milliseconds(500));
    ~HidWatch();
    HidWatch(const HidWatch &) = delete;
    HidWatch &operator=(const HidWatch &) = delete;

    // True once a matching device has been seen that is not in `known` and that nobody in this
    // process has claimed. The search then ends.
    [[nodiscard]] bool found() const noexcept { return found_.load(); }

private:
    void run();
    [[nodiscard]] bool look();

    const std::shared_ptr<HidBus> bus_;
    const HidDeviceFilter filter_;
    const std::chrono::milliseconds period_;
    std::vector<HidDeviceInfo> known_; // used by the thread only
    std::atomic<bool> found_{false};
    std::mutex mutex_;
    std::condition_variable wake_;
    bool stop_ = false;
    std::thread thread_;
};

} // namespace spidar
