// How requests become a wrench: the device's own resonance and delay, and the largest gains that they allow.
#pragma once

#include <string>

#include "core/base/types.h"

namespace spidar {

struct RenderSettings {
    // Resonance of the motors' rotors against the grip on the elastic strings: a little more than
    // sqrt(EA / (length * rotor mass)) / (2 pi), EA the stiffness of a string (N per unit of strain). This frequency is
    // taken out of the motion that contacts and coupling see. 0 switches the filter off.
    double string_resonance_hz = 112.0;
    double velocity_cutoff_hz = 300.0; // of the velocity that damping uses
    // Contacts and coupling use the pose predicted this far ahead, to make up for the delays of the link, of commands that
    // are held for a cycle, of the motors and of the filter.
    double delay_compensation_s = 0.003;

    // What the caps are made from: from an encoder's edge to the motor's current.
    double latency_s = 0.001;
    bool caps_from_latency = true; // false: the caps below alone, for those who measure limits
    // Caps of one contact's or coupling's stiffness; the effective one is lower where latency and rate ask for it.
    double max_stiffness_n_m = 2000.0;
    double max_turn_stiffness_nm_rad = 3.0;
    double max_grasp_stiffness_nm_rad = 0.75; // per radian of grasp_angle
    double max_damping_n_s_m = 5.0;
    double max_turn_damping_nm_s_rad = 0.01;
    double max_grasp_damping_nm_s_rad = 0.003;

    // The controller of the coupling: greatest damping it adds, in parts of the caps of damping. 0: off.
    double passivity_share = 2.0;

    // Calibrated options, off by default. The grip's weight is held up by a force of the strings.
    double compensated_mass_kg = 0.0;
    Vec3 gravity_m_s2{0.0, -9.80665, 0.0};
    // Taken off the tension of a string that is paid out, added to one that is wound in. A share below 1 of what
    // was measured: a friction that is more than compensated would push by itself.
    double compensated_friction_n = 0.0;    // Coulomb
    double compensated_viscous_n_s_m = 0.0; // rotor and back-EMF
};

// Largest stable gains for a loop of this latency and rate, never above the settings' caps.
struct GainCaps {
    double stiffness_n_m = 0.0;
    double turn_stiffness_nm_rad = 0.0;
    double grasp_stiffness_nm_rad = 0.0;
    double damping_n_s_m = 0.0;
    double turn_damping_nm_s_rad = 0.0;
    double grasp_damping_nm_s_rad = 0.0;
    bool from_latency = false; // latency and rate, not the settings, are the limit of the stiffness
};
[[nodiscard]] GainCaps gain_caps(const RenderSettings &settings, double rate_hz) noexcept;

// Empty when usable; else one sentence naming the field, the value, the unit and the remedy.
[[nodiscard]] std::string validate(const RenderSettings &settings);

} // namespace spidar
