// String tension -> motor torque -> current, per string.
#pragma once

#include <string>

#include "core/base/types.h"

namespace spidar {

struct MotorCalibration {
    // Effective winding radius (unit: m): torque = tension * radius. The radius that a length fit finds
    // (scale_m_per_count * counts a turn / 2 pi) corrects the tension too.
    StringArray effective_radius_m{0.008, 0.008, 0.008, 0.008, 0.008, 0.008, 0.008, 0.008};
    // Motor torque constant (unit: N m / A). Maxon RE 25 class.
    StringArray torque_constant_nm_a{0.0438, 0.0438, 0.0438, 0.0438,
                                     0.0438, 0.0438, 0.0438, 0.0438};
    // Gain found by hanging a known weight on the string: real tension / commanded tension.
    StringArray tension_gain{1, 1, 1, 1, 1, 1, 1, 1};
    StringArray max_current_a{4, 4, 4, 4, 4, 4, 4, 4};
};

// What currents_from_tensions() makes of a calibration, once: newtons of real tension an ampere gives (0 where the calibration
// is no positive number) and the current's limit.
struct MotorScale {
    StringArray tension_per_ampere_n_a{};
    StringArray limit_a{};
};
[[nodiscard]] MotorScale motor_scale(const MotorCalibration &calibration) noexcept;

// Unit: A. Never NaN, never negative, never above max_current_a: a tension that is not >= 0 gives 0 A.
[[nodiscard]] StringArray currents_from_tensions(const MotorCalibration &calibration,
                                                 const StringArray &tensions_n) noexcept;
[[nodiscard]] StringArray currents_from_tensions(const MotorScale &scale,
                                                 const StringArray &tensions_n) noexcept;
// Largest tension each motor can pull (unit: N).
[[nodiscard]] StringArray max_tensions(const MotorCalibration &calibration) noexcept;

[[nodiscard]] std::string validate(const MotorCalibration &calibration);

} // namespace spidar
