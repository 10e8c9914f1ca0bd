// Makes up for the pull that a string loses to friction of rotor and bearings and to back-EMF, not
// to the rotor's inertia. A calibrated option, off by default.
#pragma once

#include "core/geometry/wrench_matrix.h"
#include "device/settings/render_settings.h"

namespace spidar {

// String speed at which the compensation of Coulomb friction is full; it rises linearly from 0 m/s,
// so that noise does not toggle the tension of a string at rest.
inline constexpr double kFrictionBand_m_s = 0.02;
// Returns the tension to add to each string (unit: N): positive while the string is wound in,
// negative while it is paid out. twist: the filtered one.
[[nodiscard]] StringArray rotor_compensation(const RenderSettings &settings,
                                             const WrenchMatrix &matrix,
                                             const Twist &twist) noexcept;

} // namespace spidar
