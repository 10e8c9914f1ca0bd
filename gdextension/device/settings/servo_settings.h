// All settings of a servo loop, as plain values with safe defaults.
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
    double arming_time_s = 1.0;         // forces rise from 0 to full over this time
    double tension_slew_n_per_ms = 1.0; // largest change of a string's tension
    double max_force_n = 8.0;           // of the request; a larger one is scaled down
    double max_moment_nm = 0.4;
    double max_grasp_torque_nm = 0.4;
    double max_count_speed_m_s = 5.0;    // a faster string is a bad sample
    int max_bad_samples = 3;             // this many in a row latch the fault
    double read_timeout_fade_s = 0.005;  // no report for this long: the wrench fades in 20 ms
    double read_timeout_fault_s = 0.020; // no report for this long: motors off
    double max_grip_speed_m_s = 2.0;     // faster: motors off
    double fade_grip_speed_m_s = 1.2;    // faster for 3 ms: the wrench fades in 20 ms
    double fade_turn_rate_rad_s = 15.0;  // faster for 3 ms: the wrench fades in 20 ms
    double max_turn_rate_rad_s = 30.0;   // faster: motors off
    double wrench_fade_s = 0.050;        // fade of a wrench after its duration
    double contacts_full_s = 0.100;      // age up to which contacts act in full
    double contacts_gone_s = 0.300;      // age at which contacts have faded out
    double game_timeout_s = 0.5;         // no heartbeat of the game for this long: disarmed
    double continuous_tension_n = 3.5;   // tension that a motor bears continuously
    double thermal_time_s = 12.0;        // thermal time constant of a motor's winding
    double string_error_fade_m = 0.002;  // rise of the parity error that fades the wrench
    double string_error_fault_m = 0.006; // parity error above this for 50 ms: motors off
    double workspace_margin_m = 0.01;    // soft wall this far inside the reach; 0: none
    // Motion that arming a real device needs within this time; 0: none.
    double hand_presence_s = 5.0;
};

// Sources that close a rigid grip's fingers (device/tracking/fingers.h). The one that closes them
// most counts.
struct FingerSettings {
    std::uint8_t button_mask = 0x01; // device buttons that close: bit i is button i
    bool by_game = true;             // use HapticCommand::grasp_share
    int sensor = -1;                 // index in DeviceReading::sensors; -1: none
    double sensor_open = 0.0;        // sensor value of open fingers
    double sensor_closed = 1000.0;   // sensor value of closed fingers; may be the smaller one
    double closed_rad = 50.0 * 0.017453292519943295; // grasp angle of closed fingers
};

struct ServoSettings {
    double rate_hz = 1000.0;          // 100 to 4000
    double velocity_cutoff_hz = 60.0; // one-pole filter of the twist
    // Threaded loop: interval between attempts to open a device (unit: s). With 0 the start fails
    // if the device does not open.
    double reopen_interval_s = 0.0;
    FrameGeometry frame = make_box_frame(Vec3(kPaperHalfExtent_m));
    GripGeometry grip;
    StringCalibration strings; // must be set: a scale of zero is refused
    // Corrections for winding and for stretch under the last commanded tensions; off by default.
    // pulley_radius_m must be 0: `frame` holds the pulleys.
    LengthCorrections corrections;
    MotorCalibration motors;
    TensionSettings tension;
    GraspSettings grasp;
    FingerSettings fingers;
    SafetySettings safety;
    RenderSettings render;
};

// Checks restored memory: see core/base/sound_state.h.
[[nodiscard]] inline bool is_sound(const FingerSettings &fingers) noexcept {
    return are_flags(fingers.by_game) && fingers.sensor >= -1 && fingers.sensor < kSensorCount;
}
[[nodiscard]] inline bool is_sound(const ServoSettings &settings) noexcept {
    return are_flags(settings.render.caps_from_latency) && is_sound(settings.grip) &&
           is_sound(settings.fingers) && is_tally(settings.safety.max_bad_samples);
}

// Returns an empty string when usable, else a sentence with field, value, unit and remedy.
[[nodiscard]] std::string validate(const ServoSettings &settings);

} // namespace spidar
