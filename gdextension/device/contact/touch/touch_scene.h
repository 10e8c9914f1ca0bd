// What the tool can touch and what it carries, published by a game once per physics tick. The servo
// loop renders a scene until the next one arrives or the scene expires (touch_renderer.h). Device
// frame, SI units.
#pragma once

#include <memory>
#include <vector>

#include "core/base/status.h"
#include "device/contact/proxy/contact_scene.h"
#include "device/contact/proxy/tool.h"
#include "device/contract/haptic_command.h"

namespace spidar {

struct TouchScene {
    Tool tool;
    ContactScene scene; // at the time state_time_s
    // Stiffness between the grip and the tool's proxy. 0 in a DOF: kAutomaticShare of the cap.
    DofGains stiffness{};
    double damping_n_s_m = 2.0; // of each contact
    // Wrench about P0 of what the tool carries: weight and inertia of a held body, springs on it.
    // It acts on the proxy, so that the hand feels only what no surface carries.
    Wrench load;
    // Bit i: the hand feels contacts in DOF i. The load is felt in all DOF.
    std::uint8_t felt = kAllDof;
    // See Coupling::state_time_s.
    double state_time_s = -1.0;
    // Owners of the shapes and reliefs above. The servo loop does not use them: the publisher keeps
    // a scene until a newer one is acknowledged (TouchReport::sequence).
    std::vector<std::shared_ptr<const CookedShape>> shapes;
    std::vector<std::shared_ptr<const ToolShape>> tool_shapes;
};

// The automatic stiffness of contacts, as a share of the cap (gain_caps).
inline constexpr double kAutomaticShare = 0.6;

// Returns ok, invalid_request or not_finite. HapticRenderer ignores a scene that is not ok; the
// last valid one stays until it expires.
[[nodiscard]] Status validate(const TouchScene &touch) noexcept;

} // namespace spidar
