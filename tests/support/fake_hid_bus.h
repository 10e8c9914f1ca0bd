// A HID system of firmware models, in simulated time: plugs and unplugs, queues like the kernel's, hangs and fails.
#pragma once

#include <algorithm>
#include <atomic>
#include <deque>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "device/hid/hid_bus.h"
#include "hid/firmware_model.h"

namespace spidar::test {

struct FakeDevice {
    HidDeviceInfo info;
    FirmwareModel firmware;
    bool plugged = true;
    bool permitted = true;
    // As Windows does: a feature report is read into a buffer for the longest one, and all of it counts as read.
    bool wants_largest_buffer = false;
    std::atomic<bool> writes_hang{false};
    std::atomic<bool> write_hangs{false}; // one does just now
    std::uint32_t generation = 0;         // counts plug-ins: handles of an earlier one are dead
    std::mutex mutex;
    std::vector<std::deque<std::vector<std::uint8_t>>> queues; // one a handle
    std::vector<bool> queue_open;
};

class FakeHidHandle final : public HidHandle {
public:
    explicit FakeHidHandle(std::shared_ptr<FakeDevice> device) : device_(std::move(device)) {
        const std::lock_guard<std::mutex> lock(device_->mutex);
        generation_ = device_->generation;
        index_ = device_->queues.size();
        device_->queues.emplace_back();
        device_->queue_open.push_back(true);
    }
    ~FakeHidHandle() override {
        const std::lock_guard<std::mutex> lock(device_->mutex);
        device_->queue_open[index_] = false;
    }
    int read(std::span<std::uint8_t> bytes, int /*timeout_ms*/) noexcept override {
        const std::lock_guard<std::mutex> lock(device_->mutex);
        if (dead()) {
            return -1;
        }
        auto &queue = device_->queues[index_];
        if (queue.empty()) {
            return 0;
        }
        const std::vector<std::uint8_t> report = queue.front();
        queue.pop_front();
        const std::size_t size = std::min(report.size(), bytes.size());
        std::copy_n(report.begin(), size, bytes.begin());
        return static_cast<int>(size);
    }
    int write(std::span<const std::uint8_t> bytes) noexcept override {
        while (device_->writes_hang.load()) {
            device_->write_hangs.store(true);
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
        const std::lock_guard<std::mutex> lock(device_->mutex);
        if (dead()) {
            return -1;
        }
        device_->firmware.receive(bytes);
        return static_cast<int>(bytes.size());
    }
    int get_feature(std::span<std::uint8_t> bytes) noexcept override {
        const std::lock_guard<std::mutex> lock(device_->mutex);
        std::array<std::uint8_t, kLargestReport> report{};
        const std::size_t size = device_->firmware.get_feature(bytes[0], report);
        if (dead() || size == 0 || size > bytes.size()) {
            return -1;
        }
        if (device_->wants_largest_buffer && bytes.size() < kLargestReport) {
            return -1;
        }
        std::copy_n(report.begin(), size, bytes.begin());
        return static_cast<int>(device_->wants_largest_buffer ? kLargestReport : size);
    }
    int send_feature(std::span<const std::uint8_t> bytes) noexcept override {
        const std::lock_guard<std::mutex> lock(device_->mutex);
        return !dead() && device_->firmware.set_feature(bytes) ? static_cast<int>(bytes.size())
                                                               : -1;
    }

private:
    [[nodiscard]] bool dead() const {
        return !device_->plugged || generation_ != device_->generation;
    }
    std::shared_ptr<FakeDevice> device_;
    std::uint32_t generation_ = 0;
    std::size_t index_ = 0;
};

class FakeHidBus final : public HidBus {
public:
    std::shared_ptr<FakeDevice> add(const std::string &serial,
                                    const std::string &product = "SPIDAR-G model") {
        auto device = std::make_shared<FakeDevice>();
        device->info = {"path/" + serial, 0x1209, 0x0001, kHidUsagePage, serial, product};
        const std::lock_guard<std::mutex> lock(mutex_);
        devices_.push_back(device);
        return device;
    }
    Status enumerate(std::vector<HidDeviceInfo> &found) override {
        found.clear();
        const std::lock_guard<std::mutex> lock(mutex_);
        if (!available) {
            return Status::hid_unavailable;
        }
        for (const auto &device : devices_) {
            const std::lock_guard<std::mutex> device_lock(device->mutex);
            if (device->plugged) {
                found.push_back(device->info);
            }
        }
        return Status::ok;
    }
    std::unique_ptr<HidHandle> open(const std::string &path, Status &status) override {
        const std::lock_guard<std::mutex> lock(mutex_);
        for (const auto &device : devices_) {
            std::unique_lock<std::mutex> device_lock(device->mutex);
            if (device->info.path == path) {
                device_lock.unlock();
                status = device->permitted ? Status::ok : Status::no_permission;
                return device->permitted ? std::make_unique<FakeHidHandle>(device) : nullptr;
            }
        }
        status = Status::open_failed;
        return nullptr;
    }
    std::uint64_t now_us() noexcept override { return now_us_.load(); }

    // One millisecond: every device ticks and reports.
    void tick() {
        now_us_.fetch_add(1000);
        const std::lock_guard<std::mutex> lock(mutex_);
        for (const auto &device : devices_) {
            const std::lock_guard<std::mutex> device_lock(device->mutex);
            if (device->plugged) {
                device->firmware.advance(1000);
                const auto report = device->firmware.report();
                push(*device, {report.begin(), report.end()});
            }
        }
    }
    // Any bytes, as if the device had sent them.
    static void push(FakeDevice &device, const std::vector<std::uint8_t> &report) {
        constexpr std::size_t kKernelQueue = 64;
        for (std::size_t i = 0; i < device.queues.size(); ++i) {
            if (device.queue_open[i] && device.queues[i].size() < kKernelQueue) {
                device.queues[i].push_back(report);
            }
        }
    }
    void inject(FakeDevice &device, const std::vector<std::uint8_t> &report) {
        const std::lock_guard<std::mutex> lock(device.mutex);
        push(device, report);
    }
    static void unplug(FakeDevice &device) {
        const std::lock_guard<std::mutex> lock(device.mutex);
        device.plugged = false;
        device.firmware.bus_reset();
    }
    static void plug(FakeDevice &device, const std::string &path) {
        const std::lock_guard<std::mutex> lock(device.mutex);
        device.info.path = path;
        ++device.generation;
        device.plugged = true;
    }
    bool available = true;

private:
    std::mutex mutex_;
    std::vector<std::shared_ptr<FakeDevice>> devices_;
    std::atomic<std::uint64_t> now_us_{1'000'000};
};

} // namespace spidar::test
