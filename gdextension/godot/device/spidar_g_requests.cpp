// A game's requests for contacts and wrenches: validated here, with a message that names the field,
// then published.
#include "godot/device/spidar_g.h"

#include <cmath>

#include <glm/geometric.hpp>

#include "device/contract/grip_points.h"
#include "godot/base/physics_tick.h"
#include "godot/base/type_conversions.h"

using spidar::ContactPlane;
using spidar::Status;

namespace {

// Ranges of the eleventh and twelfth numbers of a contact.
constexpr int kLastContactTarget = static_cast<int>(spidar::ContactTarget::turn_stop);
// Largest id: ids arrive as doubles, and larger ones would not fit an int32.
constexpr double kLargestContactId = 2147483647.0;

struct ContactField {
    const char *name;
    const char *unit;
};

constexpr ContactField kContactFields[SpidarG::CONTACT_STRIDE] = {
    {"normal.x", ""},      {"normal.y", ""},      {"normal.z", ""},      {"offset", "m"},
    {"velocity.x", "m/s"}, {"velocity.y", "m/s"}, {"velocity.z", "m/s"}, {"stiffness", "N/m"},
    {"damping", "N s/m"},  {"friction", ""},      {"target", ""},        {"id", ""}};

std::string field_problem(std::int64_t plane, int field, double value, const char *remedy) {
    return "set_contacts: plane " + std::to_string(plane) + ", " + kContactFields[field].name +
           " = " + std::to_string(value) + " " + kContactFields[field].unit + ": " + remedy;
}

// Reads the twelve numbers as a plane in world coordinates. Returns the problem, or an empty
// string.
std::string read_plane(const double *values, std::int64_t index, ContactPlane &plane) {
    for (int field = 0; field < SpidarG::CONTACT_STRIDE; ++field) {
        if (!std::isfinite(values[field])) {
            return field_problem(index, field, values[field], "give a finite number.");
        }
    }
    constexpr int kStiffness = 7;
    constexpr int kDamping = 8;
    constexpr int kFriction = 9;
    constexpr int kTarget = 10;
    constexpr int kId = 11;
    for (const int field : {kStiffness, kDamping, kFriction}) {
        if (values[field] < 0.0) {
            return field_problem(index, field, values[field], "give zero or more.");
        }
    }
    if (!(values[kTarget] >= 0.0 && values[kTarget] <= kLastContactTarget) ||
        values[kTarget] != std::floor(values[kTarget])) {
        return field_problem(index, kTarget, values[kTarget], "use one of SpidarG.ContactTarget.");
    }
    if (std::abs(values[kId]) > kLargestContactId || values[kId] != std::floor(values[kId])) {
        return field_problem(index, kId, values[kId], "give a whole number of 32 bits.");
    }
    plane.normal = {values[0], values[1], values[2]};
    plane.offset_m = values[3];
    plane.velocity_m_s = {values[4], values[5], values[6]};
    plane.stiffness_n_m = values[kStiffness];
    plane.damping_n_s_m = values[kDamping];
    plane.friction = values[kFriction];
    plane.target = static_cast<spidar::ContactTarget>(static_cast<int>(values[kTarget]));
    plane.id = static_cast<std::int32_t>(values[kId]);
    const Status status = spidar::validate_contact(plane);
    if (!spidar::usable(status)) {
        return "set_contacts: plane " + std::to_string(index) + ", normal = (" +
               std::to_string(values[0]) + ", " + std::to_string(values[1]) + ", " +
               std::to_string(values[2]) + "): " + spidar::describe(status) +
               " Give a unit normal; for a grasp stop normal.x is 1 or -1, for a turn stop the "
               "normal is the axis of rotation.";
    }
    return {};
}

} // namespace

