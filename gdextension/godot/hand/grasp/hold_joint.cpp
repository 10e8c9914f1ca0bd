#include "godot/hand/grasp/hold_joint.h"

#include <algorithm>
#include <unordered_map>

#include <godot_cpp/classes/animatable_body3d.hpp>
#include <godot_cpp/classes/generic6_dof_joint3d.hpp>
#include <godot_cpp/classes/physics_server3d.hpp>
#include <godot_cpp/classes/rigid_body3d.hpp>
#include <godot_cpp/core/memory.hpp>

#include "core/geometry/rotation_log.h"
#include "godot/base/type_conversions.h"

namespace spidar {

namespace {

using godot::Node;
using godot::ObjectDB;
using godot::PhysicsServer3D;
using godot::RigidBody3D;
using godot::Transform3D;
using godot::Vector3;

// Time in which the pads center a body that was grasped off-center.
constexpr double kCentringTime_s = 0.08;
// Time in which a body that leaves a seat is moved to the grip, instead of in one tick.
constexpr double kComingOff_s = 0.08;
// Largest speed of a released body (device m/s), so that a solver's last correction never throws
// it.
constexpr double kMaxReleaseSpeed_m_s = 2.0;

struct Holders {
    int count = 0;
    bool could_sleep = true; // before the first one
};

// Holders of each held body by its instance id: two hands may hold one body.
std::unordered_map<std::uint64_t, Holders> &all_holders() {
    static std::unordered_map<std::uint64_t, Holders> holders;
    return holders;
}

Transform3D moved_along_x(const Transform3D &place, double by_m) {
    return {place.basis, place.xform(Vector3(static_cast<GodotReal>(by_m), 0, 0))};
}

} // namespace

RigidBody3D *HoldJoint::body() const {
    return godot::Object::cast_to<RigidBody3D>(ObjectDB::get_instance(body_id_));
}

void HoldJoint::attach(godot::Node3D &hand, RigidBody3D &body, const Transform3D &grip,
                       double off_centre_m) {
    body_id_ = body.get_instance_id();
    off_centre_m_ = off_centre_m;
    age_s_ = 0.0;
    detained_ = false;
    time_runs_ = true;
    free_s_ = kComingOff_s;
    caught_ = grip.affine_inverse() * body.get_global_transform();
    Holders &holders = all_holders()[body_id_];
    if (holders.count == 0) {
        holders.could_sleep = body.is_able_to_sleep();
    }
    ++holders.count;
    body.set_can_sleep(false);
    body.set_sleeping(false);
    rig_ = memnew(godot::Node3D);
    rig_->set_as_top_level(true);
    // Not copied by duplicate(): the copy holds nothing.
    hand.add_child(rig_, false, Node::INTERNAL_MODE_BACK);
    tie(grip);
}

void HoldJoint::detach(double workspace_scale) {
    untie();
    rig_->queue_free();
    rig_ = nullptr;
    RigidBody3D *const held = body();
    auto &holders = all_holders();
    const auto mine = holders.find(body_id_);
    if (mine != holders.end() && --mine->second.count <= 0) {
        if (held != nullptr) {
            held->set_can_sleep(mine->second.could_sleep);
        }
        holders.erase(mine);
    }
    body_id_ = 0;
    if (held == nullptr) {
        return;
    }
    const Vector3 velocity = held->get_linear_velocity();
    const auto speed = static_cast<double>(velocity.length());
    const double most = kMaxReleaseSpeed_m_s * workspace_scale;
    if (speed > most) {
        held->set_linear_velocity(velocity * static_cast<GodotReal>(most / speed));
    }
}

bool HoldJoint::is_movable() const {
    const RigidBody3D *const held = body();
    if (held == nullptr || held->is_queued_for_deletion()) {
        return false;
    }
    auto *const server = PhysicsServer3D::get_singleton();
    return server->body_get_direct_state(held->get_rid()) != nullptr &&
           server->body_get_mode(held->get_rid()) >= PhysicsServer3D::BODY_MODE_RIGID;
}

void HoldJoint::advance(double delta_s) {
    age_s_ += delta_s;
    free_s_ += delta_s;
    detained_ = false;
    const bool runs = delta_s > 0.0;
    if (time_runs_ != runs) {
        time_runs_ = runs;
        if (runs) {
            tie_body();
        } else {
            untie_body();
        }
    }
}

void HoldJoint::detain(const Transform3D &seat) {
    detained_ = seat.is_finite();
    if (detained_) {
        seat_ = seat;
    }
}

double HoldJoint::off_centre_moved() const noexcept {
    const double part = std::clamp(age_s_ / kCentringTime_s, 0.0, 1.0);
    return off_centre_m_ * part * part * (3.0 - 2.0 * part);
}

Transform3D HoldJoint::centred(const Transform3D &grip) const {
    return moved_along_x(grip, -off_centre_moved());
}

Transform3D HoldJoint::in_grip() const {
    return centred(Transform3D()) * caught_;
}

void HoldJoint::follow(const Transform3D &grip) {
    if (!time_runs_) {
        return;
    }
    if (detained_) {
        const Transform3D at = seat_ * caught_.affine_inverse();
        from_seat_ = centred(grip).affine_inverse() * at;
        free_s_ = 0.0;
        anchor_->set_global_transform(at);
    } else {
        anchor_->set_global_transform(centred(grip) * way_left());
    }
}

Transform3D HoldJoint::way_left() const {
    const double part = std::clamp(1.0 - free_s_ / kComingOff_s, 0.0, 1.0);
    if (!(part > 0.0)) {
        return {};
    }
    const Mat3 turn =
        rotation_exp(part * rotation_log(to_core(from_seat_.basis.orthonormalized())));
    return {to_godot(turn), from_seat_.origin * static_cast<GodotReal>(part)};
}

void HoldJoint::jump(const Transform3D &grip) {
    RigidBody3D *const held = body();
    if (held == nullptr) {
        return;
    }
    untie();
    held->set_global_transform(where(grip));
    held->set_linear_velocity(Vector3());
    tie(centred(grip));
}

Transform3D HoldJoint::carried_grip() const {
    // Uses the body as drawn, one physics step behind the anchor, so that the pads do not run into
    // what they hold.
    RigidBody3D *const held = body();
    const Transform3D anchor =
        held != nullptr ? held->get_global_transform_interpolated() * caught_.affine_inverse()
                        : anchor_->get_global_transform();
    return moved_along_x(anchor, off_centre_moved());
}

double HoldJoint::stretch_m() const {
    const RigidBody3D *const held = body();
    if (held == nullptr || anchor_ == nullptr) {
        return 0.0;
    }
    const Transform3D wanted = anchor_->get_global_transform() * caught_;
    return held->get_global_position().distance_to(wanted.origin);
}

void HoldJoint::tie(const Transform3D &anchor_at) {
    anchor_ = memnew(godot::AnimatableBody3D);
    anchor_->set_sync_to_physics(false);
    anchor_->set_collision_layer(0);
    anchor_->set_collision_mask(0);
    // Placed before it enters the tree: otherwise a kinematic body sweeps to its place and takes
    // the grasped body along.
    anchor_->set_transform(anchor_at);
    rig_->add_child(anchor_);
    tie_body();
}

void HoldJoint::tie_body() {
    RigidBody3D *const held = body();
    if (held == nullptr) {
        return;
    }
    joint_ = memnew(godot::Generic6DOFJoint3D); // its limits are all locked at zero as made
    rig_->add_child(joint_);
    joint_->set_global_transform(held->get_global_transform());
    joint_->set_node_a(joint_->get_path_to(anchor_));
    joint_->set_node_b(joint_->get_path_to(held));
}

void HoldJoint::untie() {
    untie_body();
    if (anchor_ != nullptr) {
        anchor_->queue_free();
    }
    anchor_ = nullptr;
}

void HoldJoint::untie_body() {
    if (joint_ != nullptr) {
        joint_->set_node_a(godot::NodePath());
        joint_->set_node_b(godot::NodePath());
        joint_->queue_free();
    }
    joint_ = nullptr;
}

} // namespace spidar
