#include "device/simulation/simulated_hand.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "core/base/finite.h"

namespace spidar {

namespace {

// Below this the series of asin is exact to double precision (next term 0.023 n^10 = 2e-15).
constexpr double kSeriesLimit = 0.05;
// Distance and speed below which a path has arrived, far below an encoder count. Snapping to the
// target makes a hand at rest exactly at rest.
constexpr double kArrivedDistance = 1e-10; // m, rad
constexpr double kArrivedSpeed = 1e-9;     // m/s, rad/s

// A gram keeps a grip without mass from dividing by zero.
constexpr HandImpedance kNoHand{1e-3, 0.0, 0.0, 1e-6, 0.0, 0.0, 2.5e-7, 0.0, 0.0};

Vec3 no_longer_than(const Vec3 &v, double limit) noexcept {
    const double squared = glm::dot(v, v);
    return squared > limit * limit ? v * (limit / std::sqrt(squared)) : v;
}

// Returns the new velocity of a critically damped approach with limited acceleration and speed.
Vec3 approach(const Vec3 &error, const Vec3 &velocity, double max_speed, double max_acceleration,
              double dt_s) noexcept {
    const double w = kHandPathRate_rad_s;
    const Vec3 acceleration = no_longer_than(w * w * error - 2.0 * w * velocity, max_acceleration);
    return no_longer_than(velocity + dt_s * acceleration, max_speed);
}

bool below(const Vec3 &v, double limit) noexcept {
    return glm::dot(v, v) < limit * limit;
}

} // namespace

bool is_usable(const HandTarget &target) noexcept {
    if (!all_finite(target.position_m, target.grasp_angle_rad)) {
        return false;
    }
    const Mat3 gram = glm::transpose(target.rotation) * target.rotation;
    for (int column = 0; column < 3; ++column) {
        for (int row = 0; row < 3; ++row) {
            const double expected = column == row ? 1.0 : 0.0;
            if (!(std::abs(gram[column][row] - expected) <= kRotationTolerance)) {
                return false;
            }
        }
    }
    return glm::determinant(target.rotation) > 0.0;
}

const HandImpedance &impedance_of(HandFirmness firmness) noexcept {
    switch (firmness) {
    case HandFirmness::light:
        return kLightHand;
    case HandFirmness::firm:
        return kFirmHand;
    case HandFirmness::normal:
        break;
    }
    return kNormalHand;
}

Vec3 rotation_vector(const Quat &rotation) noexcept {
    const double sign =
        rotation.w < 0.0 ? -1.0 : 1.0; // q and -q are one rotation: take the shorter way
    const Vec3 v = sign * Vec3(rotation.x, rotation.y, rotation.z);
    const double squared = glm::dot(v, v); // sin^2(angle / 2)
    if (squared < kSeriesLimit * kSeriesLimit) {
        return v * (2.0 + squared * (1.0 / 3.0 + squared * (3.0 / 20.0 +
                                                            squared * (5.0 / 56.0 +
                                                                       squared * (35.0 / 576.0)))));
    }
    const double sine = std::sqrt(squared);
    return v * (2.0 * std::atan2(sine, sign * rotation.w) / sine);
}

Quat turned(const Quat &rotation, const Vec3 &angular_rad_s, double dt_s) noexcept {
    const Vec3 half = 0.5 * dt_s * angular_rad_s;
    const Quat next = rotation + Quat(0.0, half.x, half.y, half.z) * rotation;
    // One Newton step towards unit length: exact to rounding so close to 1, and without a square
    // root.
    const double norm_squared =
        next.w * next.w + next.x * next.x + next.y * next.y + next.z * next.z;
    return next * (1.5 - 0.5 * norm_squared);
}

void SimulatedHand::reset(const HandTarget &target) noexcept {
    if (!is_usable(target)) {
        return;
    }
    set_target(target);
    path_ = {};
    path_.position_m = target_position_m_;
    path_.rotation = target_rotation_;
    path_.grasp_angle_rad = target_grasp_rad_;
    arrived_ = true;
}

void SimulatedHand::set_target(const HandTarget &target) noexcept {
    if (!is_usable(target)) {
        return;
    }
    target_position_m_ = target.position_m;
    target_rotation_ = glm::normalize(glm::quat_cast(target.rotation));
    target_grasp_rad_ = target.grasp_angle_rad;
    arrived_ = false;
}

void SimulatedHand::set_firmness(HandFirmness firmness) noexcept {
    firmness_ = firmness;
    impedance_ = released_ ? kNoHand : impedance_of(firmness);
}

void SimulatedHand::set_released(bool released) noexcept {
    if (released != released_) {
        released_ = released;
        set_firmness(firmness_);
    }
}

void SimulatedHand::advance(double dt_s) noexcept {
    if (arrived_) {
        return;
    }
    const Vec3 position_error = target_position_m_ - path_.position_m;
    const Vec3 rotation_error = rotation_vector(target_rotation_ * glm::conjugate(path_.rotation));
    const Vec3 grasp_error(target_grasp_rad_ - path_.grasp_angle_rad, 0.0, 0.0);
    const Twist &old = path_.velocity;
    if (below(position_error, kArrivedDistance) && below(rotation_error, kArrivedDistance) &&
        below(grasp_error, kArrivedDistance) && below(old.linear_m_s, kArrivedSpeed) &&
        below(old.angular_rad_s, kArrivedSpeed) && std::abs(old.grasp_rate_rad_s) < kArrivedSpeed) {
        path_ = {};
        path_.position_m = target_position_m_;
        path_.rotation = target_rotation_;
        path_.grasp_angle_rad = target_grasp_rad_;
        arrived_ = true;
        return;
    }
    Twist next;
    next.linear_m_s = approach(position_error, old.linear_m_s, kHandMaxSpeed_m_s,
                               kHandMaxAcceleration_m_s2, dt_s);
    next.angular_rad_s = approach(rotation_error, old.angular_rad_s, kHandMaxTurnRate_rad_s,
                                  kHandMaxTurnAcceleration_rad_s2, dt_s);
    next.grasp_rate_rad_s = approach(grasp_error, Vec3(old.grasp_rate_rad_s, 0.0, 0.0),
                                     kHandMaxTurnRate_rad_s, kHandMaxTurnAcceleration_rad_s2, dt_s)
                                .x;
    path_.acceleration_m_s2 = (next.linear_m_s - old.linear_m_s) / dt_s;
    path_.angular_acceleration_rad_s2 = (next.angular_rad_s - old.angular_rad_s) / dt_s;
    path_.grasp_acceleration_rad_s2 = (next.grasp_rate_rad_s - old.grasp_rate_rad_s) / dt_s;
    path_.position_m += dt_s * next.linear_m_s;
    path_.rotation = turned(path_.rotation, next.angular_rad_s, dt_s);
    path_.grasp_angle_rad += dt_s * next.grasp_rate_rad_s;
    path_.velocity = next;
}

Wrench SimulatedHand::wrench(const Vec3 &position_m, const Quat &rotation, double grasp_angle_rad,
                             const Twist &twist) const noexcept {
    const HandImpedance &z = impedance_;
    const Vec3 turn = rotation_vector(path_.rotation * glm::conjugate(rotation));
    Wrench result;
    result.force_n = z.stiffness_n_m * (path_.position_m - position_m) +
                     z.damping_n_s_m * (path_.velocity.linear_m_s - twist.linear_m_s);
    result.moment_nm = z.stiffness_nm_rad * turn +
                       z.damping_nm_s_rad * (path_.velocity.angular_rad_s - twist.angular_rad_s);
    result.grasp_torque_nm =
        z.grasp_stiffness_nm_rad * (path_.grasp_angle_rad - grasp_angle_rad) +
        z.grasp_damping_nm_s_rad * (path_.velocity.grasp_rate_rad_s - twist.grasp_rate_rad_s);
    return result;
}

double SimulatedHand::spring_energy_j(const Vec3 &position_m, const Quat &rotation,
                                      double grasp_angle_rad) const noexcept {
    const HandImpedance &z = impedance_;
    const Vec3 move = path_.position_m - position_m;
    const Vec3 turn = rotation_vector(path_.rotation * glm::conjugate(rotation));
    const double grasp = path_.grasp_angle_rad - grasp_angle_rad;
    return 0.5 *
           (z.stiffness_n_m * glm::dot(move, move) + z.stiffness_nm_rad * glm::dot(turn, turn) +
            z.grasp_stiffness_nm_rad * grasp * grasp);
}

} // namespace spidar
