// What a string calibration with one scale a string leaves out: the winding that changes its
// radius, and the stretch under tension (paper, section VI.1: its two explanations of the length
// error). Servo-safe: no allocation, noexcept, and a value that is not finite corrects nothing.
#pragma once

#include <string>

#include "core/base/types.h"
#include "core/calibration/string_calibration.h"

namespace spidar {

struct LengthCorrections {
    // Length paid out since the zero count, m, becomes m + curvature m^2 (unit: 1/m). Negative: the
    // drum is fuller, so pays out more a count, near the zero than far out. 0: none.
    StringArray winding_curvature_1_m{};
    // Axial stiffness EA of the string (unit: N): strain = tension / EA. 0: not known, not
    // corrected.
    StringArray axial_stiffness_n{};
    // String between the drum and the frame's exit, which stretches as well (unit: m).
    StringArray hidden_length_m{};
    // Radius of the pulleys over which the strings leave the frame (unit: m), and the axis along
    // which they come in from outside and about which the pulleys swivel (unit vector). 0: eyelets.
    // See exit_pulley.h.
    double pulley_radius_m = 0.0;
    Vec3 swivel_axis{0.0, 1.0, 0.0};
    // Tension at which the lengths were calibrated: its stretch is in the calibration already.
    StringArray calibration_tension_n{};
};

// More strain than this breaks a braided string; a larger value is a wrong stiffness and is cut
// here.
inline constexpr double kMaxStrain = 0.05;

// Lengths from the counts, the winding corrected.
[[nodiscard]] StringArray wound_lengths(const StringCalibration &calibration,
                                        const LengthCorrections &corrections,
                                        const CountArray &counts) noexcept;

// Distance from exit to attachment of a string that unstretched (at its calibration tension) would
// have lengths_m, under the tension commanded. The commanded tension has friction and lag in it:
// what remains is (tension error) * length / EA.
[[nodiscard]] StringArray compensate_stretch(const LengthCorrections &corrections,
                                             const StringArray &lengths_m,
                                             const StringArray &tensions_n) noexcept;

// Empty when usable; else one sentence naming field, value, unit and remedy. Allocates.
[[nodiscard]] std::string validate(const LengthCorrections &corrections);

} // namespace spidar
