// What the tool can touch and what it carries, as a game publishes it once a tick. The servo loop renders it until the
// next one comes (touch_renderer.h). Device frame, SI.
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
    ContactScene scene; // as of state_time_s
    // Between the grip and the tool's proxy; 0 in a DOF: automatic, kAutomaticShare of the cap for latency and rate.
    DofGains stiffness{};
    double damping_n_s_m = 2.0; // of each contact
    // What the tool carries, about P0: weight and inertia of what is held, springs on it. It pulls on the proxy, so the hand
    // feels of it what no surface carries.
    Wrench load;
    std::uint8_t felt =
        kAllDof; // DOF in which the contacts reach the hand; the load is felt in all
    // As Coupling::state_time_s.
    double state_time_s = -1.0;
    // The owners of the shapes and reliefs above. The servo loop does not look at them: whoever publishes keeps a scene until a newer
    // one is acknowledged (TouchReport::sequence).
    std::vector<std::shared_ptr<const CookedShape>> shapes;
    std::vector<std::shared_ptr<const ToolShape>> tool_shapes;
};

// Of the caps (gain_caps), what contacts use where a scene leaves the stiffness open.
inline constexpr double kAutomaticShare = 0.6;

// ok, or invalid_request / not_finite: then it is not rendered, and the last good one stands.
[[nodiscard]] Status validate(const TouchScene &touch) noexcept;

} // namespace spidar
