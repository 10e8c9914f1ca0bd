#include "device/settings/render_settings.h"

#include <algorithm>

#include "core/base/describe_value.h"

namespace spidar {

namespace {

// Mean delay of the motor current, first order, as in measured amplifiers.
constexpr double kCurrentLag_s = 0.0005;
// Limit of stiffness * (latency + half a period + current lag): two thirds of what
// tests/stress/stiffness_limit finds stable in every hand at latencies of 0.25 to 2 ms.
constexpr double kStableProduct_n_s_m = 2.4;
constexpr double kStableTurnProduct_nm_s_rad = 4.8e-3;
constexpr double kStableGraspProduct_nm_s_rad = 1.2e-3;

} // namespace

GainCaps gain_caps(const RenderSettings &settings, double rate_hz) noexcept {
    GainCaps caps;
    caps.stiffness_n_m = settings.max_stiffness_n_m;
    caps.turn_stiffness_nm_rad = settings.max_turn_stiffness_nm_rad;
    caps.grasp_stiffness_nm_rad = settings.max_grasp_stiffness_nm_rad;
    if (settings.caps_from_latency) {
        const double delay_s = settings.latency_s + 0.5 / rate_hz + kCurrentLag_s;
        const double stable_n_m = kStableProduct_n_s_m / delay_s;
        caps.from_latency = stable_n_m < caps.stiffness_n_m;
        caps.stiffness_n_m = std::min(caps.stiffness_n_m, stable_n_m);
        caps.turn_stiffness_nm_rad =
            std::min(caps.turn_stiffness_nm_rad, kStableTurnProduct_nm_s_rad / delay_s);
        caps.grasp_stiffness_nm_rad =
            std::min(caps.grasp_stiffness_nm_rad, kStableGraspProduct_nm_s_rad / delay_s);
    }
    caps.damping_n_s_m = settings.max_damping_n_s_m;
    caps.turn_damping_nm_s_rad = settings.max_turn_damping_nm_s_rad;
    caps.grasp_damping_nm_s_rad = settings.max_grasp_damping_nm_s_rad;
    return caps;
}

std::string validate(const RenderSettings &settings) {
    const RenderSettings &s = settings;
    const ValueRange ranges[] = {
        {"render.string_resonance_hz", s.string_resonance_hz, "Hz", 0.0, 2000.0},
        {"render.velocity_cutoff_hz", s.velocity_cutoff_hz, "Hz", 1.0, 2000.0},
        {"render.delay_compensation_s", s.delay_compensation_s, "s", 0.0, 0.02},
        {"render.latency_s", s.latency_s, "s", 0.0, 0.05},
        {"render.max_stiffness_n_m", s.max_stiffness_n_m, "N/m", 0.0, 1e5},
        {"render.max_turn_stiffness_nm_rad", s.max_turn_stiffness_nm_rad, "N m/rad", 0.0, 1e3},
        {"render.max_grasp_stiffness_nm_rad", s.max_grasp_stiffness_nm_rad, "N m/rad", 0.0, 1e3},
        {"render.max_damping_n_s_m", s.max_damping_n_s_m, "N s/m", 0.0, 1e3},
        {"render.max_turn_damping_nm_s_rad", s.max_turn_damping_nm_s_rad, "N m s/rad", 0.0, 10.0},
        {"render.max_grasp_damping_nm_s_rad", s.max_grasp_damping_nm_s_rad, "N m s/rad", 0.0, 10.0},
        {"render.passivity_share", s.passivity_share, "times the damping caps", 0.0, 3.0},
        {"render.compensated_mass_kg", s.compensated_mass_kg, "kg", 0.0, 1.0},
        {"render.gravity_m_s2.x", s.gravity_m_s2.x, "m/s^2", -30.0, 30.0},
        {"render.gravity_m_s2.y", s.gravity_m_s2.y, "m/s^2", -30.0, 30.0},
        {"render.gravity_m_s2.z", s.gravity_m_s2.z, "m/s^2", -30.0, 30.0},
        {"render.compensated_friction_n", s.compensated_friction_n, "N", 0.0, 0.5},
        {"render.compensated_viscous_n_s_m", s.compensated_viscous_n_s_m, "N s/m", 0.0, 1.0},
    };
    return first_out_of_range(ranges);
}

} // namespace spidar
