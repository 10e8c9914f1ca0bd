// What the servo loop's tensions give of the request, from a snapshot: for whoever reads snapshots, at that rate. The
// loop itself pays nothing for it.
#pragma once

#include "core/tension/tension_report.h"
#include "device/contract/servo_snapshot.h"
#include "device/settings/servo_settings.h"

namespace spidar {

// The solver's settings in a servo loop: no string is ever asked for more than its motor gives, so that currents are
// never cut behind the solver's back.
[[nodiscard]] TensionSettings solver_settings(const ServoSettings &settings) noexcept;

// In the ramps of arming and fading all is scaled alike. While the motors are off: zeros, status ok.
[[nodiscard]] TensionReport tension_report(const ServoSettings &settings,
                                           const ServoSnapshot &snapshot) noexcept;

} // namespace spidar
