// Splits the error of a servo loop's tensions into its causes, from a snapshot. It runs in the
// thread that reads the snapshot and not in the servo loop.
#pragma once

#include "core/tension/tension_report.h"
#include "device/contract/servo_snapshot.h"
#include "device/settings/servo_settings.h"

namespace spidar {

// Returns the solver's settings in a servo loop. No string's maximum exceeds what its motor can
// pull, so that currents are never clamped after the solver.
[[nodiscard]] TensionSettings solver_settings(const ServoSettings &settings) noexcept;

// During the ramps of arming and fading, request and tensions are compared at full scale, and the
// report is scaled by the ramp. With the motors off all values are zero and the status is ok.
[[nodiscard]] TensionReport tension_report(const ServoSettings &settings,
                                           const ServoSnapshot &snapshot) noexcept;

} // namespace spidar
