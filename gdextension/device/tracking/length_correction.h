// Converts counts to lengths in the servo loop, corrected for winding and stretch. The computed
// stretch follows the commanded tensions slowly: it corrects the lengths under a steady force, and
// is too slow to affect the stability of a stiff wall.
#pragma once

#include "core/base/one_pole.h"
#include "core/base/sound_state.h"
#include "core/calibration/length_corrections.h"

namespace spidar {

class LengthCorrection {
public:
    void configure(const StringCalibration &strings, const LengthCorrections &corrections) noexcept;
    void set_zero(const CountArray &counts) noexcept { strings_.zero_count = counts; }

    // Takes one cycle. tensions_n: commanded in the last cycle. Returns true if the same counts now
    // give other lengths.
    bool follow(const StringArray &tensions_n, double dt_s) noexcept;
    [[nodiscard]] StringArray lengths(const CountArray &counts) const noexcept;
    // Checks restored memory: see core/base/sound_state.h.
    [[nodiscard]] bool is_sound() const noexcept { return are_flags(wound_, stretched_); }

private:
    // Cut-off at which the stretch follows. If it followed at once, a wall of 2000 N/m on strings
    // of 12 kN/m in series would become 1.2 times as stiff.
    static constexpr double kFollow_hz = 5.0;

    StringCalibration strings_{};
    LengthCorrections corrections_{};
    bool wound_ = false;
    bool stretched_ = false;
    OnePole follow_{kFollow_hz};
    StringArray tensions_n_{}; // low-pass filtered
};

} // namespace spidar
