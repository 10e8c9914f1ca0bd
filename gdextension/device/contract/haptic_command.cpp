#include "device/contract/haptic_command.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "core/base/finite.h"

namespace spidar {

namespace {

// Largest error of a unit normal: games compute in single precision (1e-7); more is a mistake.
constexpr double kUnitTolerance = 1e-3;

bool none_negative(const DofGains &gains) noexcept {
    return std::ranges::all_of(gains, [](double gain) { return gain >= 0.0; });
}

// True for an orthonormal, right-handed matrix.
bool is_rotation(const Mat3 &m) noexcept {
    const auto near = [](double value, double wanted) {
        return std::abs(value - wanted) <= kUnitTolerance;
    };
    return near(glm::dot(m[0], m[0]), 1.0) && near(glm::dot(m[1], m[1]), 1.0) &&
           near(glm::dot(m[2], m[2]), 1.0) && near(glm::dot(m[0], m[1]), 0.0) &&
           near(glm::dot(m[1], m[2]), 0.0) && near(glm::dot(m[2], m[0]), 0.0) &&
           glm::dot(glm::cross(m[0], m[1]), m[2]) > 0.0;
}

// Validates the first `count` elements.
template <typename Requests, typename Validate>
Status validate_first(const Requests &requests, int count, Validate validate) noexcept {
    if (count < 0 || count > static_cast<int>(requests.size())) {
        return Status::invalid_request;
    }
    for (int i = 0; i < count; ++i) {
        const Status status = validate(requests[static_cast<std::size_t>(i)]);
        if (!usable(status)) {
            return status;
        }
    }
    return Status::ok;
}

} // namespace

Status validate_wrench(const Wrench &wrench, double duration_s) noexcept {
    if (!all_finite(wrench, duration_s)) {
        return Status::not_finite;
    }
    if (!(duration_s >= 0.0 && duration_s <= kMaxWrenchDuration_s)) {
        return Status::invalid_request;
    }
    return Status::ok;
}

Status validate_contact(const ContactPlane &contact) noexcept {
    if (!all_finite(contact.normal, contact.velocity_m_s, contact.offset_m, contact.stiffness_n_m,
                    contact.damping_n_s_m, contact.friction)) {
        return Status::not_finite;
    }
    if (contact.target > ContactTarget::turn_stop) {
        return Status::invalid_request;
    }
    if (contact.target == ContactTarget::grasp_stop) {
        if (!(std::abs(std::abs(contact.normal.x) - 1.0) <= kUnitTolerance)) {
            return Status::invalid_request;
        }
    } else {
        const Vec3 &n = contact.normal;
        const double length = std::hypot(n.x, n.y, n.z);
        if (!(std::abs(length - 1.0) <= kUnitTolerance)) {
            return Status::invalid_request;
        }
    }
    if (!(contact.stiffness_n_m >= 0.0) || !(contact.damping_n_s_m >= 0.0) ||
        !(contact.friction >= 0.0)) {
        return Status::invalid_request;
    }
    return Status::ok;
}

Status validate_contacts(const HapticCommand &command) noexcept {
    if (!all_finite(command.contacts_state_time_s)) {
        return Status::not_finite;
    }
    return validate_first(command.contacts, command.contact_count, validate_contact);
}

Status validate_coupling(const Coupling &coupling) noexcept {
    if (!all_finite(coupling.position_m, coupling.rotation, coupling.grasp_angle_rad,
                    coupling.twist, coupling.stiffness, coupling.damping, coupling.max_force_n,
                    coupling.max_moment_nm, coupling.max_grasp_torque_nm, coupling.state_time_s)) {
        return Status::not_finite;
    }
    const bool usable_gains = none_negative(coupling.stiffness) && none_negative(coupling.damping);
    const bool usable_caps = coupling.max_force_n >= 0.0 && coupling.max_moment_nm >= 0.0 &&
                             coupling.max_grasp_torque_nm >= 0.0;
    return usable_gains && usable_caps && is_rotation(coupling.rotation) &&
                   coupling.dof_mask <= kAllDof
               ? Status::ok
               : Status::invalid_request;
}

Status validate_effect(const Effect &effect) noexcept {
    if (!all_finite(effect.gain, effect.centre_m, effect.centre_rotation, effect.centre_grasp_rad,
                    effect.frequency_hz, effect.spacing, effect.duration_s)) {
        return Status::not_finite;
    }
    if (static_cast<int>(effect.kind) >= kEffectKindCount || effect.dof_mask > kAllDof ||
        !(effect.duration_s >= 0.0 && effect.duration_s <= kMaxWrenchDuration_s)) {
        return Status::invalid_request;
    }
    bool good = true;
    if (effect.kind != EffectKind::constant && effect.kind != EffectKind::vibration) {
        good = none_negative(effect.gain); // a negative gain would drive the hand
    }
    if (effect.kind == EffectKind::spring || effect.kind == EffectKind::detents) {
        good = good && is_rotation(effect.centre_rotation);
    }
    if (effect.kind == EffectKind::vibration) {
        good = good && effect.frequency_hz >= kMinVibration_hz &&
               effect.frequency_hz <= kMaxVibration_hz;
    }
    if (effect.kind == EffectKind::detents) {
        for (std::size_t i = 0; i < effect.spacing.size(); ++i) {
            const bool used = ((effect.dof_mask >> i) & 1U) != 0;
            good = good && (!used || effect.spacing[i] >= kMinDetentSpacing);
        }
    }
    return good ? Status::ok : Status::invalid_request;
}

Status validate_limits(const LiveLimits &limits) noexcept {
    for (const double most :
         {limits.max_force_n, limits.max_moment_nm, limits.max_grasp_torque_nm}) {
        if (!(most > 0.0 && std::isfinite(most))) {
            return Status::invalid_request;
        }
    }
    for (const double most : {limits.max_stiffness_n_m, limits.max_turn_stiffness_nm_rad,
                              limits.max_grasp_stiffness_nm_rad}) {
        if (!(most >= 0.0 && std::isfinite(most))) {
            return Status::invalid_request;
        }
    }
    return Status::ok;
}

Status validate_effects(const HapticCommand &command) noexcept {
    return validate_first(command.effects, command.effect_count, validate_effect);
}

} // namespace spidar
