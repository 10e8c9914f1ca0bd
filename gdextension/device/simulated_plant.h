// The physics of a simulated SPIDAR-G: eight strings (elastic or not) with motors, the grip with its hinge,
// and a hand that holds it. Deliberately independent of core's kinematics and wrench matrix, so that it can
// contradict them. Semi-implicit Euler at kPlantRate_hz.
#pragma once

#include <cstdint>
#include <string>

#include "core/frame_geometry.h"
#include "core/grip_geometry.h"
#include "core/motor_calibration.h"
#include "core/string_calibration.h"
#include "core/types.h"

namespace spidar {

inline constexpr double kPlantRate_hz = 40000.0; // stable to EA = 30 kN

enum class HandFirmness : std::uint8_t { light = 0, normal = 1, firm = 2 };

// Where the hand wants the grip (device frame).
struct HandTarget {
    Vec3 position_m{0.0};
    Mat3 rotation{1.0};
    double grasp_angle_rad = 0.0;
};

struct PlantSettings {
    FrameGeometry frame = make_box_frame(Vec3(kPaperHalfExtent_m));
    GripGeometry grip;
    MotorCalibration motors; // the true motors
    // True length read by the encoders: count = round((length - offset_error) / scale) + zero.
    double metres_per_count = kPaperMetresPerCount;
    StringArray length_offset_error_m{}; // what a calibration has to find
    StringArray length_gain_error{};     // relative: 0.01 = 1 %
    bool elastic = true;
    double string_stiffness_ea_n = 3000.0; // k = EA / length
    double string_damping_n_s_m = 0.3;
    double rotor_mass_kg = 0.017;          // rotor inertia / radius^2
    double coulomb_friction_n = 0.05;
    double viscous_friction_n_s_m = 0.3;
    double current_lag_s = 0.0005;
    double grip_mass_kg = 0.06;
    double grip_inertia_kg_m2 = 4e-5;      // isotropic
    double grasp_inertia_kg_m2 = 1e-5;     // about grasp_angle
    double hinge_open_rad = -80.0 * 0.017453292519943295;   // hinge stops, grasp_angle
    double hinge_closed_rad = 80.0 * 0.017453292519943295;
    HandFirmness firmness = HandFirmness::normal;
};

// What really is, beside what the encoders say.
struct PlantTruth {
    GripPose pose;
    GripFrame frame;
    Twist twist;
    Wrench strings;      // net wrench of the strings on the grip = what the hand feels
    Wrench hand;         // what the hand puts on the grip
    StringArray tensions_n{};
    StringArray lengths_m{};
    double time_s = 0.0;
    double energy_to_hand_j = 0.0; // integral of strings . twist since the start
};

[[nodiscard]] std::string validate(const PlantSettings &settings);

} // namespace spidar
