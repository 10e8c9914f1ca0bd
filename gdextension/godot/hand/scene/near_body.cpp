#include "godot/hand/scene/near_body.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <godot_cpp/classes/collision_object3d.hpp>
#include <godot_cpp/classes/physics_body3d.hpp>
#include <godot_cpp/classes/physics_material.hpp>
#include <godot_cpp/classes/ref.hpp>
#include <godot_cpp/classes/rigid_body3d.hpp>
#include <godot_cpp/classes/static_body3d.hpp>
#include <godot_cpp/variant/packed_int32_array.hpp>
#include <godot_cpp/variant/string.hpp>

#include "godot/base/type_conversions.h"

namespace spidar {

namespace {

using godot::CollisionObject3D;
using godot::Node3D;
using godot::Object;
using godot::ObjectDB;
using godot::PhysicsServer3D;

// Number of shapes, besides the near ones, that are checked per tick.
constexpr std::size_t kShapesPerTick = 8;

Placement in_frame(const WorldFrame &frame, const Mat3 &axes, const Vec3 &origin) {
    return {frame.point_to_device(origin), glm::transpose(frame.rotation) * take_apart(axes).turn};
}

} // namespace

TurnAndScale take_apart(const Mat3 &axes) noexcept {
    constexpr double kRightAngle = 1e-3;
    TurnAndScale result;
    const Vec3 lengths(glm::length(axes[0]), glm::length(axes[1]), glm::length(axes[2]));
    const double least = std::min({lengths.x, lengths.y, lengths.z});
    if (!(least > 0.0) || !std::isfinite(lengths.x + lengths.y + lengths.z)) {
        result.sheared = true;
        return result;
    }
    const bool mirrored = glm::dot(glm::cross(axes[0], axes[1]), axes[2]) < 0.0;
    result.scale = {mirrored ? -lengths.x : lengths.x, lengths.y, lengths.z};
    const Vec3 x = axes[0] / result.scale.x;
    const Vec3 along_y = axes[1] / lengths.y;
    const Vec3 along_z = axes[2] / lengths.z;
    const double off =
        std::max({std::abs(glm::dot(x, along_y)), std::abs(glm::dot(along_y, along_z)),
                  std::abs(glm::dot(along_z, x))});
    result.sheared = off > kRightAngle;
    const Vec3 y = glm::normalize(along_y - glm::dot(x, along_y) * x);
    result.turn = Mat3(x, y, glm::cross(x, y));
    return result;
}

void for_owned_shapes(
    CollisionObject3D &node,
    const std::function<void(std::uint32_t owner, std::size_t index, bool disabled)> &use) {
    const godot::PackedInt32Array owners = node.get_shape_owners();
    for (std::int64_t i = 0; i < owners.size(); ++i) {
        const auto owner = static_cast<std::uint32_t>(owners[i]);
        const bool disabled = node.is_shape_owner_disabled(owner);
        const int count = node.shape_owner_get_shape_count(owner);
        for (int k = 0; k < count; ++k) {
            const int index = node.shape_owner_get_shape_index(owner, k);
            if (index >= 0) {
                use(owner, static_cast<std::size_t>(index), disabled);
            }
        }
    }
}

NearBody::NearBody(const godot::RID &rid, std::uint64_t object) : rid_(rid), object_(object) {
    const auto *node = Object::cast_to<CollisionObject3D>(ObjectDB::get_instance(object));
    is_node_ = node != nullptr && node->get_rid() == rid;
}

// This is the only server call that is valid for a freed body. It also returns null for soft
// bodies.
bool NearBody::is_there(const godot::RID &space) {
    auto *server = PhysicsServer3D::get_singleton();
    state_ = server->body_get_direct_state(rid_);
    return state_ != nullptr && server->body_get_space(rid_) == space;
}

void NearBody::set_place(const godot::Transform3D &place) {
    basis_ = to_core(place.basis);
    origin_ = to_core(place.origin);
}

void NearBody::read_moved(const Moment &moment) {
    frame_ = moment.in_space;
    set_place(state_->get_transform());
    const double inverse_mass = static_cast<double>(state_->get_inverse_mass());
    mass_kg_ = inverse_mass > 0.0 ? 1.0 / inverse_mass : 0.0;
    const Vec3 center = origin_ + to_core(state_->get_center_of_mass());
    center_m_ = frame_.point_to_device(center);
    const Vec3 velocity = moment.time_scale * to_core(state_->get_linear_velocity()) -
                          moment.node->velocity_at(center - frame_.origin);
    velocity_m_s_ = frame_.velocity_to_device(velocity);
    angular_rad_s_ = frame_.turn_to_device(
        moment.time_scale * to_core(state_->get_angular_velocity()) - moment.node->angular_rad_s());
}

void NearBody::read_place(const Moment &moment) {
    mode_ = PhysicsServer3D::get_singleton()->body_get_mode(rid_);
    belt_m_s_ = Vec3(0.0);
    belt_rad_s_ = Vec3(0.0);
    if (moved_by_physics()) {
        read_moved(moment);
        return;
    }
    const bool is_static = mode_ == PhysicsServer3D::BODY_MODE_STATIC;
    frame_ = is_static ? moment.now : moment.in_space;
    if (is_static) {
        // The server learns of a node's motion only at the end of a tick.
        if (auto *node = Object::cast_to<Node3D>(ObjectDB::get_instance(object_));
            node != nullptr && node->is_inside_tree()) {
            node->force_update_transform();
        }
    }
    set_place(state_->get_transform());
    mass_kg_ = 0.0;
    const Placement at = in_frame(frame_, basis_, origin_);
    center_m_ = at.origin_m;
    // An object that moves with the node is at rest for the device. NodeMotion ignores the jump of
    // a teleported object.
    motion_.note({at.rotation, at.origin_m, 1.0}, moment.tick_s);
    velocity_m_s_ = motion_.velocity_at(Vec3(0.0));
    angular_rad_s_ = motion_.angular_rad_s();
    read_belt(moment);
}

// Jolt's server state does not contain them, so that a node is read. A static body without a node
// is read from the server, which only GodotPhysics supports; for an animated one the server mixes
// them with its motion.
void NearBody::read_belt(const Moment &moment) {
    Vec3 velocity(0.0);
    Vec3 turning(0.0);
    if (is_node_) {
        const auto *node = Object::cast_to<godot::StaticBody3D>(ObjectDB::get_instance(object_));
        if (node == nullptr) {
            return;
        }
        velocity = to_core(node->get_constant_linear_velocity());
        turning = to_core(node->get_constant_angular_velocity());
    } else if (mode_ == PhysicsServer3D::BODY_MODE_STATIC) {
        velocity = to_core(state_->get_linear_velocity());
        turning = to_core(state_->get_angular_velocity());
    }
    if (turning != Vec3(0.0)) {
        // The engines apply the turn about the center of mass.
        velocity -= glm::cross(turning, to_core(state_->get_center_of_mass()));
    }
    belt_m_s_ = frame_.velocity_to_device(moment.time_scale * velocity);
    belt_rad_s_ = frame_.turn_to_device(moment.time_scale * turning);
}

void NearBody::read_list(ShapeShelf &shelf, std::int32_t &next_id, int count) {
    auto *server = PhysicsServer3D::get_singleton();
    const std::size_t before = shapes_.size();
    shapes_.resize(static_cast<std::size_t>(count));
    for (std::size_t i = before; i < shapes_.size(); ++i) {
        shapes_[i].id = next_id;
        next_id = next_id == 0x7fffffff ? 1 : next_id + 1;
    }
    for (int i = 0; i < count; ++i) {
        BodyShape &shape = shapes_[static_cast<std::size_t>(i)];
        shape.shape = server->body_get_shape(rid_, i);
        shape.local = server->body_get_shape_transform(rid_, i);
        shape.source = shelf.find(shape.shape);
        bound(shape);
    }
    read_owners();
}

void NearBody::bound(BodyShape &shape) {
    const ShapeBounds &data = shape.source->data.bounds;
    const Mat3 axes = to_core(shape.local.basis);
    const Vec3 half = 0.5 * (data.upper - data.lower);
    shape.bounded = shape.source->bounds;
    shape.radius = std::numeric_limits<double>::infinity();
    if (data.known()) {
        const Vec3 middle = 0.5 * (data.upper + data.lower);
        shape.middle = to_core(shape.local.origin) + axes * middle;
        shape.radius = glm::length(half.x * glm::abs(axes[0]) + half.y * glm::abs(axes[1]) +
                                   half.z * glm::abs(axes[2]));
    }
}

void NearBody::read_owners() {
    auto *node =
        is_node_ ? Object::cast_to<CollisionObject3D>(ObjectDB::get_instance(object_)) : nullptr;
    if (node == nullptr) {
        return;
    }
    for (BodyShape &shape : shapes_) {
        shape.owner = -1;
        shape.disabled = false;
    }
    for_owned_shapes(*node, [this](std::uint32_t owner, std::size_t index, bool disabled) {
        if (index < shapes_.size()) {
            shapes_[index].owner = owner;
            shapes_[index].disabled = disabled;
        }
    });
}

void NearBody::read_shape(ShapeShelf &shelf, int index) {
    auto *server = PhysicsServer3D::get_singleton();
    BodyShape &shape = shapes_[static_cast<std::size_t>(index)];
    const godot::RID rid = server->body_get_shape(rid_, index);
    const godot::Transform3D local = server->body_get_shape_transform(rid_, index);
    if (local != shape.local) {
        shape.local = local;
        shape.bounded = 0;
    }
    if (rid != shape.shape) {
        shape.shape = rid;
        shape.bounded = 0;
        shape.source = shelf.find(rid);
        read_owners();
    } else if (shape.owner >= 0) {
        const auto *node = Object::cast_to<CollisionObject3D>(ObjectDB::get_instance(object_));
        shape.disabled = node != nullptr &&
                         node->is_shape_owner_disabled(static_cast<std::uint32_t>(shape.owner));
    }
    if (shape.listed) {
        shelf.look_again(*shape.source);
    } else {
        shape.source->used_tick = shelf.tick();
    }
    if (shape.bounded != shape.source->bounds) {
        bound(shape);
    }
}

void NearBody::read_shapes(ShapeShelf &shelf, std::int32_t &next_id) {
    const int count = PhysicsServer3D::get_singleton()->body_get_shape_count(rid_);
    if (count != static_cast<int>(shapes_.size())) {
        read_list(shelf, next_id, count);
        return;
    }
    if (shapes_.size() <= kShapesPerTick) {
        for (int i = 0; i < count; ++i) {
            read_shape(shelf, i);
        }
        return;
    }
    for (int i = 0; i < count; ++i) {
        if (shapes_[static_cast<std::size_t>(i)].listed) {
            read_shape(shelf, i);
        }
    }
    for (std::size_t i = 0; i < kShapesPerTick; ++i) {
        rolling_ = rolling_ + 1 < shapes_.size() ? rolling_ + 1 : 0;
        read_shape(shelf, static_cast<int>(rolling_));
    }
}

void NearBody::read_facts(BodyFactsReader &reader) {
    facts_ = reader.read(rid_, object_, is_node_);
}

bool NearBody::spares(std::uint64_t other) const {
    auto *body = Object::cast_to<godot::PhysicsBody3D>(ObjectDB::get_instance(object_));
    const Object *wanted = ObjectDB::get_instance(other);
    if (body == nullptr || wanted == nullptr) {
        return false;
    }
    const godot::Array spared = body->get_collision_exceptions();
    for (std::int64_t i = 0; i < spared.size(); ++i) {
        if (static_cast<Object *>(spared[i]) == wanted) {
            return true;
        }
    }
    return false;
}

std::string NearBody::name() const {
    const auto *node = Object::cast_to<godot::Node>(ObjectDB::get_instance(object_));
    if (node == nullptr) {
        return "A body without a node";
    }
    return godot::String(node->get_name()).utf8().get_data();
}

} // namespace spidar
