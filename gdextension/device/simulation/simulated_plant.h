// The physics of a simulated SPIDAR-G: eight strings (elastic or not) with motors, the grip with its hinge,
// and a hand that holds it. Deliberately independent of core's kinematics and wrench matrix, so that it can
// contradict them. Semi-implicit Euler at kPlantRate_hz.
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

inline constexpr double kPlantRate_hz = 40000.0; // stable to EA = 30 kN
inline constexpr double kPlantStep_s = 1.0 / kPlantRate_hz;

struct PlantSettings {
    FrameGeometry frame = make_box_frame(Vec3(kPaperHalfExtent_m));
    GripGeometry grip;
    MotorCalibration motors; // the true motors
    // count = round((length * (1 + gain error) + offset error) / metres_per_count). The length is what the
    // rotor has paid out (elastic), or the true distance (not elastic).
    double metres_per_count = kPaperMetresPerCount;
    StringArray length_offset_error_m{}; // what a calibration has to find
    StringArray length_gain_error{};     // relative: 0.01 = 1 %
    // false: strings do not stretch and rotors weigh nothing, so that tension = motor tension and friction
    // against the string's movement, exactly.
    bool elastic = true;
    double string_stiffness_ea_n = 3000.0; // k = EA / length
    double string_damping_n_s_m = 0.3;
    // What a string grows by under 10 N held for ever, relative to its length, and how long that takes. Elastic only.
    double creep = 0.0; // an estimate for a braid: 0.002
    double creep_time_s = 60.0;
    double winding_growth = 0.0;  // DrumWinding::growth; the paper's drums: 0.046
    double rotor_mass_kg = 0.017; // rotor inertia / radius^2
    double coulomb_friction_n = 0.05;
    double viscous_friction_n_s_m = 0.3;
    double current_lag_s = 0.0005;
    double grip_mass_kg = 0.06;
    double grip_inertia_kg_m2 = 4e-5;                     // isotropic
    double grasp_inertia_kg_m2 = 1e-5;                    // about grasp_angle
    double hinge_open_rad = -80.0 * 0.017453292519943295; // hinge stops, grasp_angle
    double hinge_closed_rad = 80.0 * 0.017453292519943295;
    HandFirmness firmness = HandFirmness::normal;
    // The link to the host. Currents act this late, plus a random delay of this mean; a share of reports is lost.
    double output_latency_s = 0.0;
    double output_jitter_s = 0.0;
    double report_loss = 0.0;
};

// What really is, beside what the encoders say.
struct PlantTruth {
    GripPose pose;
    GripFrame frame;
    Twist twist;
    Wrench strings; // net wrench of the strings on the grip = what the hand feels
    Wrench hand;    // what the hand puts on the grip
    StringArray tensions_n{};
    StringArray lengths_m{};
    double time_s = 0.0;
    double energy_to_hand_j = 0.0; // integral of strings . twist since the start
    std::uint64_t resets = 0; // times the physics diverged and began again at the hand's target
};

// Slack string: without power a real one sags and the counts are lost. Here each spool takes its slack up, so
// that the pose stays true with the motors off. It pulls on the rotor only, only while there is slack, so the
// hand feels nothing of it.
inline constexpr double kTakeUpForce_n =
    1.0; // follows a hand at 1 m/s against friction and rotor mass
// Stiff enough that 0.1 N of friction leaves 5 um of slack: less than half a count.
inline constexpr double kTakeUpStiffness_n_m = 2.0e4;
// The hand's arms end here: no target beyond the motors' bounding box less a pole's half length, per axis.
[[nodiscard]] Vec3 clamped_to_reach(const PlantSettings &settings, const Vec3 &position_m) noexcept;
inline constexpr double kMaxAdvance_s = 1.0; // a longer step is cut to this

// Empty when usable; else one sentence naming the field, the value, the unit and the remedy. Allocates.
[[nodiscard]] std::string validate(const PlantSettings &settings);

// One thread owns a plant. Starts at the grip's rest pose, hand at rest there, strings taut without tension.
class SimulatedPlant {
public:
    // Precondition: validate(settings) is empty.
    explicit SimulatedPlant(const PlantSettings &settings) noexcept;

    // Grip and hand at rest at this pose. An unusable pose changes nothing.
    void reset(const HandTarget &pose) noexcept;
    // Unusable targets change nothing; the position is brought within reach, the angle within the hinge stops.
    void set_hand_target(const HandTarget &target) noexcept;
    void set_hand_firmness(HandFirmness firmness) noexcept { hand_.set_firmness(firmness); }
    // Held until the next call. A current that is not >= 0 gives 0 A; above max_current_a, that.
    void set_currents(const StringArray &currents_a) noexcept;
    // The grip alone: the hand puts nothing on it, until it holds it again.
    void set_hand_released(bool released) noexcept { hand_.set_released(released); }
    // Bit i: the drum of string i is caught: it neither pays out nor winds in.
    void set_jammed_strings(std::uint8_t mask) noexcept { jammed_ = mask; }
    // Bit i: string i is broken: it pulls no more, and its motor winds the loose end in.
    void set_broken_strings(std::uint8_t mask) noexcept;

    // Runs the whole steps of 1 / kPlantRate_hz that fit, to the nearest, and carries the rest. Not finite or
    // not positive: nothing happens.
    void advance(double dt_s) noexcept;

    [[nodiscard]] CountArray counts() const noexcept;
    [[nodiscard]] PlantTruth truth() const noexcept;
    [[nodiscard]] double time_s() const noexcept;
    // Kinetic energy of grip, hand and rotors and what strings and the hand's springs store (unit: J).
    [[nodiscard]] double mechanical_energy_j() const noexcept;
    // Work of motors and take-up on the rotors since the start. With a hand at rest, mechanical energy
    // grows by no more than this (elastic only).
    [[nodiscard]] double supplied_energy_j() const noexcept { return supplied_energy_j_; }

private:
    // Poles, tensions and what they do to the grip, at one state.
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
    // String i without tension.
    [[nodiscard]] double slack_length_m(std::size_t i) const noexcept {
        return rotors_m_[i] * (1.0 + crept_[i]);
    }
    void lay_rotors(std::uint8_t mask) noexcept;
    [[nodiscard]] bool diverged() const noexcept;

    PlantSettings settings_;
    SimulatedHand hand_;
    HandTarget target_; // brought within reach
    std::uint8_t broken_ = 0;
    std::uint8_t jammed_ = 0;

    // Precomputed.
    StringArray newtons_per_ampere_{};
    StringArray home_lengths_m_{};    // where nothing is wound off the drums yet
    double current_gain_ = 1.0;       // share of the way to the commanded tension in one step
    double rotor_viscous_gain_ = 1.0; // 1 / (1 + b dt / m)
    double coulomb_speed_change_ = 0.0;
    double take_up_damping_n_s_m_ = 0.0;
    double coulomb_slope_n_s_m_ = 0.0;

    // State.
    Vec3 position_m_{0.0};
    Quat rotation_{1.0, 0.0, 0.0, 0.0};
    double grasp_angle_rad_ = 0.0;
    Twist twist_;
    StringArray rotors_m_{}; // string paid out
    StringArray rotor_speeds_m_s_{};
    StringArray commanded_n_{};
    StringArray motor_tensions_n_{}; // after the current lag
    StringArray crept_{};            // strain
    std::uint64_t steps_ = 0;
    double carry_steps_ = 0.0;
    double energy_to_hand_j_ = 0.0;
    double supplied_energy_j_ = 0.0;
    std::uint64_t resets_ = 0;
};

} // namespace spidar
