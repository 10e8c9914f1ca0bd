// What the tool can touch and what it carries, published by a game once per tick. The servo loop
// renders it until the next one arrives (touch_renderer.h). Device frame, SI units.
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
    // Stiffness between the grip and the tool's proxy. 0 in a DOF: automatic, kAutomaticShare of
    // the cap for latency and rate.
    DofGains stiffness{};
    double damping_n_s_m = 2.0; // of each contact
    // Wrench of what the tool carries, about P0: weight and inertia of a held body, springs on it.
    // It acts on the proxy, so that the hand feels what no surface carries.
    Wrench load;
    // DOF in which contacts reach the hand. The load is felt in all DOF.
    std::uint8_t felt = kAllDof;
    // See Coupling::state_time_s.
    double state_time_s = -1.0;
    // Owners of the shapes and reliefs above. The servo loop does not use them: the publisher keeps
    // a scene until a newer one is acknowledged (TouchReport::sequence).
    std::vector<std::shared_ptr<const CookedShape>> shapes;
    std::vector<std::shared_ptr<const ToolShape>> tool_shapes;
};

// Share of the caps (gain_caps) that contacts use as their automatic stiffness.
inline constexpr double kAutomaticShare = 0.6;

// Returns ok, or invalid_request / not_finite. A bad scene is ignored; the last valid one stays.
[[nodiscard]] Status validate(const TouchScene &touch) noexcept;

} // namespace spidar
