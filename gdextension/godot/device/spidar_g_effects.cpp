// A game's requests for coupling and effects: validated here, with a message that names the field,
// then published.
#include "godot/device/spidar_g.h"

#include <algorithm>
#include <cmath>

#include <glm/matrix.hpp>

#include "device/contract/dof_lanes.h"
#include "godot/base/type_conversions.h"

using godot::ClassDB;
using godot::D_METHOD;
using spidar::Coupling;
using spidar::Effect;
using spidar::EffectKind;
using spidar::Status;

namespace {

// Returns the problem of seven gains, or an empty string.
std::string read_gains(const char *method, const char *field,
                       const godot::PackedFloat64Array &values, spidar::DofGains &gains) {
    if (values.size() != spidar::kDofCount) {
        return std::string(method) + ": " + field + " has " + std::to_string(values.size()) +
               " numbers: give 7, for x, y, z (per m), rotations about x, y, z and grasp (per "
               "rad).";
    }
    for (std::int64_t i = 0; i < values.size(); ++i) {
        const double value = values.ptr()[i];
        if (!(std::isfinite(value) && value >= 0.0)) {
            const char *const unit = i < 3 ? "N/m or N s/m" : "N m/rad or N m s/rad";
            return std::string(method) + ": " + field + "[" + std::to_string(i) +
                   "] = " + std::to_string(value) + " " + unit +
                   ": give a finite number, 0 or more.";
        }
        gains[static_cast<std::size_t>(i)] = value;
    }
    return {};
}

spidar::DofGains same_gains(double linear, double angular, double grasp) {
    return {linear, linear, linear, angular, angular, angular, grasp};
}

// Returns the problem of an effect with its remedy.
std::string effect_problem(const Effect &effect, int dof_mask) {
    if (dof_mask < 1 || dof_mask > static_cast<int>(spidar::kAllDof)) {
        return "dof_mask = " + std::to_string(dof_mask) +
               ": give a sum of SpidarG.DofMask, 1 to 127.";
    }
    if (!(effect.duration_s >= 0.0 && effect.duration_s <= spidar::kMaxWrenchDuration_s)) {
        return "duration_s = " + std::to_string(effect.duration_s) + " s: give 0 to 60 s.";
    }
    if (effect.kind == EffectKind::vibration &&
        !(effect.frequency_hz >= spidar::kMinVibration_hz &&
          effect.frequency_hz <= spidar::kMaxVibration_hz)) {
        return "frequency_hz = " + std::to_string(effect.frequency_hz) + " Hz: give 5 to 250 Hz.";
    }
    for (const double gain : effect.gain) {
        const bool may_be_negative =
            effect.kind == EffectKind::constant || effect.kind == EffectKind::vibration;
        if (!std::isfinite(gain) || (gain < 0.0 && !may_be_negative)) {
            return "strength = " + std::to_string(gain) +
                   " (N, N m, or per m, rad, m/s, rad/s): give finite numbers, and 0 or more for "
                   "effects that resist a motion.";
        }
    }
    if (effect.kind == EffectKind::detents) {
        for (std::size_t i = 0; i < effect.spacing.size(); ++i) {
            const bool used = ((effect.dof_mask >> i) & 1U) != 0;
            if (used && !(effect.spacing[i] >= spidar::kMinDetentSpacing &&
                          std::isfinite(effect.spacing[i]))) {
                return "spacing = " + std::to_string(effect.spacing[i]) +
                       " m or rad of the device: give a finite number, 0.001 or more.";
            }
        }
    }
    return {};
}

} // namespace

