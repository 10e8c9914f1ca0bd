// All that a servo loop is told before it starts. Plain values with safe defaults.
#pragma once

#include <cstdint>
#include <string>

#include "core/base/sound_state.h"
#include "core/calibration/length_corrections.h"
#include "core/calibration/motor_calibration.h"
#include "core/calibration/string_calibration.h"
#include "core/geometry/frame_geometry.h"
#include "core/geometry/grip_geometry.h"
#include "core/kinematics/grasp_detector.h"
#include "core/tension/tension_solver.h"
#include "device/settings/render_settings.h"

namespace spidar {

struct SafetySettings {
    double arming_time_s = 1.0;         // forces rise from 0 to 1 over this
    double tension_slew_n_per_ms = 1.0; // of each string
    double max_force_n = 8.0;           // of the request; larger is scaled, direction kept
    double max_moment_nm = 0.4;
    double max_grasp_torque_nm = 0.4;
    double max_count_speed_m_s = 5.0;    // a string that seems faster is a bad sample
    int max_bad_samples = 3;             // in a row; then the fault latches
    double read_timeout_fade_s = 0.005;  // no report for this long: wrench to zero in 20 ms
    double read_timeout_fault_s = 0.020; // motors off
    double max_grip_speed_m_s = 2.0;     // over-speed: motors off
    double fade_grip_speed_m_s = 1.2;    // held for 3 ms: wrench to zero in 20 ms, back below it
    double fade_turn_rate_rad_s = 15.0;  // the same for rotation
    double max_turn_rate_rad_s = 30.0;   // over-speed: motors off
    double wrench_fade_s = 0.050;        // after its duration
    double contacts_full_s = 0.100;      // age to which contacts act in full
    double contacts_gone_s = 0.300;      // age at which they have faded out
    double game_timeout_s = 0.5;         // no heartbeat of the game for this long: disarmed
    double continuous_tension_n = 3.5;   // what a motor bears for ever
    double thermal_time_s = 12.0;        // time constant of its winding
    double string_error_fade_m = 0.002;  // lengths contradict each other anew by this: fade
    double string_error_fault_m = 0.006; // for 50 ms: motors off
    double workspace_margin_m = 0.01;    // soft wall this far inside the reach of the grip; 0: none
    double hand_presence_s = 5.0;        // real devices: the grip moved within this before arming
};

// What closes the fingers of a rigid grip (device/tracking/fingers.h); several may, the one that closes most counts.
struct FingerSettings {
    std::uint8_t button_mask = 0x01;                 // buttons of the device: bit i is button i
    bool by_game = true;                             // HapticCommand::grasp_share
    int sensor = -1;                                 // of DeviceReading::sensors; -1: none
    double sensor_open = 0.0;                        // its value with open fingers
    double sensor_closed = 1000.0;                   // and with closed ones; may be the smaller one
    double closed_rad = 50.0 * 0.017453292519943295; // grasp angle of closed fingers
};

struct ServoSettings {
    double rate_hz = 1000.0;          // 100 to 4000
    double velocity_cutoff_hz = 60.0; // one-pole filter of the twist
    // Threaded: a device that does not open is tried again this often, by the loop's thread. 0: start fails.
    double reopen_interval_s = 0.0;
    FrameGeometry frame = make_box_frame(Vec3(kPaperHalfExtent_m));
    GripGeometry grip;
    StringCalibration strings; // must be given: zero scale is refused
    // Winding and stretch by the tensions of the last cycles; off by default. Its pulley stays 0: `frame` has it.
    LengthCorrections corrections;
    MotorCalibration motors;
    TensionSettings tension;
    GraspSettings grasp;
    FingerSettings fingers;
    SafetySettings safety;
    RenderSettings render;
};

// core/base/sound_state.h
[[nodiscard]] inline bool is_sound(const FingerSettings &fingers) noexcept {
    return are_flags(fingers.by_game) && fingers.sensor >= -1 && fingers.sensor < kSensorCount;
}
[[nodiscard]] inline bool is_sound(const ServoSettings &settings) noexcept {
    return are_flags(settings.render.caps_from_latency) && is_sound(settings.grip) &&
           is_sound(settings.fingers) && is_tally(settings.safety.max_bad_samples);
}

// Empty when usable; else one sentence naming the field, the value, the unit and the remedy. Checks every part.
[[nodiscard]] std::string validate(const ServoSettings &settings);

} // namespace spidar
