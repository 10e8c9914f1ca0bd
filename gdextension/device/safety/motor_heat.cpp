#include "device/safety/motor_heat.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>

namespace spidar {

namespace {

// Smallest heat that is kept: a thousandth of the budget has no effect.
constexpr double kCold = 1e-3;
constexpr double kSecond_ns = 1e9;

struct Warm {
    StringArray heat{};
    double thermal_time_s = 0.0;
    std::int64_t at_ns = 0;

    [[nodiscard]] StringArray cooled(std::int64_t now_ns) const {
        const double passed_s =
            static_cast<double>(std::max<std::int64_t>(0, now_ns - at_ns)) / kSecond_ns;
        const double left = std::exp(-passed_s / thermal_time_s);
        StringArray now{};
        for (std::size_t i = 0; i < now.size(); ++i) {
            now[i] = left * heat[i];
        }
        return now;
    }
};

struct Memory {
    std::mutex mutex;
    std::map<std::string, Warm> devices;
};

// Never destroyed: a static loop may stop after main().
Memory &memory() {
    static Memory *const kept = new Memory;
    return *kept;
}

bool is_cold(const StringArray &heat) {
    return std::all_of(heat.begin(), heat.end(), [](double share) { return share < kCold; });
}

} // namespace

void keep_motor_heat(const std::string &device, const StringArray &heat, double thermal_time_s,
                     std::int64_t now_ns) {
    if (device.empty()) {
        return;
    }
    Memory &all = memory();
    const std::lock_guard<std::mutex> lock(all.mutex);
    all.devices[device] = {heat, thermal_time_s, now_ns};
    std::erase_if(all.devices,
                  [now_ns](const auto &entry) { return is_cold(entry.second.cooled(now_ns)); });
}

StringArray recall_motor_heat(const std::string &device, std::int64_t now_ns) {
    Memory &all = memory();
    const std::lock_guard<std::mutex> lock(all.mutex);
    const auto found = all.devices.find(device);
    return found == all.devices.end() ? StringArray{} : found->second.cooled(now_ns);
}

} // namespace spidar
