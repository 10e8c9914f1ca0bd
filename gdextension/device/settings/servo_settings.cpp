#include "device/settings/servo_settings.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/base/describe_value.h"

namespace spidar {

namespace {

std::string validate_safety(const SafetySettings &safety) {
    // Upper ends still protect a hand; lower ends still work.
    const ValueRange ranges[] = {
        {"safety.arming_time_s", safety.arming_time_s, "s", 0.001, 60.0},
        {"safety.tension_slew_n_per_ms", safety.tension_slew_n_per_ms, "N/ms", 0.001, 100.0},
        {"safety.max_force_n", safety.max_force_n, "N", 0.0, 100.0},
        {"safety.max_moment_nm", safety.max_moment_nm, "N m", 0.0, 10.0},
        {"safety.max_grasp_torque_nm", safety.max_grasp_torque_nm, "N m", 0.0, 10.0},
        {"safety.max_count_speed_m_s", safety.max_count_speed_m_s, "m/s", 0.1, 100.0},
        {"safety.max_bad_samples", static_cast<double>(safety.max_bad_samples), "samples", 1.0,
         100.0},
        {"safety.read_timeout_fade_s", safety.read_timeout_fade_s, "s", 0.001, 1.0},
        {"safety.read_timeout_fault_s", safety.read_timeout_fault_s, "s", 0.001, 1.0},
        {"safety.max_grip_speed_m_s", safety.max_grip_speed_m_s, "m/s", 0.1, 10.0},
        {"safety.fade_grip_speed_m_s", safety.fade_grip_speed_m_s, "m/s", 0.1, 10.0},
        {"safety.fade_turn_rate_rad_s", safety.fade_turn_rate_rad_s, "rad/s", 1.0, 200.0},
        {"safety.max_turn_rate_rad_s", safety.max_turn_rate_rad_s, "rad/s", 1.0, 200.0},
        {"safety.game_timeout_s", safety.game_timeout_s, "s", 0.05, 60.0},
        {"safety.continuous_tension_n", safety.continuous_tension_n, "N", 0.1, 100.0},
        {"safety.thermal_time_s", safety.thermal_time_s, "s", 0.1, 1000.0},
        {"safety.string_error_fade_m", safety.string_error_fade_m, "m", 0.0005, 0.1},
        {"safety.string_error_fault_m", safety.string_error_fault_m, "m", 0.001, 0.1},
        {"safety.workspace_margin_m", safety.workspace_margin_m, "m", 0.0, 0.2},
        {"safety.hand_presence_s", safety.hand_presence_s, "s", 0.0, 3600.0},
        {"safety.wrench_fade_s", safety.wrench_fade_s, "s", 0.001, 1.0},
        {"safety.contacts_full_s", safety.contacts_full_s, "s", 0.001, 1.0},
        {"safety.contacts_gone_s", safety.contacts_gone_s, "s", 0.002, 2.0},
    };
    std::string problem = first_out_of_range(ranges);
    if (!problem.empty()) {
        return problem;
    }
    if (!(safety.read_timeout_fault_s >= safety.read_timeout_fade_s)) {
        return range_sentence({"safety.read_timeout_fault_s", safety.read_timeout_fault_s, "s",
                               safety.read_timeout_fade_s, 1.0});
    }
    constexpr double kLeastFade_s = 0.001;
    return range_sentence({"safety.contacts_gone_s", safety.contacts_gone_s, "s",
                           safety.contacts_full_s + kLeastFade_s, 2.0});
}

std::string validate_fingers(const FingerSettings &fingers) {
    const ValueRange ranges[] = {
        {"fingers.sensor", static_cast<double>(fingers.sensor), "(-1: none)", -1.0,
         kSensorCount - 1.0},
        {"fingers.sensor_open", fingers.sensor_open, "(the sensor's unit)", -32768.0, 32767.0},
        {"fingers.sensor_closed", fingers.sensor_closed, "(the sensor's unit)", -32768.0, 32767.0},
        {"fingers.closed_rad", fingers.closed_rad, "rad", 0.01, 1.5},
    };
    std::string problem = first_out_of_range(ranges);
    if (problem.empty() && fingers.sensor_closed == fingers.sensor_open) {
        problem = "fingers.sensor_closed equals fingers.sensor_open; give two different readings "
                  "of the sensor.";
    }
    return problem;
}

// Checks conditions between parts.
std::string validate_together(const ServoSettings &settings) {
    if (settings.grip.kind == GripKind::rigid && (settings.tension.dof_mask & kNoGrasp) == 0) {
        return "tension.dof_mask is 64 (grasp alone), but a rigid grip has no grasp; give 1 to 63, "
               "bit k for DOF k of the wrench.";
    }
    const StringArray strongest_n = max_tensions(settings.motors);
    const double weakest_n = *std::min_element(strongest_n.begin(), strongest_n.end());
    const double pretension_n =
        std::max(settings.tension.reference_tension_n, settings.tension.min_tension_n);
    if (!(weakest_n > pretension_n)) {
        char text[256];
        std::snprintf(
            text, sizeof text,
            "motors: the weakest motor pulls %g N at its max_current_a, which is not more than the "
            "pretension of %g N; raise max_current_a or lower reference_tension_n.",
            weakest_n, pretension_n);
        return text;
    }
    return {};
}

} // namespace

std::string validate(const ServoSettings &settings) {
    const ValueRange ranges[] = {
        {"rate_hz", settings.rate_hz, "Hz", 100.0, 4000.0},
        {"velocity_cutoff_hz", settings.velocity_cutoff_hz, "Hz", 1.0, 1000.0},
        {"reopen_interval_s", settings.reopen_interval_s, "s", 0.0, 60.0},
        {"corrections.pulley_radius_m (frame.pulley_radius_m is the one used)",
         settings.corrections.pulley_radius_m, "m", 0.0, 0.0},
    };
    for (const std::string &problem :
         {first_out_of_range(ranges), validate(settings.frame),
          validate(settings.grip, settings.frame), validate(settings.strings),
          validate(settings.corrections), validate(settings.motors), validate(settings.tension),
          validate(settings.grasp), validate_fingers(settings.fingers),
          validate_safety(settings.safety), validate(settings.render),
          validate_together(settings)}) {
        if (!problem.empty()) {
            return problem;
        }
    }
    return {};
}

} // namespace spidar
