// Checks whether encoder counts are plausible. A string cannot move faster than a hand can pull it:
// a larger step is a glitch of the encoder or the link. One bad sample is skipped. Several in a row
// are a fault, since the counts may have lost their zero.
#pragma once

#include "core/base/sound_state.h"
#include "core/base/types.h"
#include "core/calibration/string_calibration.h"

namespace spidar {

class SampleGuard {
public:
    enum class Verdict : std::uint8_t {
        good,      // new counts
        unchanged, // the same counts as the last good sample
        bad,       // the last good sample must be used
        // max_bad_samples bad samples in a row have been seen. All verdicts are `jumped` until
        // reset().
        jumped,
    };

    void configure(const StringCalibration &strings, double max_speed_m_s, int max_bad_samples,
                   double nominal_dt_s) noexcept;
    // Takes the next sample as the reference, whatever its counts.
    void reset() noexcept;

    // Checks a sample. dt_s: time since the last call of check() or advance_without_reading().
    // Counts wrap at 32 bits.
    Verdict check(const CountArray &counts, double dt_s) noexcept;
    // Takes a cycle without a sample.
    void advance_without_reading(double dt_s) noexcept { elapsed_s_ += dt_s; }
    [[nodiscard]] bool at_rest() const noexcept { return has_reference_ && bad_in_row_ == 0; }

    // The string (0-7) that moved most in the last bad sample; -1 if there was none since reset().
    [[nodiscard]] int bad_string() const noexcept { return bad_string_; }
    // Checks restored memory: see core/base/sound_state.h.
    [[nodiscard]] bool is_sound() const noexcept {
        return are_flags(has_reference_) && is_tally(max_bad_samples_) && is_tally(bad_in_row_) &&
               is_string_or_none(bad_string_);
    }

private:
    StringArray metres_per_count_{};
    double max_speed_m_s_ = 0.0;
    double nominal_dt_s_ = 0.0;
    int max_bad_samples_ = 1;
    CountArray reference_{};
    bool has_reference_ = false;
    double elapsed_s_ = 0.0; // since the reference
    int bad_in_row_ = 0;
    int bad_string_ = -1;
};

} // namespace spidar