bool SpidarG::request_wrench(const godot::Vector3 &force, const godot::Vector3 &moment,
                             double grasp_torque, double duration_s, const godot::String &owner) {
    const spidar::Wrench wrench{spidar::to_core(force), spidar::to_core(moment), grasp_torque};
    const Status status = spidar::validate_wrench(wrench, duration_s);
    if (!spidar::usable(status)) {
        const auto text = [](const godot::Vector3 &v) {
            return "(" + std::to_string(v.x) + ", " + std::to_string(v.y) + ", " +
                   std::to_string(v.z) + ")";
        };
        return reject(
            "request_wrench: force = " + text(force) + " N, moment = " + text(moment) +
            " N m, grasp_torque = " + std::to_string(grasp_torque) +
            " N m, duration_s = " + std::to_string(duration_s) + " s: " + spidar::describe(status) +
            " Give finite numbers and a duration from 0 to 60 s; the last good request is kept.");
    }
    requests_.set_wrench(owner.utf8().get_data(), world().wrench_to_device(wrench), duration_s,
                         snapshot_.time_s);
    publish_wrench();
    return true;
}

void SpidarG::publish_wrench() {
    requests_.write_wrench(command_, snapshot_.time_s);
    if (loop_) {
        loop_->publish(command_);
    }
}

void SpidarG::publish_touch(std::shared_ptr<spidar::TouchScene> touch) {
    if (!loop_) {
        return;
    }
    if (replay_ != nullptr) {
        replay_touches_.note(std::move(touch));
        return;
    }
    if (touch) {
        touch->state_time_s = snapshot_.time_s;
    }
    loop_->publish(command_, std::move(touch));
}

void SpidarG::publish_contacts() {
    requests_.write_contacts(command_, snapshot_.time_s); // the snapshot that the game saw
    replay_contacts_.note(command_);
    if (loop_) {
        loop_->publish(command_);
    }
}

void SpidarG::note_place() {
    if (is_inside_tree()) {
        motion_.note(world(), spidar::physics_tick_s());
    }
}

ContactPlane SpidarG::seen_from_node(ContactPlane plane) const {
    using spidar::ContactTarget;
    if (plane.target == ContactTarget::turn_stop) {
        plane.velocity_m_s -= motion_.angular_rad_s();
    } else if (plane.target != ContactTarget::grasp_stop) {
        // Velocity where the target is nearest.
        const spidar::WorldFrame frame = world();
        spidar::Vec3 at =
            frame.point_to_world(spidar::grip_point(snapshot_.grip.pose, plane.target));
        at += (plane.offset_m - glm::dot(plane.normal, at)) * plane.normal;
        plane.velocity_m_s -= motion_.velocity_at(at - frame.origin);
    }
    return plane;
}

bool SpidarG::set_contacts(const godot::PackedFloat64Array &contacts, const godot::String &owner) {
    const std::int64_t size = contacts.size();
    if (size % CONTACT_STRIDE != 0 || size > CONTACT_STRIDE * spidar::kMaxContacts) {
        return reject(
            "set_contacts: " + std::to_string(size) +
            " numbers: give SpidarG.CONTACT_STRIDE (12) numbers per plane, at most 8 planes.");
    }
    const spidar::WorldFrame frame = world();
    std::array<ContactPlane, spidar::kMaxContacts> planes{};
    const double *values = contacts.ptr();
    const std::int64_t count = size / CONTACT_STRIDE;
    for (std::int64_t i = 0; i < count; ++i) {
        ContactPlane &plane = planes[static_cast<std::size_t>(i)];
        const std::string problem = read_plane(values + i * CONTACT_STRIDE, i, plane);
        if (!problem.empty()) {
            return reject(problem);
        }
        plane = frame.contact_to_device(seen_from_node(plane));
    }
    const std::string name = owner.utf8().get_data();
    const int free = requests_.free_contacts(name, snapshot_.time_s);
    if (count > free) {
        return reject("set_contacts: " + std::to_string(count) + " planes, but other owners use " +
                      std::to_string(spidar::kMaxContacts - free) +
                      " of the device's 8: give at most get_free_contacts() planes.");
    }
    requests_.set_contacts(name, planes.data(), static_cast<int>(count), snapshot_.time_s);
    publish_contacts();
    return true;
}

void SpidarG::clear_contacts(const godot::String &owner) {
    set_contacts(godot::PackedFloat64Array(), owner);
}

int SpidarG::get_free_contacts(const godot::String &owner) const {
    return requests_.free_contacts(owner.utf8().get_data(), snapshot_.time_s);
}
