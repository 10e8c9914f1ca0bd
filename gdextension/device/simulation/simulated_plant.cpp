#include "device/simulation/simulated_plant.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>

#include "core/base/finite.h"
#include "core/geometry/reach_box.h"

namespace spidar {

namespace {

// An inelastic string has no rotor that Coulomb friction could hold still. The friction is
// proportional to speed below this speed or, where that is steeper than the explicit step allows
// with the lightest hand, with the slope below.
constexpr double kCoulombBand_m_s = 1e-3;
constexpr double kCoulombMaxSlope_n_s_m = 50.0;

} // namespace

Vec3 clamped_to_reach(const PlantSettings &settings, const Vec3 &position_m) noexcept {
    const ReachBox box = reach_box(settings.frame, settings.grip.pole_half_length_m);
    Vec3 result = position_m;
    for (int axis = 0; axis < 3; ++axis) {
        result[axis] = std::clamp(position_m[axis], box.low_m[axis], box.high_m[axis]);
    }
    return result;
}

SimulatedPlant::SimulatedPlant(const PlantSettings &settings) noexcept : settings_(settings) {
    if (settings.grip.kind == GripKind::rigid) { // no hinge: both stops at rest
        settings_.hinge_open_rad = 0.0;
        settings_.hinge_closed_rad = 0.0;
    }
    for (std::size_t i = 0; i < kStringCount; ++i) {
        newtons_per_ampere_[i] = settings.motors.tension_gain[i] *
                                 settings.motors.torque_constant_nm_a[i] /
                                 settings.motors.effective_radius_m[i];
    }
    if (settings.current_lag_s > 0.0) {
        current_gain_ = -std::expm1(-kPlantStep_s / settings.current_lag_s);
    }
    const double mass = settings.rotor_mass_kg;
    rotor_viscous_gain_ = 1.0 / (1.0 + settings.viscous_friction_n_s_m * kPlantStep_s / mass);
    coulomb_speed_change_ = settings.coulomb_friction_n * kPlantStep_s / mass;
    take_up_damping_n_s_m_ = 2.0 * std::sqrt(kTakeUpStiffness_n_m * mass); // critical
    coulomb_slope_n_s_m_ =
        std::min(kCoulombMaxSlope_n_s_m, settings.coulomb_friction_n / kCoulombBand_m_s);
    hand_.set_firmness(settings.firmness);
    reset(HandTarget{});
    home_lengths_m_ = string_forces().lengths_m;
}

void SimulatedPlant::reset(const HandTarget &pose) noexcept {
    if (!is_usable(pose)) {
        return;
    }
    set_hand_target(pose);
    hand_.reset(target_);
    position_m_ = hand_.path().position_m;
    rotation_ = hand_.path().rotation;
    grasp_angle_rad_ = hand_.path().grasp_angle_rad;
    twist_ = {};
    lay_rotors(0xFF);
}

void SimulatedPlant::set_hand_target(const HandTarget &target) noexcept {
    if (!is_usable(target)) {
        return;
    }
    target_ = target;
    target_.position_m = clamped_to_reach(settings_, target.position_m);
    target_.grasp_angle_rad =
        std::clamp(target.grasp_angle_rad, settings_.hinge_open_rad, settings_.hinge_closed_rad);
    hand_.set_target(target_);
}

void SimulatedPlant::set_currents(const StringArray &currents_a) noexcept {
    for (std::size_t i = 0; i < kStringCount; ++i) {
        const double asked = currents_a[i] >= 0.0 ? currents_a[i] : 0.0; // NaN: 0
        const DrumWinding drum{settings_.winding_growth};
        const double share = drum.radius_share(rotors_m_[i] - home_lengths_m_[i]);
        commanded_n_[i] =
            newtons_per_ampere_[i] * std::min(asked, settings_.motors.max_current_a[i]) / share;
    }
}

void SimulatedPlant::set_broken_strings(std::uint8_t mask) noexcept {
    const auto mended = static_cast<std::uint8_t>(broken_ & ~mask);
    broken_ = mask;
    lay_rotors(mended); // a new string is tied on taut
}

// Puts the rotors of these strings at rest, with taut strings without tension.
void SimulatedPlant::lay_rotors(std::uint8_t mask) noexcept {
    const StringForces now = string_forces();
    for (std::size_t i = 0; i < kStringCount; ++i) {
        if (has_bit(mask, i)) {
            rotors_m_[i] = now.lengths_m[i] / (1.0 + crept_[i]);
            rotor_speeds_m_s_[i] = now.length_rates_m_s[i];
        }
    }
}

void SimulatedPlant::advance(double dt_s) noexcept {
    if (!(dt_s > 0.0) || !std::isfinite(dt_s)) {
        return;
    }
    carry_steps_ += std::min(dt_s, kMaxAdvance_s) * kPlantRate_hz;
    const double whole = std::floor(carry_steps_ + 0.5);
    carry_steps_ -= whole;
    const int count = static_cast<int>(whole);
    for (int i = 0; i < count; ++i) {
        step();
    }
    if (diverged()) {
        // Energies keep their values when these are numbers.
        energy_to_hand_j_ = std::isfinite(energy_to_hand_j_) ? energy_to_hand_j_ : 0.0;
        supplied_energy_j_ = std::isfinite(supplied_energy_j_) ? supplied_energy_j_ : 0.0;
        reset(target_);
        ++resets_;
    }
}

CountArray SimulatedPlant::counts() const noexcept {
    constexpr double kMax = std::numeric_limits<std::int32_t>::max();
    const StringForces now = string_forces();
    CountArray result{};
    const DrumWinding drum{settings_.winding_growth};
    for (std::size_t i = 0; i < kStringCount; ++i) {
        const double paid_out_m = settings_.elastic ? rotors_m_[i] : now.lengths_m[i];
        const double length =
            drum.growth > 0.0 ? home_lengths_m_[i] + drum.turned_m(paid_out_m - home_lengths_m_[i])
                              : paid_out_m;
        const double counts = std::round(
            (length * (1.0 + settings_.length_gain_error[i]) + settings_.length_offset_error_m[i]) /
            settings_.metres_per_count);
        result[i] = static_cast<std::int32_t>(std::clamp(counts, -kMax, kMax));
    }
    return result;
}

double SimulatedPlant::time_s() const noexcept {
    return static_cast<double>(steps_) / kPlantRate_hz;
}

PlantTruth SimulatedPlant::truth() const noexcept {
    const StringForces now = string_forces();
    PlantTruth truth;
    truth.pose = {position_m_, now.r1_m, now.r2_m};
    truth.frame.rotation = glm::mat3_cast(rotation_);
    truth.frame.grasp_angle_rad = grasp_angle_rad_;
    truth.frame.crossing_angle_rad = 0.5 * glm::pi<double>() - grasp_angle_rad_;
    truth.twist = twist_;
    truth.strings = now.wrench;
    truth.hand = hand_.wrench(position_m_, rotation_, grasp_angle_rad_, twist_);
    truth.tensions_n = now.tensions_n;
    truth.lengths_m = now.lengths_m;
    truth.time_s = time_s();
    truth.energy_to_hand_j = energy_to_hand_j_;
    truth.resets = resets_;
    return truth;
}

double SimulatedPlant::mechanical_energy_j() const noexcept {
    const HandImpedance &z = hand_.impedance();
    double energy = hand_.spring_energy_j(position_m_, rotation_, grasp_angle_rad_) +
                    0.5 * ((settings_.grip_mass_kg + z.mass_kg) *
                               glm::dot(twist_.linear_m_s, twist_.linear_m_s) +
                           (settings_.grip_inertia_kg_m2 + z.inertia_kg_m2) *
                               glm::dot(twist_.angular_rad_s, twist_.angular_rad_s) +
                           (settings_.grasp_inertia_kg_m2 + z.grasp_inertia_kg_m2) *
                               twist_.grasp_rate_rad_s * twist_.grasp_rate_rad_s);
    if (settings_.elastic) {
        const StringForces now = string_forces();
        for (std::size_t i = 0; i < kStringCount; ++i) {
            const double stretch = std::max(0.0, now.lengths_m[i] - slack_length_m(i));
            if (!has_bit(broken_, i)) {
                energy +=
                    0.5 * settings_.string_stiffness_ea_n / now.lengths_m[i] * stretch * stretch;
            }
            energy += 0.5 * settings_.rotor_mass_kg * rotor_speeds_m_s_[i] * rotor_speeds_m_s_[i];
        }
    }
    return energy;
}

} // namespace spidar
