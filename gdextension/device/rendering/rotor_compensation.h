// Compensates the losses of a string's pull by rotors, bearings and back-EMF: a calibrated option,
// off by default.
#pragma once

#include "core/geometry/wrench_matrix.h"
#include "device/settings/render_settings.h"

namespace spidar {

// String speed over which the Coulomb friction rises, so that noise does not toggle the tension of
// a string at rest.
inline constexpr double kFrictionBand_m_s = 0.02;
// Returns the tension to add to each string (unit: N). Negative: subtracted. twist: filtered.
[[nodiscard]] StringArray rotor_compensation(const RenderSettings &settings,
                                             const WrenchMatrix &matrix,
                                             const Twist &twist) noexcept;

} // namespace spidar
