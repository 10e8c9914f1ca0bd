// The edge of the workspace: a soft wall before the end of the grip's reach, and less force where
// the strings hardly determine some direction.
#pragma once

#include "core/base/sound_state.h"
#include "core/geometry/reach_box.h"
#include "device/contract/grip_state.h"
#include "device/settings/servo_settings.h"

namespace spidar {

class WorkspaceGuard {
public:
    // The reach is the box around the motors less a pole's half length.
    void configure(const ServoSettings &settings) noexcept;

    // Returns the wrench that pushes P0 back; zero inside the box, and with a workspace_margin_m of
    // 0.
    [[nodiscard]] Wrench wall(const GripState &grip) const noexcept;
    // Scale of the wrench: 1, and less down to 0 as GripState::conditioning falls below 0.01.
    [[nodiscard]] static double scale(const GripState &grip) noexcept;
    // Returns how far P0 is beyond the start of the wall (unit: m); 0 inside.
    [[nodiscard]] double beyond_m(const GripState &grip) const noexcept;
    // The box inside which the wall gives no force, device frame (unit: m).
    [[nodiscard]] const ReachBox &free_box() const noexcept { return free_; }
    // Checks restored memory: see core/base/sound_state.h.
    [[nodiscard]] bool is_sound() const noexcept { return are_flags(on_); }

private:
    ReachBox free_;
    bool on_ = false;
};

} // namespace spidar
