#include "device/tracking/length_correction.h"

#include <algorithm>
#include <cmath>

namespace spidar {

namespace {

// Distance at which the followed tension has arrived: 0.01 um of stretch.
constexpr double kReached_n = 1e-4;

bool any(const StringArray &values) noexcept {
    return std::any_of(values.begin(), values.end(), [](double v) { return v != 0.0; });
}

} // namespace

void LengthCorrection::configure(const StringCalibration &strings,
                                 const LengthCorrections &corrections) noexcept {
    *this = LengthCorrection();
    strings_ = strings;
    corrections_ = corrections;
    wound_ = any(corrections.winding_curvature_1_m);
    stretched_ = any(corrections.axial_stiffness_n);
}

bool LengthCorrection::follow(const StringArray &tensions_n, double dt_s) noexcept {
    if (!stretched_) {
        return false;
    }
    const double gain = follow_.share(dt_s);
    bool changed = false;
    for (std::size_t i = 0; i < tensions_n.size(); ++i) {
        const double off_n = tensions_n[i] - tensions_n_[i];
        if (off_n == 0.0 || !std::isfinite(off_n)) {
            continue;
        }
        changed = true;
        tensions_n_[i] =
            std::abs(off_n) <= kReached_n ? tensions_n[i] : tensions_n_[i] + gain * off_n;
    }
    return changed;
}

StringArray LengthCorrection::lengths(const CountArray &counts) const noexcept {
    StringArray lengths_m = wound_ ? wound_lengths(strings_, corrections_, counts)
                                   : lengths_from_counts(strings_, counts);
    return stretched_ ? compensate_stretch(corrections_, lengths_m, tensions_n_) : lengths_m;
}

} // namespace spidar
