// When a device that stopped itself is told to clear its faults: it stays off until somebody asks for a task again. That
// task finds it not ready, the next one may pull.
#pragma once

#include <algorithm>
#include <cstdint>

namespace spidar {

class FaultClearing {
public:
    // Once a cycle. task: number of the task asked for last. True: the device is to clear its faults, with the motors off.
    [[nodiscard]] bool step(std::uint32_t task, bool device_is_well) noexcept {
        if (task != asked_for_) {
            asked_for_ = task;
            left_ = device_is_well ? 0 : kCycles;
        }
        left_ = std::max(0, left_ - 1);
        return left_ > 0;
    }

private:
    // A writer that is behind leaves commands out; so many are not.
    static constexpr int kCycles = 50;

    std::uint32_t asked_for_ = 0;
    int left_ = 0;
};

} // namespace spidar
