// Reports carry a number that grows by one: missing ones are counted, repeated and late ones left out.
#pragma once

#include <cstdint>

namespace spidar {

class ReportOrder {
public:
    // Old reports in a row after which the device is believed to count anew.
    static constexpr int kAnew = 20;

    void reset() noexcept { *this = ReportOrder(); }
    // True: use the report. A device that gives no numbers says 0 each time.
    bool accept(std::uint16_t sequence) noexcept {
        missed_ = 0;
        const auto step = static_cast<std::int16_t>(static_cast<std::uint16_t>(sequence - last_));
        const bool first = !known_ || (sequence == 0 && last_ == 0);
        if (first || step > 0 || ++old_in_row_ > kAnew) {
            missed_ = !first && step > 1 ? step - 1 : 0;
            known_ = true;
            last_ = sequence;
            old_in_row_ = 0;
            return true;
        }
        return false;
    }
    // Would this one be accepted with none missing?
    [[nodiscard]] bool follows(std::uint16_t sequence) const noexcept {
        const bool unnumbered = sequence == 0 && last_ == 0;
        return known_ && (unnumbered || static_cast<std::uint16_t>(sequence - last_) == 1);
    }
    // Lost before the report accepted last.
    [[nodiscard]] int missed() const noexcept { return missed_; }

private:
    std::uint16_t last_ = 0;
    bool known_ = false;
    int missed_ = 0;
    int old_in_row_ = 0;
};

} // namespace spidar