bool SpidarG::set_coupling_gains(const godot::PackedFloat64Array &stiffness,
                                 const godot::PackedFloat64Array &damping, double max_force,
                                 double max_moment, double max_grasp_torque) {
    constexpr const char *kMethod = "set_coupling_gains";
    Coupling gains = coupling_gains_;
    std::string problem = read_gains(kMethod, "stiffness", stiffness, gains.stiffness);
    if (problem.empty()) {
        problem = read_gains(kMethod, "damping", damping, gains.damping);
    }
    const struct {
        const char *field;
        double value;
        const char *unit;
    } caps[] = {{"max_force", max_force, "N"},
                {"max_moment", max_moment, "N m"},
                {"max_grasp_torque", max_grasp_torque, "N m"}};
    for (const auto &cap : caps) {
        if (problem.empty() && !(std::isfinite(cap.value) && cap.value >= 0.0)) {
            problem = std::string(kMethod) + ": " + cap.field + " = " + std::to_string(cap.value) +
                      " " + cap.unit + ": give a finite number, 0 or more.";
        }
    }
    if (!problem.empty()) {
        return reject(problem);
    }
    gains.max_force_n = max_force;
    gains.max_moment_nm = max_moment;
    gains.max_grasp_torque_nm = max_grasp_torque;
    coupling_gains_ = gains;
    return true;
}

bool SpidarG::set_coupling(const godot::Transform3D &target, double grasp_angle,
                           const godot::Vector3 &linear_velocity,
                           const godot::Vector3 &angular_velocity, double grasp_rate,
                           int dof_mask) {
    if (dof_mask < 0 || dof_mask > static_cast<int>(spidar::kAllDof)) {
        return reject("set_coupling: dof_mask = " + std::to_string(dof_mask) +
                      ": give a sum of SpidarG.DofMask, 0 to 127.");
    }
    const spidar::WorldFrame frame = world();
    Coupling coupling = coupling_gains_;
    coupling.position_m = frame.point_to_device(spidar::to_core(target.origin));
    coupling.rotation =
        glm::transpose(frame.rotation) * spidar::to_core(target.basis.orthonormalized());
    coupling.grasp_angle_rad = grasp_angle;
    const spidar::Vec3 from_node = spidar::to_core(target.origin) - frame.origin;
    coupling.twist.linear_m_s =
        frame.velocity_to_device(spidar::to_core(linear_velocity) - motion_.velocity_at(from_node));
    coupling.twist.angular_rad_s =
        frame.turn_to_device(spidar::to_core(angular_velocity) - motion_.angular_rad_s());
    coupling.twist.grasp_rate_rad_s = grasp_rate;
    coupling.state_time_s = snapshot_.time_s; // the snapshot that the game saw
    coupling.dof_mask = static_cast<std::uint8_t>(dof_mask);
    const Status status = spidar::validate_coupling(coupling);
    if (!spidar::usable(status)) {
        return reject(
            "set_coupling: target, grasp_angle = " + std::to_string(grasp_angle) +
            " rad, velocities (m/s, rad/s): " + spidar::describe(status) +
            " Give finite numbers and a basis that is a rotation; the last good coupling is kept.");
    }
    command_.coupling = coupling;
    ++command_.coupling_sequence;
    if (loop_) {
        loop_->publish(command_);
    }
    return true;
}

void SpidarG::clear_coupling() {
    command_.coupling.dof_mask = 0;
    ++command_.coupling_sequence;
    if (loop_) {
        loop_->publish(command_);
    }
}

