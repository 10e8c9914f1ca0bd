// Converts game ticks to whole servo cycles of simulated time, exactly: 1/60 s does not drift.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace spidar {

class TickAccumulator {
public:
    // Largest result of cycles(), 17 minutes at 1 kHz. More is a mistake: the rest is dropped.
    static constexpr std::uint64_t kMostCyclesAtOnce = 1'000'000;

    void restart(double rate_hz) noexcept {
        // The rate as a fraction of whole millihertz keeps the sum exact.
        rate_mhz_ =
            static_cast<std::uint64_t>(std::llround(rate_hz * static_cast<double>(kMillihertz)));
        carry_ = 0;
        unit_ = 1;
    }
    // Returns the number of cycles in a tick of numerator / denominator seconds. The remaining part
    // of a cycle is carried to the next call.
    std::uint64_t cycles(std::uint32_t numerator, std::uint32_t denominator) noexcept {
        const std::uint64_t unit = denominator * kMillihertz;
        if (unit != unit_) { // another tick length: convert the carry to the nearest new unit
            const double part = static_cast<double>(carry_) / static_cast<double>(unit_);
            carry_ = static_cast<std::uint64_t>(std::llround(part * static_cast<double>(unit)));
            unit_ = unit;
        }
        const std::uint64_t sum = carry_ + numerator * rate_mhz_;
        carry_ = sum % unit;
        return std::min(sum / unit, kMostCyclesAtOnce);
    }

private:
    static constexpr std::uint64_t kMillihertz = 1000; // millihertz per hertz

    std::uint64_t rate_mhz_ = 0;
    std::uint64_t carry_ = 0; // the part of a cycle not run yet, in 1 / unit_ cycles
    std::uint64_t unit_ = 1;
};

} // namespace spidar
