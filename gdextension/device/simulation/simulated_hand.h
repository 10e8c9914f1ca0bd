// A hand that holds the simulated grip: a spring-damper in all seven DOF, with the hand's mass, that
// carries the grip towards a target.
#pragma once

#include <cstdint>

#include <glm/gtc/quaternion.hpp>

#include "core/base/types.h"

namespace spidar {

using Quat = glm::dquat;

enum class HandFirmness : std::uint8_t { light = 0, normal = 1, firm = 2 };

// Where the hand wants the grip (device frame).
struct HandTarget {
    Vec3 position_m{0.0};
    Mat3 rotation{1.0};
    double grasp_angle_rad = 0.0;
};

// False when a number is not finite or the rotation is not one (orthonormal to kRotationTolerance, det +1).
[[nodiscard]] bool is_usable(const HandTarget &target) noexcept;
inline constexpr double kRotationTolerance = 1e-3; // a game's single-precision Basis is far inside

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

// Translation: the three hands that the contact gains were tested with; a measured arm (0.55 kg, 6.5 Ns/m,
// 135 N/m) lies among them. Rotation: the same hand holding at the pole's half length, mass and stiffness times
// (40 mm)^2. Grasp: the same per radian of half the grasp angle, so a quarter. Their damping is 0.7 of critical
// with the default grip, as a hand that turns does not ring.
inline constexpr HandImpedance kLightHand{0.05,   50.0, 1.0,  8.0e-5, 0.08,
                                          4.3e-3, 2e-5, 0.02, 1.1e-3};
inline constexpr HandImpedance kNormalHand{0.3,    300.0,  5.0,  4.8e-4, 0.48,
                                           2.2e-2, 1.2e-4, 0.12, 5.5e-3};
inline constexpr HandImpedance kFirmHand{0.8,    700.0,  12.0, 1.28e-3, 1.12,
                                         5.4e-2, 3.2e-4, 0.28, 1.35e-2};

// A value outside the enumeration gives the normal hand.
[[nodiscard]] const HandImpedance &impedance_of(HandFirmness firmness) noexcept;

// The fastest that a hand follows a target, so that one that jumps does not launch the grip.
inline constexpr double kHandMaxSpeed_m_s = 1.0;
inline constexpr double kHandMaxTurnRate_rad_s = 6.0; // rotation and grasp angle
// How fast it gets there; just above what stopping from full speed takes (speed * path rate / e), so that the
// limit never makes the path overshoot.
inline constexpr double kHandMaxAcceleration_m_s2 = 30.0;
inline constexpr double kHandMaxTurnAcceleration_rad_s2 = 180.0;
// Bandwidth of the path (critically damped, unit: rad/s): a target that comes in 60 Hz steps is followed
// smoothly, 2 / 60 s behind.
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
    // At rest at the target, path and all. An unusable target changes nothing.
    void reset(const HandTarget &target) noexcept;
    // An unusable target changes nothing.
    void set_target(const HandTarget &target) noexcept;
    void set_firmness(HandFirmness firmness) noexcept;
    // Let go: no spring, no damper and next to no mass, until it holds again.
    void set_released(bool released) noexcept;

    // Moves the path on.
    void advance(double dt_s) noexcept;

    // Spring and damper between the path and the grip: what the hand puts on the grip (its own mass aside).
    [[nodiscard]] Wrench wrench(const Vec3 &position_m, const Quat &rotation,
                                double grasp_angle_rad, const Twist &twist) const noexcept;
    // Energy in the hand's springs (unit: J).
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
    bool arrived_ = true; // path at the target and at rest: nothing to do
};

// The shortest rotation vector of a unit quaternion (unit: rad).
[[nodiscard]] Vec3 rotation_vector(const Quat &rotation) noexcept;
// `rotation` turned on by angular velocity * dt, kept at unit length.
[[nodiscard]] Quat turned(const Quat &rotation, const Vec3 &angular_rad_s, double dt_s) noexcept;

} // namespace spidar