bool SpidarG::take_effect(const char *method, Effect effect, int dof_mask) {
    effect.dof_mask = static_cast<std::uint8_t>(dof_mask & static_cast<int>(spidar::kAllDof));
    std::string problem = effect_problem(effect, dof_mask);
    if (problem.empty() && !spidar::usable(spidar::validate_effect(effect))) {
        problem = "center or grasp_angle (m, rad) is not usable: give finite numbers and a basis "
                  "that is a rotation.";
    }
    auto &effects = command_.effects;
    auto count = static_cast<std::size_t>(command_.effect_count);
    std::size_t place = 0;
    while (place < count &&
           (effects[place].id != effect.id || effects[place].kind != effect.kind)) {
        ++place;
    }
    const double now_s = snapshot_.time_s;
    if (place == count && count == effects.size()) { // full: replaces an expired effect
        place = 0;
        while (place < count && effect_ends_s_[place] > now_s) {
            ++place;
        }
    }
    if (problem.empty() && place == effects.size()) {
        problem =
            "id = " + std::to_string(effect.id) +
            ": 6 effects are active already: call clear_effect() for one of them, or use its id.";
    }
    if (!problem.empty()) {
        return reject(std::string(method) + ": " + problem);
    }
    effect.renewal = static_cast<std::uint32_t>(command_.effects_sequence + 1);
    effects[place] = effect;
    effect_ends_s_[place] = now_s + effect.duration_s + settings_.safety.wrench_fade_s;
    command_.effect_count = static_cast<int>(std::max(count, place + 1));
    ++command_.effects_sequence;
    if (loop_) {
        loop_->publish(command_);
    }
    return true;
}

bool SpidarG::set_viscous_effect(int id, double linear, double angular, double grasp, int dof_mask,
                                 double duration_s) {
    Effect effect;
    effect.kind = EffectKind::viscous;
    effect.id = id;
    effect.gain = same_gains(linear, angular, grasp);
    effect.duration_s = duration_s;
    return take_effect("set_viscous_effect", effect, dof_mask);
}

bool SpidarG::set_force_effect(int id, const godot::Vector3 &force, const godot::Vector3 &moment,
                               double grasp_torque, double duration_s) {
    Effect effect;
    effect.kind = EffectKind::constant;
    effect.id = id;
    // A force, or the amplitude of a wave, is stored in the gains.
    effect.gain.values = spidar::lanes(
        world().wrench_to_device({spidar::to_core(force), spidar::to_core(moment), grasp_torque}));
    effect.duration_s = duration_s;
    return take_effect("set_force_effect", effect, DOF_ALL);
}

bool SpidarG::set_spring_effect(int id, const godot::Transform3D &center, double grasp_angle,
                                double linear, double angular, double grasp, int dof_mask,
                                double duration_s) {
    const spidar::WorldFrame frame = world();
    Effect effect;
    effect.kind = EffectKind::spring;
    effect.id = id;
    effect.gain = same_gains(linear, angular, grasp);
    effect.centre_m = frame.point_to_device(spidar::to_core(center.origin));
    effect.centre_rotation =
        glm::transpose(frame.rotation) * spidar::to_core(center.basis.orthonormalized());
    effect.centre_grasp_rad = grasp_angle;
    effect.duration_s = duration_s;
    return take_effect("set_spring_effect", effect, dof_mask);
}

bool SpidarG::set_vibration_effect(int id, const godot::Vector3 &force,
                                   const godot::Vector3 &moment, double grasp_torque,
                                   double frequency_hz, double duration_s) {
    Effect effect;
    effect.kind = EffectKind::vibration;
    effect.id = id;
    // A force, or the amplitude of a wave, is stored in the gains.
    effect.gain.values = spidar::lanes(
        world().wrench_to_device({spidar::to_core(force), spidar::to_core(moment), grasp_torque}));
    effect.frequency_hz = frequency_hz;
    effect.duration_s = duration_s;
    return take_effect("set_vibration_effect", effect, DOF_ALL);
}

bool SpidarG::set_detent_effect(int id, const godot::Transform3D &center, double grasp_angle,
                                double spacing, double strength, int dof_mask, double duration_s) {
    const spidar::WorldFrame frame = world();
    Effect effect;
    effect.kind = EffectKind::detents;
    effect.id = id;
    effect.gain.values.fill(strength);
    effect.spacing = same_gains(spacing / frame.scale, spacing, spacing);
    effect.centre_m = frame.point_to_device(spidar::to_core(center.origin));
    effect.centre_rotation =
        glm::transpose(frame.rotation) * spidar::to_core(center.basis.orthonormalized());
    effect.centre_grasp_rad = grasp_angle;
    effect.duration_s = duration_s;
    return take_effect("set_detent_effect", effect, dof_mask);
}

