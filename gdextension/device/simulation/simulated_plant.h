// Physics of a simulated SPIDAR-G: eight strings (elastic or not) with motors, the grip with its
// hinge, and a hand. It does not use core's forward kinematics and wrench matrix, so that it can
// reveal errors in them. Integrated by the semi-implicit Euler method at kPlantRate_hz.
#pragma once

#include <cstdint>
#include <string>

#include "core/base/types.h"
#include "core/calibration/motor_calibration.h"
#include "core/calibration/string_calibration.h"
#include "core/geometry/frame_geometry.h"
#include "core/geometry/grip_geometry.h"
#include "device/simulation/drum_winding.h"
#include "device/simulation/simulated_hand.h"

namespace spidar {

// Rate of the integration, which is stable up to string_stiffness_ea_n = 30 kN.
inline constexpr double kPlantRate_hz = 40000.0;
inline constexpr double kPlantStep_s = 1.0 / kPlantRate_hz;

struct PlantSettings {
    FrameGeometry frame = make_box_frame(Vec3(kPaperHalfExtent_m));
    GripGeometry grip;
    MotorCalibration motors; // true motor parameters
    // count = round((length * (1 + gain error) + offset error) / metres_per_count). The length is
    // what the rotor has paid out (elastic) or the true distance (not elastic); a drum with
    // winding_growth shows DrumWinding::turned_m().
    double metres_per_count = kPaperMetresPerCount;
    StringArray length_offset_error_m{}; // which a calibration has to find
    StringArray length_gain_error{};     // relative: 0.01 = 1 %
    // False: strings do not stretch and rotors have no mass. The tension is then the motor tension
    // plus the friction of the moving string, but at least 0.
    bool elastic = true;
    double string_stiffness_ea_n = 3000.0; // stiffness k = EA / length
    double string_damping_n_s_m = 0.3;
    // Relative growth of a string under a constant 10 N after a long time. Elastic strings only.
    // Estimate for a braid: 0.002.
    double creep = 0.0;
    // Time constant of the creep.
    double creep_time_s = 60.0;
    // See DrumWinding::growth; the paper's drums: 0.046.
    double winding_growth = 0.0;
    double rotor_mass_kg = 0.017; // rotor inertia / radius^2
    double coulomb_friction_n = 0.05;
    double viscous_friction_n_s_m = 0.3;
    double current_lag_s = 0.0005;
    double grip_mass_kg = 0.06;
    double grip_inertia_kg_m2 = 4e-5;  // isotropic
    double grasp_inertia_kg_m2 = 1e-5; // about grasp_angle
    // Grasp angle of the hinge's stop on the open side.
    double hinge_open_rad = -80.0 * 0.017453292519943295;
    // Grasp angle of the hinge's stop on the closed side.
    double hinge_closed_rad = 80.0 * 0.017453292519943295;
    HandFirmness firmness = HandFirmness::normal;
    // Constant delay of currents on the link from the host.
    double output_latency_s = 0.0;
    // Mean of an additional random delay of currents.
    double output_jitter_s = 0.0;
    // Share of reports that are lost, 0..1.
    double report_loss = 0.0;
};

// The true state of the plant, of which the encoders show a part.
struct PlantTruth {
    GripPose pose;
    GripFrame frame;
    Twist twist;
    // Net wrench of the strings on the grip, which the hand feels.
    Wrench strings;
    Wrench hand; // wrench of the hand on the grip
    StringArray tensions_n{};
    StringArray lengths_m{};
    double time_s = 0.0;
    double energy_to_hand_j = 0.0; // time integral of strings . twist since the start
    // How often the physics diverged and restarted at the hand's target.
    std::uint64_t resets = 0;
};

// Largest force with which a drum takes up slack string (unit: N): enough to follow a hand at 1 m/s
// against friction and rotor mass. A real slack string sags, and its count no longer shows its
// length; here the pose stays right with the motors off. The force acts on the rotor only, and only
// while its string is slack, so that the hand does not feel it.
inline constexpr double kTakeUpForce_n = 1.0;
// Take-up force per slack. A friction of 0.1 N leaves 5 um of slack, less than half a count.
inline constexpr double kTakeUpStiffness_n_m = 2.0e4;
// Returns the position clamped to the reach of the hand's arm: the motors' bounding box less a
// pole's half length, per axis.
[[nodiscard]] Vec3 clamped_to_reach(const PlantSettings &settings, const Vec3 &position_m) noexcept;
// Longest time that one advance() runs (unit: s); a longer one is clamped.
inline constexpr double kMaxAdvance_s = 1.0;

// Returns an empty string when usable, else a sentence with field, value, unit and remedy.
[[nodiscard]] std::string validate(const PlantSettings &settings);

// The plant, owned by one thread. Starts at rest at the rest pose, strings taut without tension.
class SimulatedPlant {
public:
    // Requires that validate(settings) is empty.
    explicit SimulatedPlant(const PlantSettings &settings) noexcept;

