// The one list of what a HapticCommand holds. A new field of the command is added here, and is then recorded, read,
// compared and counted.
#pragma once

#include "device/haptic_command.h"
#include "device/recording/field_words.h"

namespace spidar {

// A field added to one of these structs: add it to the list below, then correct the number.
static_assert(count_members<ContactPlane>() == 8, "ContactPlane changed: list its fields here");
static_assert(count_members<HapticCommand>() == 14, "HapticCommand changed: list its fields here");

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
}

} // namespace spidar