void SpidarG::clear_effect(int id) {
    auto &effects = command_.effects;
    std::size_t kept = 0;
    const auto count = static_cast<std::size_t>(command_.effect_count);
    for (std::size_t i = 0; i < count; ++i) {
        if (effects[i].id != id) {
            effects[kept] = effects[i];
            effect_ends_s_[kept] = effect_ends_s_[i];
            ++kept;
        }
    }
    if (kept != count) {
        command_.effect_count = static_cast<int>(kept);
        ++command_.effects_sequence;
        if (loop_) {
            loop_->publish(command_);
        }
    }
}

void SpidarG::clear_effects() {
    command_.effect_count = 0;
    ++command_.effects_sequence;
    if (loop_) {
        loop_->publish(command_);
    }
}

godot::Vector3 SpidarG::get_stiffness_limits() const {
    const spidar::GainCaps caps = spidar::gain_caps(settings_.render, settings_.rate_hz);
    return spidar::to_godot(
        spidar::Vec3(caps.stiffness_n_m, caps.turn_stiffness_nm_rad, caps.grasp_stiffness_nm_rad));
}

godot::String SpidarG::get_clamp_text() const {
    return spidar::to_godot(spidar::describe(snapshot_.clamp, settings_.render, settings_.rate_hz));
}

godot::PackedFloat64Array SpidarG::get_injected_energy() const {
    return spidar::to_godot(snapshot_.injected_j);
}

void SpidarG::bind_effects() {
    constexpr double kEffectDuration_s = 1.0;
    spidar::bind_checked<&SpidarG::set_coupling_gains, "", "set_coupling_gains", "stiffness",
                         "damping", "max_force", "max_moment", "max_grasp_torque">(5.0, 0.2, 0.2);
    spidar::bind_checked<&SpidarG::set_coupling, "", "set_coupling", "target", "grasp_angle",
                         "linear_velocity", "angular_velocity", "grasp_rate", "dof_mask">(
        godot::Vector3(), godot::Vector3(), 0.0, static_cast<int>(DOF_ALL));
    ClassDB::bind_method(D_METHOD("clear_coupling"), &SpidarG::clear_coupling);
    spidar::bind_checked<&SpidarG::set_viscous_effect, "", "set_viscous_effect", "id", "linear",
                         "angular", "grasp", "dof_mask", "duration_s">(static_cast<int>(DOF_ALL),
                                                                       kEffectDuration_s);
    spidar::bind_checked<&SpidarG::set_force_effect, "", "set_force_effect", "id", "force",
                         "moment", "grasp_torque", "duration_s">(kEffectDuration_s);
    spidar::bind_checked<&SpidarG::set_spring_effect, "", "set_spring_effect", "id", "center",
                         "grasp_angle", "linear", "angular", "grasp", "dof_mask", "duration_s">(
        static_cast<int>(DOF_ALL), kEffectDuration_s);
    spidar::bind_checked<&SpidarG::set_vibration_effect, "", "set_vibration_effect", "id", "force",
                         "moment", "grasp_torque", "frequency_hz", "duration_s">(kEffectDuration_s);
    spidar::bind_checked<&SpidarG::set_detent_effect, "", "set_detent_effect", "id", "center",
                         "grasp_angle", "spacing", "strength", "dof_mask", "duration_s">(
        kEffectDuration_s);
    spidar::bind_checked<&SpidarG::clear_effect, "", "clear_effect", "id">();
    ClassDB::bind_method(D_METHOD("clear_effects"), &SpidarG::clear_effects);
    ClassDB::bind_method(D_METHOD("get_stiffness_limits"), &SpidarG::get_stiffness_limits);
    ClassDB::bind_method(D_METHOD("get_clamp_text"), &SpidarG::get_clamp_text);
    ClassDB::bind_method(D_METHOD("get_injected_energy"), &SpidarG::get_injected_energy);
}
