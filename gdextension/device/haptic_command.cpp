#include "device/haptic_command.h"

#include <cmath>

namespace spidar {

namespace {

bool all_finite(const Vec3 &v) noexcept {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

// A normal this far from unit length is a mistake, not rounding: games compute in single precision (1e-7).
constexpr double kUnitTolerance = 1e-3;

} // namespace

Status validate_wrench(const Wrench &wrench, double duration_s) noexcept {
    if (!all_finite(wrench.force_n) || !all_finite(wrench.moment_nm) ||
        !std::isfinite(wrench.grasp_torque_nm) || !std::isfinite(duration_s)) {
        return Status::not_finite;
    }
    if (!(duration_s >= 0.0 && duration_s <= kMaxWrenchDuration_s)) {
        return Status::invalid_request;
    }
    return Status::ok;
}

Status validate_contact(const ContactPlane &contact) noexcept {
    if (!all_finite(contact.normal) || !all_finite(contact.velocity_m_s) ||
        !std::isfinite(contact.offset_m) || !std::isfinite(contact.stiffness_n_m) ||
        !std::isfinite(contact.damping_n_s_m) || !std::isfinite(contact.friction)) {
        return Status::not_finite;
    }
    if (contact.target > ContactTarget::grasp_stop) {
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
    if (command.contact_count < 0 || command.contact_count > kMaxContacts) {
        return Status::invalid_request;
    }
    for (int i = 0; i < command.contact_count; ++i) {
        const Status status = validate_contact(command.contacts[static_cast<std::size_t>(i)]);
        if (!usable(status)) {
            return status;
        }
    }
    return Status::ok;
}

} // namespace spidar
