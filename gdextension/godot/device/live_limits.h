// The limits that may change while a device is open.
#pragma once

#include <cmath>

#include "device/contract/haptic_command.h"
#include "godot/settings/spidar_g_config.h"

namespace spidar {

[[nodiscard]] inline LiveLimits live_limits(const ServoSettings &settings) noexcept {
    return {settings.safety.max_force_n,
            settings.safety.max_moment_nm,
            settings.safety.max_grasp_torque_nm,
            settings.render.max_stiffness_n_m,
            settings.render.max_turn_stiffness_nm_rad,
            settings.render.max_grasp_stiffness_nm_rad};
}

// Returns live_limits() with the stiffness limits lowered to what settings.render.latency_s and
// settings.rate_hz allow. Used when the link of the open device is slower than its config says.
[[nodiscard]] inline LiveLimits limits_by_latency(const ServoSettings &settings) noexcept {
    const GainCaps caps = gain_caps(settings.render, settings.rate_hz);
    LiveLimits limits = live_limits(settings);
    limits.max_stiffness_n_m = caps.stiffness_n_m;
    limits.max_turn_stiffness_nm_rad = caps.turn_stiffness_nm_rad;
    limits.max_grasp_stiffness_nm_rad = caps.grasp_stiffness_nm_rad;
    return limits;
}

// Interpolates linearly: share 0 gives a, 1 gives b.
[[nodiscard]] inline LiveLimits between(const LiveLimits &a, const LiveLimits &b,
                                        double share) noexcept {
    return {std::lerp(a.max_force_n, b.max_force_n, share),
            std::lerp(a.max_moment_nm, b.max_moment_nm, share),
            std::lerp(a.max_grasp_torque_nm, b.max_grasp_torque_nm, share),
            std::lerp(a.max_stiffness_n_m, b.max_stiffness_n_m, share),
            std::lerp(a.max_turn_stiffness_nm_rad, b.max_turn_stiffness_nm_rad, share),
            std::lerp(a.max_grasp_stiffness_nm_rad, b.max_grasp_stiffness_nm_rad, share)};
}

} // namespace spidar
