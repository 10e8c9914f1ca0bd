// Conversion of string tension to motor torque and current, per string.
#pragma once

#include <string>

#include "core/base/types.h"

namespace spidar {

struct MotorCalibration {
    // Effective winding radius (unit: m): torque = tension * radius. A fitted string scale gives it
    // too: scale_m_per_count * counts per turn / 2 pi.
    StringArray effective_radius_m{0.008, 0.008, 0.008, 0.008, 0.008, 0.008, 0.008, 0.008};
    // Motor torque constant (unit: N m/A). The default is that of a Maxon RE 25.
    StringArray torque_constant_nm_a{0.0438, 0.0438, 0.0438, 0.0438,
                                     0.0438, 0.0438, 0.0438, 0.0438};
    // Real tension over commanded tension, measured with a known weight on the string.
    StringArray tension_gain{1, 1, 1, 1, 1, 1, 1, 1};
    // Largest current (unit: A).
    StringArray max_current_a{4, 4, 4, 4, 4, 4, 4, 4};
};

// Factors of currents_from_tensions(), computed once per calibration. tension_per_ampere_n_a is 0
// for a string whose radius, torque constant and gain give no positive, finite ratio. limit_a is 0
// where max_current_a is not positive and finite.
struct MotorScale {
    StringArray tension_per_ampere_n_a{};
    StringArray limit_a{};
};
[[nodiscard]] MotorScale motor_scale(const MotorCalibration &calibration) noexcept;

// Returns currents (unit: A) from 0 to max_current_a. A NaN or negative tension gives 0 A.
[[nodiscard]] StringArray currents_from_tensions(const MotorCalibration &calibration,
                                                 const StringArray &tensions_n) noexcept;
// The conversion with factors that motor_scale() computed before.
[[nodiscard]] StringArray currents_from_tensions(const MotorScale &scale,
                                                 const StringArray &tensions_n) noexcept;
// Returns the tension of each motor at its max_current_a (unit: N).
[[nodiscard]] StringArray max_tensions(const MotorCalibration &calibration) noexcept;

[[nodiscard]] std::string validate(const MotorCalibration &calibration);

} // namespace spidar
