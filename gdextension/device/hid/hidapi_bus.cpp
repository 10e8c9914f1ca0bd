// HidBus through hidapi. Its library-wide functions are not thread-safe, hence the lock around them.
#include "device/hid/hid_bus.h"

#include <cerrno>
#include <chrono>
#include <cwchar>
#include <mutex>

#include <hidapi/hidapi.h>
#ifndef _WIN32
#include <unistd.h>
#endif

namespace spidar {

namespace {

std::string narrow(const wchar_t *wide) {
    std::string text;
    for (; wide != nullptr && *wide != L'\0'; ++wide) {
        // Names and serials that we look for are ASCII; others need not be readable, only different.
        text += *wide > 0 && *wide < 128 ? static_cast<char>(*wide) : '?';
    }
    return text;
}

class HidapiHandle final : public HidHandle {
public:
    explicit HidapiHandle(hid_device *device) noexcept : device_(device) {}
    ~HidapiHandle() override { hid_close(device_); }

    int read(std::span<std::uint8_t> bytes, int timeout_ms) noexcept override {
        return hid_read_timeout(device_, bytes.data(), bytes.size(), timeout_ms);
    }
    int write(std::span<const std::uint8_t> bytes) noexcept override {
        return hid_write(device_, bytes.data(), bytes.size());
    }
    int get_feature(std::span<std::uint8_t> bytes) noexcept override {
        return hid_get_feature_report(device_, bytes.data(), bytes.size());
    }
    int send_feature(std::span<const std::uint8_t> bytes) noexcept override {
        return hid_send_feature_report(device_, bytes.data(), bytes.size());
    }

private:
    hid_device *device_;
};

class HidapiBus final : public HidBus {
public:
    HidapiBus() : started_(hid_init() == 0) {}

    Status enumerate(std::vector<HidDeviceInfo> &devices) override {
        devices.clear();
        if (!started_) {
            return Status::hid_unavailable;
        }
        const std::lock_guard<std::mutex> lock(mutex_);
        hid_device_info *const first = hid_enumerate(0, 0);
        for (const hid_device_info *entry = first; entry != nullptr; entry = entry->next) {
            HidDeviceInfo info;
            info.path = entry->path != nullptr ? entry->path : "";
            info.vendor_id = entry->vendor_id;
            info.product_id = entry->product_id;
            info.usage_page = entry->usage_page;
            info.serial = narrow(entry->serial_number);
            info.product = narrow(entry->product_string);
            devices.push_back(info);
        }
        hid_free_enumeration(first);
        return Status::ok;
    }

    std::unique_ptr<HidHandle> open(const std::string &path, Status &status) override {
        if (!started_) {
            status = Status::hid_unavailable;
            return nullptr;
        }
        const std::lock_guard<std::mutex> lock(mutex_);
        hid_device *const device = hid_open_path(path.c_str());
        if (device != nullptr) {
            status = Status::ok;
            return std::make_unique<HidapiHandle>(device);
        }
        status = Status::open_failed;
#ifndef _WIN32
        if (access(path.c_str(), R_OK | W_OK) != 0 && (errno == EACCES || errno == EPERM)) {
            status = Status::no_permission;
        }
#endif
        return nullptr;
    }

    std::uint64_t now_us() noexcept override {
        const auto now = std::chrono::steady_clock::now().time_since_epoch();
        return static_cast<std::uint64_t>(
            std::chrono::duration_cast<std::chrono::microseconds>(now).count());
    }

private:
    const bool started_;
    std::mutex mutex_;
};

} // namespace

std::shared_ptr<HidBus> system_hid_bus() {
    // Never destroyed: a handle may be closed while the process ends, and hid_exit() is not needed for that.
    static const auto *const kept = new std::shared_ptr<HidBus>(std::make_shared<HidapiBus>());
    return *kept;
}

} // namespace spidar
