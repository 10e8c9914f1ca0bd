// How requests become a wrench: resonance and delay of the device, and the gain limits they set.
#pragma once

#include <string>

#include "core/base/types.h"

namespace spidar {

struct RenderSettings {
    // Resonance of the motors' rotors against the grip on the elastic strings, somewhat above
    // sqrt(EA / (length * rotor mass)) / (2 pi), where EA is the axial stiffness of a string (N). A
    // filter removes this frequency from the motion that contacts and coupling use. 0: no filter.
    double string_resonance_hz = 112.0;
    double velocity_cutoff_hz = 300.0; // of the velocity for damping
    // Time by which the pose is predicted for contacts and coupling. It compensates the delays of
    // the link, the hold of one cycle, the motors and the filter.
    double delay_compensation_s = 0.003;

    // Time from encoder edge to motor current. The caps below are lowered according to it.
    double latency_s = 0.001;
    bool caps_from_latency = true; // false: only the caps below apply, for measuring limits
    // Largest stiffness of one contact or coupling. Latency and rate may lower it further.
    double max_stiffness_n_m = 2000.0;
    double max_turn_stiffness_nm_rad = 3.0;
    double max_grasp_stiffness_nm_rad = 0.75; // per radian of grasp_angle
    double max_damping_n_s_m = 5.0;
    double max_turn_damping_nm_s_rad = 0.01;
    double max_grasp_damping_nm_s_rad = 0.003;

    // Largest damping of the coupling's passivity controller over the damping caps. 0: off.
    double passivity_share = 2.0;

    // Mass of the grip whose weight the strings carry. Off by default; needs a measurement.
    double compensated_mass_kg = 0.0;
    Vec3 gravity_m_s2{0.0, -9.80665, 0.0};
    // Compensated motor friction: subtracted from the tension of a string that pays out, added when
    // it winds in. Must stay below the measured friction, or the grip moves by itself.
    double compensated_friction_n = 0.0;    // Coulomb
    double compensated_viscous_n_s_m = 0.0; // of rotor and back-EMF
};

// Largest stable gains for a loop of this latency and rate; never above the settings' caps.
struct GainCaps {
    double stiffness_n_m = 0.0;
    double turn_stiffness_nm_rad = 0.0;
    double grasp_stiffness_nm_rad = 0.0;
    double damping_n_s_m = 0.0;
    double turn_damping_nm_s_rad = 0.0;
    double grasp_damping_nm_s_rad = 0.0;
    // The latency and rate, not the settings, limit the stiffness.
    bool from_latency = false;
};
[[nodiscard]] GainCaps gain_caps(const RenderSettings &settings, double rate_hz) noexcept;

// Returns an empty string when usable, else one sentence with field, value, unit and remedy.
[[nodiscard]] std::string validate(const RenderSettings &settings);

} // namespace spidar
