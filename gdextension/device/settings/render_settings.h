// Settings of the renderer: resonance and delay of the device, limits of gains, compensation.
#pragma once

#include <string>

#include "core/base/types.h"

namespace spidar {

struct RenderSettings {
    // Frequency at which the motors' rotors and the grip swing against each other on the elastic
    // strings, somewhat above sqrt(EA / (length m)) / (2 pi). EA is the axial stiffness of a string
    // (N), m the inertia of a rotor over the square of its drum's radius (kg). A filter removes
    // this frequency from the motion that is rendered. No filter with 0, or if the servo rate is
    // too low for it (device/rendering/motion_filter.cpp).
    double string_resonance_hz = 112.0;
    double velocity_cutoff_hz = 300.0; // of the velocity that damping uses
    // Time by which the pose is predicted for contacts and coupling. It compensates the delays of
    // the link, the hold of one cycle, the motors and the filter.
    double delay_compensation_s = 0.003;

    // Time from encoder edge to motor current. It lowers the stiffness caps below: see gain_caps().
    double latency_s = 0.001;
    bool caps_from_latency = true; // false: latency lowers no cap (for tests)
    // Largest stiffness of one contact or coupling. Latency and rate may lower it further.
    double max_stiffness_n_m = 2000.0;
    double max_turn_stiffness_nm_rad = 3.0;
    double max_grasp_stiffness_nm_rad = 0.75; // per radian of grasp_angle
    double max_damping_n_s_m = 5.0;
    double max_turn_damping_nm_s_rad = 0.01;
    double max_grasp_damping_nm_s_rad = 0.003;

    // Largest damping that the passivity controller of the coupling adds, as a multiple of the
    // damping caps. 0: no controller.
    double passivity_share = 2.0;

    // Mass of the grip whose weight the strings carry. Off by default; needs a measurement.
    double compensated_mass_kg = 0.0;
    Vec3 gravity_m_s2{0.0, -9.80665, 0.0};
    // Compensated motor friction: subtracted from the tension of a string that pays out, added when
    // it winds in. Must stay below the measured friction, or the grip moves by itself.
    double compensated_friction_n = 0.0;    // Coulomb
    double compensated_viscous_n_s_m = 0.0; // of rotor and back-EMF
};

// Largest gains that are rendered: the caps of the settings, where the stiffness is also limited to
// what is stable at this latency and rate.
struct GainCaps {
    double stiffness_n_m = 0.0;
    double turn_stiffness_nm_rad = 0.0;
    double grasp_stiffness_nm_rad = 0.0;
    double damping_n_s_m = 0.0;
    double turn_damping_nm_s_rad = 0.0;
    double grasp_damping_nm_s_rad = 0.0;
    // True if stiffness_n_m is below the settings' cap because of the latency and the servo rate.
    bool from_latency = false;
};
[[nodiscard]] GainCaps gain_caps(const RenderSettings &settings, double rate_hz) noexcept;

// Returns an empty string when usable, else one sentence with field, value, unit and remedy.
[[nodiscard]] std::string validate(const RenderSettings &settings);

} // namespace spidar
