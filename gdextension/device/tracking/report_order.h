// Order of numbered reports. Numbers grow by one from 0 to 0xFFFE, then start again at 0. Missing
// reports are counted; repeated and late ones are refused.
#pragma once

#include <algorithm>
#include <cstdint>

#include "core/base/sound_state.h"

namespace spidar {

class ReportOrder {
public:
    // After this many old reports in a row the next one is used: the device has restarted its
    // numbers.
    static constexpr int kAnew = 20;

    void reset() noexcept { *this = ReportOrder(); }
    // Returns true when the report must be used. A device without numbers sends 0 each time.
    // overtaken: number of newer reports than the last one that were skipped for this one.
    bool accept(std::uint16_t sequence, int overtaken = 0) noexcept {
        missed_ = 0;
        const auto step = static_cast<std::int16_t>(static_cast<std::uint16_t>(sequence - last_));
        const bool first = !known_ || (sequence == 0 && last_ == 0);
        if (first || step > 0 || ++old_in_row_ > kAnew) {
            const int round = sequence < last_ ? 1 : 0; // 0xFFFF is never used
            missed_ = !first && step > 1 ? std::max(0, step - 1 - round - overtaken) : 0;
            known_ = true;
            last_ = sequence;
            old_in_row_ = 0;
            return true;
        }
        return false;
    }
    // Returns whether accept() would take this report with none missing.
    [[nodiscard]] bool follows(std::uint16_t sequence) const noexcept {
        const bool unnumbered = sequence == 0 && last_ == 0;
        const bool round = sequence == 0 && last_ == kLast;
        return known_ && (unnumbered || round || static_cast<std::uint16_t>(sequence - last_) == 1);
    }
    // Reports lost before the last accepted one.
    [[nodiscard]] int missed() const noexcept { return missed_; }
    // Checks restored memory: see core/base/sound_state.h.
    [[nodiscard]] bool is_sound() const noexcept {
        return are_flags(known_) && is_tally(missed_) && is_tally(old_in_row_);
    }

private:
    static constexpr std::uint16_t kLast = 0xFFFE;

    std::uint16_t last_ = 0;
    bool known_ = false;
    int missed_ = 0;
    int old_in_row_ = 0;
};

} // namespace spidar
