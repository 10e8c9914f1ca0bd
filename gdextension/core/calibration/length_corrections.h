// Length errors that one scale per string leaves out: winding, which changes the drum's radius, and
// stretch under tension (paper, section VI.1, gives both as causes of the length error).
// Servo-safe: no allocation, noexcept. A value that is not finite corrects nothing.
#pragma once

#include <string>

#include "core/base/types.h"
#include "core/calibration/string_calibration.h"

namespace spidar {

struct LengthCorrections {
    // A length m paid out since the zero count becomes m + curvature m^2 (unit: 1/m). Negative: the
    // drum grows thinner as it pays out, so that each further count pays out less. 0: no
    // correction.
    StringArray winding_curvature_1_m{};
    // Axial stiffness EA of the string (unit: N): strain = tension / EA. 0: unknown, no correction.
    StringArray axial_stiffness_n{};
    // String length between the drum and the frame's exit, which stretches as well (unit: m).
    StringArray hidden_length_m{};
    // Radius of the exit pulleys (unit: m). 0: eyelets. See exit_pulley.h.
    double pulley_radius_m = 0.0;
    // Unit vector along which the strings arrive from outside and about which the pulleys swivel.
    Vec3 swivel_axis{0.0, 1.0, 0.0};
    // Tension during calibration (unit: N). Its stretch is part of the calibrated lengths.
    StringArray calibration_tension_n{};
};

// Largest strain that is corrected. A braided string breaks beyond it, so that a larger strain
// comes from a wrong stiffness.
inline constexpr double kMaxStrain = 0.05;

// Returns the string lengths (unit: m) of these counts, with the winding corrected.
[[nodiscard]] StringArray wound_lengths(const StringCalibration &calibration,
                                        const LengthCorrections &corrections,
                                        const CountArray &counts) noexcept;

// Returns the lengths under tension (unit: m) of strings that have lengths_m at their calibration
// tension. tensions_n are commanded tensions: where friction and lag make the real tension differ,
// an error of (tension error) * (length + hidden_length_m) / EA remains.
[[nodiscard]] StringArray compensate_stretch(const LengthCorrections &corrections,
                                             const StringArray &lengths_m,
                                             const StringArray &tensions_n) noexcept;

// Returns an empty string when usable, else a sentence with field, value, unit and remedy.
[[nodiscard]] std::string validate(const LengthCorrections &corrections);

} // namespace spidar
