// List of the fields of a HapticCommand, without its scene (touch_words.h). A new field must be
// added here; recording, reading and comparing then include it.
#pragma once

#include "device/contract/haptic_command.h"
#include "device/recording/codec/field_words.h"

namespace spidar {

// A failing assertion means that a struct changed: add the field below, then correct the number.
static_assert(count_members<ContactPlane>() == 8, "ContactPlane changed: list its fields here");
static_assert(count_members<Coupling>() == 11, "Coupling changed: list its fields here");
static_assert(count_members<Effect>() == 11, "Effect changed: list its fields here");
static_assert(count_members<LiveLimits>() == 6, "LiveLimits changed: list its fields here");
static_assert(count_members<HapticCommand>() == 25, "HapticCommand changed: list its fields here");

template <typename Gains, typename Visit>
void visit_dof(std::string_view name, int index, Gains &gains, Visit &&visit) {
    for (int dof = 0; dof < kDofCount; ++dof) {
        visit(name, kDofCount * index + dof, gains[static_cast<std::size_t>(dof)]);
    }
}

template <typename Command, typename Visit>
void for_each_field(Command &command, Visit &&visit) requires
    std::is_same_v<std::remove_const_t<Command>, HapticCommand> {
    visit("forces_enabled", 0, command.forces_enabled);
    visit("arm_count", 0, command.arm_count);
    visit("disarm_count", 0, command.disarm_count);
    visit("clear_fault_count", 0, command.clear_fault_count);
    visit("zero_count", 0, command.zero_count);
    visit("heartbeat", 0, command.heartbeat);
    visit("stop_count", 0, command.stop_count);
    visit("stop_reason", 0, command.stop_reason);
    visit("wrench_sequence", 0, command.wrench_sequence);
    visit_vector("wrench.force_n", 0, command.wrench.force_n, visit);
    visit_vector("wrench.moment_nm", 0, command.wrench.moment_nm, visit);
    visit("wrench.grasp_torque_nm", 0, command.wrench.grasp_torque_nm);
    visit("wrench_duration_s", 0, command.wrench_duration_s);
    visit("contacts_sequence", 0, command.contacts_sequence);
    visit("contact_count", 0, command.contact_count);
    int i = 0;
    for (auto &plane : command.contacts) {
        visit_vector("contact.normal", i, plane.normal, visit);
        visit("contact.offset_m", i, plane.offset_m);
        visit_vector("contact.velocity_m_s", i, plane.velocity_m_s, visit);
        visit("contact.stiffness_n_m", i, plane.stiffness_n_m);
        visit("contact.damping_n_s_m", i, plane.damping_n_s_m);
        visit("contact.friction", i, plane.friction);
        visit("contact.target", i, plane.target);
        visit("contact.id", i, plane.id);
        ++i;
    }
    visit("contacts_state_time_s", 0, command.contacts_state_time_s);
    visit("touch_sequence", 0, command.touch_sequence); // recorded by touch_words.h
    visit("coupling_sequence", 0, command.coupling_sequence);
    auto &coupling = command.coupling;
    visit_vector("coupling.position_m", 0, coupling.position_m, visit);
    visit_matrix("coupling.rotation", 0, coupling.rotation, visit);
    visit("coupling.grasp_angle_rad", 0, coupling.grasp_angle_rad);
    visit_vector("coupling.twist.linear_m_s", 0, coupling.twist.linear_m_s, visit);
    visit_vector("coupling.twist.angular_rad_s", 0, coupling.twist.angular_rad_s, visit);
    visit("coupling.twist.grasp_rate_rad_s", 0, coupling.twist.grasp_rate_rad_s);
    visit_array("coupling.stiffness", coupling.stiffness, visit);
    visit_array("coupling.damping", coupling.damping, visit);
    visit("coupling.max_force_n", 0, coupling.max_force_n);
    visit("coupling.max_moment_nm", 0, coupling.max_moment_nm);
    visit("coupling.max_grasp_torque_nm", 0, coupling.max_grasp_torque_nm);
    visit("coupling.state_time_s", 0, coupling.state_time_s);
    visit("coupling.dof_mask", 0, coupling.dof_mask);
    visit("effects_sequence", 0, command.effects_sequence);
    visit("effect_count", 0, command.effect_count);
    i = 0;
    for (auto &effect : command.effects) {
        visit("effect.kind", i, effect.kind);
        visit("effect.dof_mask", i, effect.dof_mask);
        visit("effect.id", i, effect.id);
        visit_dof("effect.gain", i, effect.gain, visit);
        visit_vector("effect.centre_m", i, effect.centre_m, visit);
        visit_matrix("effect.centre_rotation", i, effect.centre_rotation, visit);
        visit("effect.centre_grasp_rad", i, effect.centre_grasp_rad);
        visit("effect.frequency_hz", i, effect.frequency_hz);
        visit_dof("effect.spacing", i, effect.spacing, visit);
        visit("effect.duration_s", i, effect.duration_s);
        visit("effect.renewal", i, effect.renewal);
        ++i;
    }
    visit("grasp_share", 0, command.grasp_share);
    visit("limits_sequence", 0, command.limits_sequence);
    visit("limits.max_force_n", 0, command.limits.max_force_n);
    visit("limits.max_moment_nm", 0, command.limits.max_moment_nm);
    visit("limits.max_grasp_torque_nm", 0, command.limits.max_grasp_torque_nm);
    visit("limits.max_stiffness_n_m", 0, command.limits.max_stiffness_n_m);
    visit("limits.max_turn_stiffness_nm_rad", 0, command.limits.max_turn_stiffness_nm_rad);
    visit("limits.max_grasp_stiffness_nm_rad", 0, command.limits.max_grasp_stiffness_nm_rad);
}

} // namespace spidar
