#include "godot/hand/grasp/scene_joints.h"

#include <utility>

#include <godot_cpp/classes/joint3d.hpp>
#include <godot_cpp/classes/physics_body3d.hpp>
#include <godot_cpp/core/object.hpp>
#include <godot_cpp/variant/node_path.hpp>

namespace spidar {

namespace {

using godot::Joint3D;
using godot::Node;
using godot::Object;
using godot::ObjectDB;

SceneJoints::Side side_of(const Joint3D &joint, const godot::NodePath &path) {
    SceneJoints::Side side;
    side.frame = joint.get_global_transform().orthonormalized();
    const auto *const body =
        path.is_empty() ? nullptr
                        : Object::cast_to<godot::PhysicsBody3D>(joint.get_node_or_null(path));
    if (body != nullptr) {
        side.body = body->get_instance_id();
        side.frame = body->get_global_transform().orthonormalized().affine_inverse() * side.frame;
    }
    return side;
}

// In the order in which the engine counts angles and ways: for a body that is tied to the world, the
// world is the first.
std::array<SceneJoints::Side, 2> sides_of(const Joint3D &joint) {
    std::array<SceneJoints::Side, 2> sides{side_of(joint, joint.get_node_a()),
                                           side_of(joint, joint.get_node_b())};
    if (sides[1].body == 0) {
        std::swap(sides[0], sides[1]);
    }
    return sides;
}

bool is_of_a_hand(const Node &node) {
    for (const Node *parent = node.get_parent(); parent != nullptr; parent = parent->get_parent()) {
        if (parent->is_class("SpidarGHand")) {
            return true;
        }
    }
    return false;
}

} // namespace

void SceneJoints::read(Node &root) {
    note(root);
    const std::int64_t count = root.get_child_count();
    for (std::int64_t i = 0; i < count; ++i) {
        read(*root.get_child(static_cast<std::int32_t>(i)));
    }
}

void SceneJoints::note(Node &node) {
    if (Object::cast_to<Joint3D>(&node) != nullptr) {
        new_.push_back(node.get_instance_id());
    }
}

void SceneJoints::clear() {
    known_.clear();
    new_.clear();
}

void SceneJoints::learn(std::uint64_t joint) {
    const auto *const node = Object::cast_to<Joint3D>(ObjectDB::get_instance(joint));
    if (node != nullptr && node->is_inside_tree() && !is_of_a_hand(*node)) {
        known_[joint] = {sides_of(*node)};
    }
}

void SceneJoints::update() {
    for (const std::uint64_t joint : std::exchange(new_, {})) {
        learn(joint);
    }
}

std::vector<SceneJoints::Found> SceneJoints::of(std::uint64_t body) {
    std::vector<Found> found;
    for (auto one = known_.begin(); one != known_.end();) {
        const auto *const node = Object::cast_to<Joint3D>(ObjectDB::get_instance(one->first));
        if (node == nullptr || !node->is_inside_tree()) {
            one = known_.erase(one);
            continue;
        }
        const std::array<Side, 2> now = sides_of(*node);
        std::array<Side, 2> &then = one->second.sides;
        if (now[0].body != then[0].body || now[1].body != then[1].body) {
            then = now; // the joint was moved to other bodies
        }
        for (const int side : {0, 1}) {
            const auto k = static_cast<std::size_t>(side);
            if (then[k].body == body) {
                found.push_back({one->first, then[k], then[1 - k], side == 0});
                break;
            }
        }
        ++one;
    }
    return found;
}

} // namespace spidar