    // Puts grip and hand at rest at this pose. An unusable pose changes nothing.
    void reset(const HandTarget &pose) noexcept;
    // Sets the hand's target. The position is clamped to the reach, the angle to the hinge stops.
    // An unusable target changes nothing.
    void set_hand_target(const HandTarget &target) noexcept;
    void set_hand_firmness(HandFirmness firmness) noexcept { hand_.set_firmness(firmness); }
    // Sets the currents, which act until the next call. They are clamped to max_current_a; NaN or a
    // negative value gives 0 A.
    void set_currents(const StringArray &currents_a) noexcept;
    // See SimulatedHand::set_released().
    void set_hand_released(bool released) noexcept { hand_.set_released(released); }
    // Bit i: the drum of string i is blocked and neither pays out nor winds in.
    void set_jammed_strings(std::uint8_t mask) noexcept { jammed_ = mask; }
    // Bit i: string i is broken. It does not pull, and its motor winds the loose end in. A string
    // whose bit is cleared is tied on again, taut.
    void set_broken_strings(std::uint8_t mask) noexcept;

    // Runs dt_s, at most kMaxAdvance_s, in whole steps of 1 / kPlantRate_hz and carries the
    // remainder. Ignores a time that is not finite or not positive.
    void advance(double dt_s) noexcept;

    [[nodiscard]] CountArray counts() const noexcept;
    [[nodiscard]] PlantTruth truth() const noexcept;
    [[nodiscard]] double time_s() const noexcept;
    // Kinetic energy of grip, hand and rotors plus energy in strings and hand springs (unit: J).
    [[nodiscard]] double mechanical_energy_j() const noexcept;
    // Work of motors and take-up on the rotors since the start (unit: J). While the hand's path is
    // at rest, the mechanical energy grows by no more than this (elastic only).
    [[nodiscard]] double supplied_energy_j() const noexcept { return supplied_energy_j_; }

private:
    // Poles, string tensions and their wrench on the grip in one state.
    struct StringForces {
        Vec3 r1_m{0.0};
        Vec3 r2_m{0.0};
        StringArray lengths_m{};
        StringArray length_rates_m_s{};
        StringArray tensions_n{};
        Wrench wrench;
    };
    void step() noexcept;
    [[nodiscard]] StringForces string_forces() const noexcept;
    void step_rotors(const StringForces &forces) noexcept;
    void creep(const StringForces &forces) noexcept;
    [[nodiscard]] static bool has_bit(std::uint8_t mask, std::size_t string) noexcept {
        return ((mask >> string) & 1U) != 0;
    }
    // Returns the length of string i at zero tension.
    [[nodiscard]] double slack_length_m(std::size_t i) const noexcept {
        return rotors_m_[i] * (1.0 + crept_[i]);
    }
    void lay_rotors(std::uint8_t mask) noexcept;
    [[nodiscard]] bool diverged() const noexcept;

    PlantSettings settings_;
    SimulatedHand hand_;
    HandTarget target_; // clamped to the reach
    std::uint8_t broken_ = 0;
    std::uint8_t jammed_ = 0;

    // Precomputed constants.
    StringArray newtons_per_ampere_{};
    // String lengths at the rest pose, from which DrumWinding counts what is paid out.
    StringArray home_lengths_m_{};
    // Share of the way to the commanded tension in one step.
    double current_gain_ = 1.0;
    double rotor_viscous_gain_ = 1.0; // 1 / (1 + b dt / m)
    double coulomb_speed_change_ = 0.0;
    double take_up_damping_n_s_m_ = 0.0;
    double coulomb_slope_n_s_m_ = 0.0;

    // State of the plant.
    Vec3 position_m_{0.0};
    Quat rotation_{1.0, 0.0, 0.0, 0.0};
    double grasp_angle_rad_ = 0.0;
    Twist twist_;
    StringArray rotors_m_{}; // length of string paid out
    StringArray rotor_speeds_m_s_{};
    StringArray commanded_n_{};
    StringArray motor_tensions_n_{}; // after the motors' current lag
    StringArray crept_{};            // strain
    std::uint64_t steps_ = 0;
    double carry_steps_ = 0.0;
    double energy_to_hand_j_ = 0.0;
    double supplied_energy_j_ = 0.0;
    std::uint64_t resets_ = 0;
};

} // namespace spidar
