// A hand that holds the simulated grip: a spring and damper in all seven DOF, with the hand's mass,
// that moves the grip toward a target.
#pragma once

#include <cstdint>

#include <glm/gtc/quaternion.hpp>

#include "core/base/types.h"

namespace spidar {

using Quat = glm::dquat;

enum class HandFirmness : std::uint8_t { light = 0, normal = 1, firm = 2 };

// Where the hand moves the grip to (device frame).
struct HandTarget {
    Vec3 position_m{0.0};
    Mat3 rotation{1.0};
    double grasp_angle_rad = 0.0;
};

// Returns false when a number is not finite or `rotation` is not orthonormal with determinant +1,
// to kRotationTolerance.
[[nodiscard]] bool is_usable(const HandTarget &target) noexcept;
// Tolerance of a rotation matrix. A game's single-precision Basis errs far less.
inline constexpr double kRotationTolerance = 1e-3;

struct HandImpedance {
    double mass_kg;
    double stiffness_n_m;
    double damping_n_s_m;
    double inertia_kg_m2;
    double stiffness_nm_rad;
    double damping_nm_s_rad;
    double grasp_inertia_kg_m2;
    double grasp_stiffness_nm_rad; // per radian of grasp_angle
    double grasp_damping_nm_s_rad;
};

// Masses and springs of three hands. Translation: the hands with which the gains of contacts were
// tested; a measured arm (0.55 kg, 6.5 N s/m, 135 N/m) lies between the light and the firm one.
// Rotation: mass and stiffness of the same hand times (40 mm)^2; 40 mm is the pole's half length.
// Grasp: a quarter of the rotation's values, since each pole turns by half the grasp angle. With
// the default grip, rotation and grasp are damped at 0.7 of critical, since a turning hand does not
// oscillate.
inline constexpr HandImpedance kLightHand{0.05,   50.0, 1.0,  8.0e-5, 0.08,
                                          4.3e-3, 2e-5, 0.02, 1.1e-3};
inline constexpr HandImpedance kNormalHand{0.3,    300.0,  5.0,  4.8e-4, 0.48,
                                           2.2e-2, 1.2e-4, 0.12, 5.5e-3};
inline constexpr HandImpedance kFirmHand{0.8,    700.0,  12.0, 1.28e-3, 1.12,
                                         5.4e-2, 3.2e-4, 0.28, 1.35e-2};

// Returns the normal hand for a value outside the enumeration.
[[nodiscard]] const HandImpedance &impedance_of(HandFirmness firmness) noexcept;

// Largest speed of a hand that follows a target: a jump of the target must not throw the grip.
inline constexpr double kHandMaxSpeed_m_s = 1.0;
// The same for rotation and grasp angle.
inline constexpr double kHandMaxTurnRate_rad_s = 6.0;
// Largest acceleration of the path. It is above what stopping from full speed needs (speed *
// kHandPathRate_rad_s / e), so that the limit causes no overshoot.
inline constexpr double kHandMaxAcceleration_m_s2 = 30.0;
inline constexpr double kHandMaxTurnAcceleration_rad_s2 = 180.0;
// Bandwidth of the critically damped path (unit: rad/s). The path follows a target that is updated
// at 60 Hz smoothly, 2 / 60 s behind it.
inline constexpr double kHandPathRate_rad_s = 60.0;

// Position, velocity and acceleration of the hand's path in all seven DOF.
struct HandPath {
    Vec3 position_m{0.0};
    Quat rotation{1.0, 0.0, 0.0, 0.0};
    double grasp_angle_rad = 0.0;
    Twist velocity;
    Vec3 acceleration_m_s2{0.0};
    Vec3 angular_acceleration_rad_s2{0.0};
    double grasp_acceleration_rad_s2 = 0.0;
};

class SimulatedHand {
public:
    // Puts the path at rest at the target. An unusable target changes nothing.
    void reset(const HandTarget &target) noexcept;
    // Sets the target of the path. An unusable target changes nothing.
    void set_target(const HandTarget &target) noexcept;
    void set_firmness(HandFirmness firmness) noexcept;
    // True: the hand lets go of the grip: no spring, no damper, almost no mass. False: it holds the
    // grip again.
    void set_released(bool released) noexcept;

    // Advances the path.
    void advance(double dt_s) noexcept;

    // Returns the wrench on the grip from spring and damper between path and grip, without the
    // hand's mass.
    [[nodiscard]] Wrench wrench(const Vec3 &position_m, const Quat &rotation,
                                double grasp_angle_rad, const Twist &twist) const noexcept;
    // Returns the energy in the hand's springs (unit: J).
    [[nodiscard]] double spring_energy_j(const Vec3 &position_m, const Quat &rotation,
                                         double grasp_angle_rad) const noexcept;

    [[nodiscard]] const HandImpedance &impedance() const noexcept { return impedance_; }
    [[nodiscard]] const HandPath &path() const noexcept { return path_; }

private:
    HandImpedance impedance_ = kNormalHand;
    HandFirmness firmness_ = HandFirmness::normal;
    bool released_ = false;
    HandPath path_;
    Vec3 target_position_m_{0.0};
    Quat target_rotation_{1.0, 0.0, 0.0, 0.0};
    double target_grasp_rad_ = 0.0;
    bool arrived_ = true; // the path is at rest at the target
};

// Returns the shortest rotation vector of a unit quaternion (unit: rad).
[[nodiscard]] Vec3 rotation_vector(const Quat &rotation) noexcept;
// Returns `rotation` turned by angular_rad_s * dt_s, with unit length.
[[nodiscard]] Quat turned(const Quat &rotation, const Vec3 &angular_rad_s, double dt_s) noexcept;

} // namespace spidar
