// Decides when a device that stopped itself is commanded to clear its faults: when a new task is
// requested. That task still ends as not_ready; the next one may pull.
#pragma once

#include <algorithm>
#include <cstdint>

namespace spidar {

class FaultClearing {
public:
    // Called once per cycle. task: number of the last requested task. Returns true in the cycles in
    // which the device must be commanded to clear its faults, with the motors off.
    [[nodiscard]] bool step(std::uint32_t task, bool device_is_well) noexcept {
        if (task != asked_for_) {
            asked_for_ = task;
            left_ = device_is_well ? 0 : kCycles;
        }
        left_ = std::max(0, left_ - 1);
        return left_ > 0;
    }

private:
    // Number of cycles for which the request is repeated, since a delayed writer drops commands.
    static constexpr int kCycles = 50;

    std::uint32_t asked_for_ = 0;
    int left_ = 0;
};

} // namespace spidar
