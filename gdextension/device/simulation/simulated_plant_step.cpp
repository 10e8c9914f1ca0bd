// One step of the plant's physics: forces of strings and hand, motion of grip and rotors, and the
// check for divergence.
#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "core/base/finite.h"
#include "core/geometry/string_exit.h"
#include "device/simulation/simulated_plant.h"

namespace spidar {

namespace {

// Guards the direction of a string whose ends meet.
constexpr double kShortestString_m = 1e-6;
// Limits that no hand and no device exceeds: beyond them the integration has failed.
constexpr double kDivergedDistance_m = 5.0;
constexpr double kDivergedSpeed_m_s = 50.0;
constexpr double kDivergedTurnRate_rad_s = 5000.0;
constexpr double kDivergedRotorSpeed_m_s = 500.0; // a free rotor at full current reaches about 70

// Motion of a pole end per grasp angle: r1 = d (sin(g/2) x + cos(g/2) y), r2 = d (cos(g/2) x +
// sin(g/2) y).
struct Poles {
    Vec3 r1, r2, dr1, dr2;
};

Poles poles_of(const Quat &rotation, double grasp_angle_rad, double half_length_m) noexcept {
    const Mat3 axes = glm::mat3_cast(rotation);
    const double c = half_length_m * std::cos(0.5 * grasp_angle_rad);
    const double s = half_length_m * std::sin(0.5 * grasp_angle_rad);
    return {s * axes[0] + c * axes[1], c * axes[0] + s * axes[1], 0.5 * (c * axes[0] - s * axes[1]),
            0.5 * (c * axes[1] - s * axes[0])};
}

// Distance below limit; false for NaN.
bool within(const Vec3 &v, double limit) noexcept {
    return glm::dot(v, v) <= limit * limit;
}

} // namespace

void SimulatedPlant::step() noexcept {
    for (std::size_t i = 0; i < kStringCount; ++i) {
        motor_tensions_n_[i] += current_gain_ * (commanded_n_[i] - motor_tensions_n_[i]);
    }
    hand_.advance(kPlantStep_s);
    const StringForces strings = string_forces();
    const Wrench hand = hand_.wrench(position_m_, rotation_, grasp_angle_rad_, twist_);
    const HandImpedance &z = hand_.impedance();
    const HandPath &path = hand_.path();

    // The hand's muscles move the hand's own mass along its path; the springs move the rest.
    const Vec3 force = strings.wrench.force_n + hand.force_n + z.mass_kg * path.acceleration_m_s2;
    const Vec3 moment = strings.wrench.moment_nm + hand.moment_nm +
                        z.inertia_kg_m2 * path.angular_acceleration_rad_s2;
    const double torque = strings.wrench.grasp_torque_nm + hand.grasp_torque_nm +
                          z.grasp_inertia_kg_m2 * path.grasp_acceleration_rad_s2;
    // Isotropic inertia: no gyroscopic term.
    twist_.linear_m_s += (kPlantStep_s / (settings_.grip_mass_kg + z.mass_kg)) * force;
    twist_.angular_rad_s +=
        (kPlantStep_s / (settings_.grip_inertia_kg_m2 + z.inertia_kg_m2)) * moment;
    twist_.grasp_rate_rad_s +=
        (kPlantStep_s / (settings_.grasp_inertia_kg_m2 + z.grasp_inertia_kg_m2)) * torque;

    energy_to_hand_j_ += kPlantStep_s * (glm::dot(strings.wrench.force_n, twist_.linear_m_s) +
                                         glm::dot(strings.wrench.moment_nm, twist_.angular_rad_s) +
                                         strings.wrench.grasp_torque_nm * twist_.grasp_rate_rad_s);

    position_m_ += kPlantStep_s * twist_.linear_m_s;
    rotation_ = turned(rotation_, twist_.angular_rad_s, kPlantStep_s);
    grasp_angle_rad_ += kPlantStep_s * twist_.grasp_rate_rad_s;
    // Hinge stops: hard, without bounce.
    if (grasp_angle_rad_ > settings_.hinge_closed_rad) {
        grasp_angle_rad_ = settings_.hinge_closed_rad;
        twist_.grasp_rate_rad_s = std::min(twist_.grasp_rate_rad_s, 0.0);
    } else if (grasp_angle_rad_ < settings_.hinge_open_rad) {
        grasp_angle_rad_ = settings_.hinge_open_rad;
        twist_.grasp_rate_rad_s = std::max(twist_.grasp_rate_rad_s, 0.0);
    }
    if (settings_.elastic) {
        step_rotors(strings);
        if (settings_.creep > 0.0) {
            creep(strings);
        }
    }
    ++steps_;
}

void SimulatedPlant::step_rotors(const StringForces &forces) noexcept {
    const double inverse_mass = 1.0 / settings_.rotor_mass_kg;
    for (std::size_t i = 0; i < kStringCount; ++i) {
        double take_up = 0.0;
        const double slack = slack_length_m(i) - forces.lengths_m[i];
        if (slack > 0.0 && !has_bit(broken_, i)) {
            const double closing = rotor_speeds_m_s_[i] - forces.length_rates_m_s[i];
            take_up = std::clamp(kTakeUpStiffness_n_m * slack + take_up_damping_n_s_m_ * closing,
                                 0.0, kTakeUpForce_n);
        }
        if (has_bit(jammed_, i)) {
            rotor_speeds_m_s_[i] = 0.0;
            continue;
        }
        const double drive = motor_tensions_n_[i] + take_up; // winds in
        // Friction is implicit: viscous as a factor, Coulomb as an impulse that at most stops the
        // rotor. It is therefore stable, holds in stiction, and vanishes exactly with its
        // coefficient.
        const double free =
            rotor_viscous_gain_ *
            (rotor_speeds_m_s_[i] + kPlantStep_s * inverse_mass * (forces.tensions_n[i] - drive));
        const double speed =
            std::copysign(std::max(0.0, std::abs(free) - coulomb_speed_change_), free);
        rotor_speeds_m_s_[i] = speed;
        rotors_m_[i] += kPlantStep_s * speed;
        supplied_energy_j_ -= kPlantStep_s * drive * speed;
        if (rotors_m_[i] < 0.0) { // a broken string is fully wound in
            rotors_m_[i] = 0.0;
            rotor_speeds_m_s_[i] = 0.0;
        }
    }
}

void SimulatedPlant::creep(const StringForces &forces) noexcept {
    constexpr double kTension_n = 10.0;
    for (std::size_t i = 0; i < kStringCount; ++i) {
        const double final = settings_.creep * forces.tensions_n[i] / kTension_n;
        crept_[i] += std::min(1.0, kPlantStep_s / settings_.creep_time_s) * (final - crept_[i]);
    }
}

SimulatedPlant::StringForces SimulatedPlant::string_forces() const noexcept {
    const Poles poles = poles_of(rotation_, grasp_angle_rad_, settings_.grip.pole_half_length_m);
    const std::array<Vec3, 2> r{poles.r1, poles.r2};
    const std::array<Vec3, 2> dr{poles.dr1, poles.dr2};
    std::array<Vec3, 2> end_velocity{};
    for (std::size_t pole = 0; pole < 2; ++pole) {
        end_velocity[pole] =
            glm::cross(twist_.angular_rad_s, r[pole]) + twist_.grasp_rate_rad_s * dr[pole];
    }
    const bool rigid = settings_.grip.kind == GripKind::rigid;
    const Mat3 axes = glm::mat3_cast(rotation_);
    StringForces out;
    out.r1_m = poles.r1;
    out.r2_m = poles.r2;
    std::array<Vec3, 2> end_force{Vec3(0.0), Vec3(0.0)}; // signed by the end at which it pulls
    for (std::size_t i = 0; i < kStringCount; ++i) {
        const Attachment &tie = settings_.grip.attachments[i];
        const auto pole = static_cast<std::size_t>(tie.pole);
        const Vec3 lever = rigid ? axes * settings_.grip.joints_m[i] : tie.sign * r[pole];
        const Vec3 velocity =
            rigid ? glm::cross(twist_.angular_rad_s, lever) : tie.sign * end_velocity[pole];
        const Vec3 to_motor = settings_.frame.motors_m[i] - (position_m_ + lever);
        double length = std::max(kShortestString_m, std::sqrt(glm::dot(to_motor, to_motor)));
        Vec3 direction = (1.0 / length) * to_motor;
        if (settings_.frame.pulley_radius_m > 0.0) {
            const StringPath path = string_path(settings_.frame, i, position_m_ + lever);
            length = std::max(kShortestString_m, path.length_m);
            direction = -path.direction;
        }
        const double inverse = 1.0 / length;
        const double rate = -glm::dot(direction, twist_.linear_m_s + velocity);
        double tension = 0.0;
        if (has_bit(broken_, i)) {
            // A slack string has no tension.
        } else if (settings_.elastic) {
            const double stretch = length - slack_length_m(i);
            if (stretch > 0.0) {
                tension = std::max(0.0, settings_.string_stiffness_ea_n * inverse * stretch +
                                            settings_.string_damping_n_s_m *
                                                (rate - rotor_speeds_m_s_[i]));
            }
        } else {
            const double coulomb =
                std::clamp(coulomb_slope_n_s_m_ * rate, -settings_.coulomb_friction_n,
                           settings_.coulomb_friction_n);
            tension = std::max(0.0, motor_tensions_n_[i] + coulomb +
                                        settings_.viscous_friction_n_s_m * rate);
        }
        out.lengths_m[i] = length;
        out.length_rates_m_s[i] = rate;
        out.tensions_n[i] = tension;
        const Vec3 pull = tension * direction;
        out.wrench.force_n += pull;
        if (rigid) {
            out.wrench.moment_nm += glm::cross(lever, pull);
        } else {
            end_force[pole] += tie.sign * pull;
        }
    }
    for (std::size_t pole = 0; pole < 2; ++pole) {
        out.wrench.moment_nm += glm::cross(r[pole], end_force[pole]);
        out.wrench.grasp_torque_nm += glm::dot(dr[pole], end_force[pole]);
    }
    return out;
}

bool SimulatedPlant::diverged() const noexcept {
    bool good = within(position_m_, kDivergedDistance_m) &&
                within(twist_.linear_m_s, kDivergedSpeed_m_s) &&
                within(twist_.angular_rad_s, kDivergedTurnRate_rad_s) &&
                std::abs(twist_.grasp_rate_rad_s) <= kDivergedTurnRate_rad_s &&
                all_finite(grasp_angle_rad_, energy_to_hand_j_, supplied_energy_j_, rotors_m_,
                           rotation_.w + rotation_.x + rotation_.y + rotation_.z);
    for (const double speed_m_s : rotor_speeds_m_s_) {
        good = good && std::abs(speed_m_s) <= kDivergedRotorSpeed_m_s;
    }
    return !good;
}

} // namespace spidar
