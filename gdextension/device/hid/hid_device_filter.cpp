#include "device/hid/hid_device_filter.h"

#include <algorithm>

#include "device/hid/protocol/hid_protocol.h"

namespace spidar {

namespace {

// Ids of Microchip's generic HID demonstration, which many unrelated boards use.
constexpr std::uint16_t kSharedVendor = 0x04D8;
constexpr std::uint16_t kSharedProduct = 0x003F;

} // namespace

bool matches(const HidDeviceFilter &filter, const HidDeviceInfo &device) {
    const auto is = [](auto wanted, auto value) { return wanted == 0 || wanted == value; };
    const bool shared = device.vendor_id == kSharedVendor && device.product_id == kSharedProduct;
    return !shared && is(filter.vendor_id, device.vendor_id) &&
           is(filter.product_id, device.product_id) &&
           (device.usage_page == 0 || device.usage_page == kHidUsagePage) &&
           (filter.serial.empty() || filter.serial == name_of(device)) &&
           (filter.path.empty() || filter.path == device.path) &&
           device.product.compare(0, filter.product.size(), filter.product) == 0;
}

const std::string &name_of(const HidDeviceInfo &device) noexcept {
    return device.serial.empty() ? device.path : device.serial;
}

std::string claim_name(const HidDeviceInfo &device) {
    const std::string &name = name_of(device);
    return name.empty() ? std::string() : "hid:" + name;
}

Status find_devices(HidBus &bus, const HidDeviceFilter &filter, std::vector<HidDeviceInfo> &found) {
    found.clear();
    std::vector<HidDeviceInfo> all;
    const Status status = bus.enumerate(all);
    if (!usable(status)) {
        return status;
    }
    for (const HidDeviceInfo &device : all) {
        const bool known = std::any_of(found.begin(), found.end(), [&](const HidDeviceInfo &one) {
            return one.path == device.path;
        });
        if (!known && matches(filter, device)) {
            found.push_back(device);
        }
    }
    std::sort(found.begin(), found.end(), [](const HidDeviceInfo &a, const HidDeviceInfo &b) {
        return a.serial != b.serial ? a.serial < b.serial : a.path < b.path;
    });
    return found.empty() ? Status::no_device : Status::ok;
}

std::string validate(const HidDeviceFilter &filter) {
    if (filter.product.empty() && filter.serial.empty()) {
        return "device_product = \"\": give the beginning of the device's product string, or set "
               "device_serial; many boards share one vendor and product number.";
    }
    return {};
}

} // namespace spidar
