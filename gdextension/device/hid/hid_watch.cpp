#include "device/hid/hid_watch.h"

#include <algorithm>
#include <exception>
#include <system_error>
#include <utility>

#include "device/contract/device_claims.h"
#include "device/hid/open_free_device.h"

namespace spidar {

namespace {

bool contains(const std::vector<HidDeviceInfo> &devices, const HidDeviceInfo &wanted) {
    return std::any_of(devices.begin(), devices.end(), [&wanted](const HidDeviceInfo &one) {
        return one.path == wanted.path && one.serial == wanted.serial;
    });
}

} // namespace

HidWatch::HidWatch(std::shared_ptr<HidBus> bus, HidDeviceFilter filter,
                   std::vector<HidDeviceInfo> known, std::chrono::milliseconds period)
    : bus_(std::move(bus)), filter_(std::move(filter)), period_(period), known_(std::move(known)) {
    try {
        thread_ = std::thread([this] { run(); });
    } catch (const std::system_error &) { // later devices are not found
        stop_ = true;
    }
}

HidWatch::~HidWatch() {
    {
        const std::lock_guard<std::mutex> lock(mutex_);
        stop_ = true;
    }
    wake_.notify_all();
    if (thread_.joinable()) {
        thread_.join();
    }
}

void HidWatch::run() {
    std::unique_lock<std::mutex> lock(mutex_);
    while (!wake_.wait_for(lock, period_, [this] { return stop_; })) {
        lock.unlock();
        try {
            if (look()) {
                found_.store(true);
                return;
            }
        } catch (const std::exception &) { // no memory: tried again at the next look
            known_.clear();
        }
        lock.lock();
    }
}

bool HidWatch::look() {
    std::vector<HidDeviceInfo> now;
    if (!usable(find_devices(*bus_, filter_, now))) {
        known_.clear();
        return false;
    }
    // A device that was unplugged counts as new when it returns.
    std::erase_if(known_, [&now](const HidDeviceInfo &one) { return !contains(now, one); });
    return std::any_of(now.begin(), now.end(), [this](const HidDeviceInfo &one) {
        return !contains(known_, one) && DeviceClaim::owner_of(claim_name(one)).empty();
    });
}

} // namespace spidar
