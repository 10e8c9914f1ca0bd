// What rotors, bearings and back-EMF take from a string's pull, added back: a calibrated option, off by default.
#pragma once

#include "core/geometry/wrench_matrix.h"
#include "device/settings/render_settings.h"

namespace spidar {

// Tension to add to each string (unit: N; negative where the string is wound in). twist: filtered. Coulomb friction
// rises over kFrictionBand_m_s, so that a string at rest is not pushed to and fro by noise.
inline constexpr double kFrictionBand_m_s = 0.02;
[[nodiscard]] StringArray rotor_compensation(const RenderSettings &settings,
                                             const WrenchMatrix &matrix,
                                             const Twist &twist) noexcept;

} // namespace spidar
