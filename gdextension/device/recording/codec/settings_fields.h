// List of all fields of ServoSettings, used by the head of a recording.
#pragma once

#include <string>

#include "device/recording/codec/field_words.h"
#include "device/settings/servo_settings.h"

namespace spidar {

// A failing assertion means that a struct changed: add the field below, then correct the number.
static_assert(count_members<FrameGeometry>() == 3, "FrameGeometry changed: list its fields here");
static_assert(count_members<GripGeometry>() == 4, "GripGeometry changed: list its fields here");
static_assert(count_members<StringCalibration>() == 3, "StringCalibration changed: list them here");
static_assert(count_members<MotorCalibration>() == 4, "MotorCalibration changed: list them here");
static_assert(count_members<TensionSettings>() == 12, "TensionSettings changed: list them here");
static_assert(count_members<GraspSettings>() == 5, "GraspSettings changed: list its fields here");
static_assert(count_members<FingerSettings>() == 6, "FingerSettings changed: list its fields here");
static_assert(count_members<SafetySettings>() == 23, "SafetySettings changed: list them here");
static_assert(count_members<RenderSettings>() == 16, "RenderSettings changed: list them here");
static_assert(count_members<LengthCorrections>() == 6, "LengthCorrections changed: list them");
static_assert(count_members<ServoSettings>() == 13, "ServoSettings changed: list its fields here");

template <typename Settings, typename Visit>
void for_each_field(Settings &settings, Visit &&visit) requires
    std::is_same_v<std::remove_const_t<Settings>, ServoSettings> {
    visit("rate_hz", 0, settings.rate_hz);
    visit("velocity_cutoff_hz", 0, settings.velocity_cutoff_hz);
    visit("reopen_interval_s", 0, settings.reopen_interval_s);
    visit_vectors("frame.motors_m", settings.frame.motors_m, visit);
    visit("frame.pulley_radius_m", 0, settings.frame.pulley_radius_m);
    visit_vector("frame.pulley_axis", 0, settings.frame.pulley_axis, visit);
    visit("grip.pole_half_length_m", 0, settings.grip.pole_half_length_m);
    visit("grip.kind", 0, settings.grip.kind);
    visit_vectors("grip.joints_m", settings.grip.joints_m, visit);
    int i = 0;
    for (auto &attachment : settings.grip.attachments) {
        visit("grip.attachment.pole", i, attachment.pole);
        visit("grip.attachment.sign", i, attachment.sign);
        ++i;
    }
    visit_array("strings.offset_m", settings.strings.offset_m, visit);
    visit_array("strings.scale_m_per_count", settings.strings.scale_m_per_count, visit);
    visit_array("strings.zero_count", settings.strings.zero_count, visit);
    auto &corrections = settings.corrections;
    visit_array("corrections.winding_curvature_1_m", corrections.winding_curvature_1_m, visit);
    visit_array("corrections.axial_stiffness_n", corrections.axial_stiffness_n, visit);
    visit_array("corrections.hidden_length_m", corrections.hidden_length_m, visit);
    visit("corrections.pulley_radius_m", 0, corrections.pulley_radius_m);
    visit_vector("corrections.swivel_axis", 0, corrections.swivel_axis, visit);
    visit_array("corrections.calibration_tension_n", corrections.calibration_tension_n, visit);
    visit_array("motors.effective_radius_m", settings.motors.effective_radius_m, visit);
    visit_array("motors.torque_constant_nm_a", settings.motors.torque_constant_nm_a, visit);
    visit_array("motors.tension_gain", settings.motors.tension_gain, visit);
    visit_array("motors.max_current_a", settings.motors.max_current_a, visit);
    auto &tension = settings.tension;
    visit("tension.min_tension_n", 0, tension.min_tension_n);
    visit("tension.max_tension_n", 0, tension.max_tension_n);
    visit("tension.reference_tension_n", 0, tension.reference_tension_n);
    visit("tension.weight_force", 0, tension.weight_force);
    visit("tension.weight_moment_per_m", 0, tension.weight_moment_per_m);
    visit("tension.weight_grasp_per_m", 0, tension.weight_grasp_per_m);
    visit("tension.ridge", 0, tension.ridge);
    visit("tension.reference_weight", 0, tension.reference_weight);
    visit("tension.change_weight", 0, tension.change_weight);
    visit("tension.dof_mask", 0, tension.dof_mask);
    visit("tension.broken_mask", 0, tension.broken_mask);
    visit("tension.simd", 0, tension.simd);
    auto &grasp = settings.grasp;
    visit("grasp.enter_rad", 0, grasp.enter_rad);
    visit("grasp.leave_rad", 0, grasp.leave_rad);
    visit("grasp.over_closed_rad", 0, grasp.over_closed_rad);
    visit("grasp.over_closed_leave_rad", 0, grasp.over_closed_leave_rad);
    visit("grasp.dwell_s", 0, grasp.dwell_s);
    auto &fingers = settings.fingers;
    visit("fingers.button_mask", 0, fingers.button_mask);
    visit("fingers.by_game", 0, fingers.by_game);
    visit("fingers.sensor", 0, fingers.sensor);
    visit("fingers.sensor_open", 0, fingers.sensor_open);
    visit("fingers.sensor_closed", 0, fingers.sensor_closed);
    visit("fingers.closed_rad", 0, fingers.closed_rad);
    auto &safety = settings.safety;
    visit("safety.arming_time_s", 0, safety.arming_time_s);
    visit("safety.tension_slew_n_per_ms", 0, safety.tension_slew_n_per_ms);
    visit("safety.max_force_n", 0, safety.max_force_n);
    visit("safety.max_moment_nm", 0, safety.max_moment_nm);
    visit("safety.max_grasp_torque_nm", 0, safety.max_grasp_torque_nm);
    visit("safety.max_count_speed_m_s", 0, safety.max_count_speed_m_s);
    visit("safety.max_bad_samples", 0, safety.max_bad_samples);
    visit("safety.read_timeout_fade_s", 0, safety.read_timeout_fade_s);
    visit("safety.read_timeout_fault_s", 0, safety.read_timeout_fault_s);
    visit("safety.max_grip_speed_m_s", 0, safety.max_grip_speed_m_s);
    visit("safety.fade_grip_speed_m_s", 0, safety.fade_grip_speed_m_s);
    visit("safety.fade_turn_rate_rad_s", 0, safety.fade_turn_rate_rad_s);
    visit("safety.max_turn_rate_rad_s", 0, safety.max_turn_rate_rad_s);
    visit("safety.wrench_fade_s", 0, safety.wrench_fade_s);
    visit("safety.contacts_full_s", 0, safety.contacts_full_s);
    visit("safety.contacts_gone_s", 0, safety.contacts_gone_s);
    visit("safety.game_timeout_s", 0, safety.game_timeout_s);
    visit("safety.continuous_tension_n", 0, safety.continuous_tension_n);
    visit("safety.thermal_time_s", 0, safety.thermal_time_s);
    visit("safety.string_error_fade_m", 0, safety.string_error_fade_m);
    visit("safety.string_error_fault_m", 0, safety.string_error_fault_m);
    visit("safety.workspace_margin_m", 0, safety.workspace_margin_m);
    visit("safety.hand_presence_s", 0, safety.hand_presence_s);
    auto &render = settings.render;
    visit("render.string_resonance_hz", 0, render.string_resonance_hz);
    visit("render.velocity_cutoff_hz", 0, render.velocity_cutoff_hz);
    visit("render.delay_compensation_s", 0, render.delay_compensation_s);
    visit("render.latency_s", 0, render.latency_s);
    visit("render.caps_from_latency", 0, render.caps_from_latency);
    visit("render.max_stiffness_n_m", 0, render.max_stiffness_n_m);
    visit("render.max_turn_stiffness_nm_rad", 0, render.max_turn_stiffness_nm_rad);
    visit("render.max_grasp_stiffness_nm_rad", 0, render.max_grasp_stiffness_nm_rad);
    visit("render.max_damping_n_s_m", 0, render.max_damping_n_s_m);
    visit("render.max_turn_damping_nm_s_rad", 0, render.max_turn_damping_nm_s_rad);
    visit("render.max_grasp_damping_nm_s_rad", 0, render.max_grasp_damping_nm_s_rad);
    visit("render.passivity_share", 0, render.passivity_share);
    visit("render.compensated_mass_kg", 0, render.compensated_mass_kg);
    visit_vector("render.gravity_m_s2", 0, render.gravity_m_s2, visit);
    visit("render.compensated_friction_n", 0, render.compensated_friction_n);
    visit("render.compensated_viscous_n_s_m", 0, render.compensated_viscous_n_s_m);
}

} // namespace spidar
