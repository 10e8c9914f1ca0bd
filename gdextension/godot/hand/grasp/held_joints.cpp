#include "godot/hand/grasp/held_joints.h"

#include <cmath>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <godot_cpp/classes/cone_twist_joint3d.hpp>
#include <godot_cpp/classes/generic6_dof_joint3d.hpp>
#include <godot_cpp/classes/hinge_joint3d.hpp>
#include <godot_cpp/classes/physics_body3d.hpp>
#include <godot_cpp/classes/physics_direct_body_state3d.hpp>
#include <godot_cpp/classes/physics_server3d.hpp>
#include <godot_cpp/classes/rigid_body3d.hpp>
#include <godot_cpp/classes/slider_joint3d.hpp>

#include "core/geometry/rotation_log.h"
#include "godot/base/type_conversions.h"
#include "godot/hand/grasp/joint_frames.h"

namespace spidar {

namespace {

using godot::ConeTwistJoint3D;
using godot::Generic6DOFJoint3D;
using godot::HingeJoint3D;
using godot::Object;
using godot::ObjectDB;
using godot::SliderJoint3D;
using godot::Transform3D;

using Axes = std::array<JointAxis, 6>;
constexpr std::size_t kTurns = 3; // the first turn among the axes

JointAxis limited(double lower, double upper) {
    JointAxis axis;
    axis.lower = lower;
    axis.upper = upper;
    return axis;
}

// The engine gives the pose of the second body in the first one's frame, with turns in the opposite
// sense.
Axes axes_of(const HingeJoint3D &joint, double tick_s) {
    Axes axes{};
    JointAxis &hinge = axes[kTurns + 2];
    hinge = joint.get_flag(HingeJoint3D::FLAG_USE_LIMIT)
                ? limited(joint.get_param(HingeJoint3D::PARAM_LIMIT_LOWER),
                          joint.get_param(HingeJoint3D::PARAM_LIMIT_UPPER))
                : JointAxis::free();
    if (joint.get_flag(HingeJoint3D::FLAG_ENABLE_MOTOR)) {
        hinge.motor_speed = joint.get_param(HingeJoint3D::PARAM_MOTOR_TARGET_VELOCITY);
        hinge.motor_most = joint.get_param(HingeJoint3D::PARAM_MOTOR_MAX_IMPULSE) / tick_s;
    }
    return axes;
}

Axes axes_of(const SliderJoint3D &joint) {
    Axes axes{};
    axes[0] = limited(joint.get_param(SliderJoint3D::PARAM_LINEAR_LIMIT_LOWER),
                      joint.get_param(SliderJoint3D::PARAM_LINEAR_LIMIT_UPPER));
    return axes;
}

Axes axes_of(const ConeTwistJoint3D &joint) {
    Axes axes{};
    const double swing = joint.get_param(ConeTwistJoint3D::PARAM_SWING_SPAN);
    const double twist = joint.get_param(ConeTwistJoint3D::PARAM_TWIST_SPAN);
    axes[kTurns] = limited(-twist, twist);
    axes[kTurns + 1] = limited(-swing, swing);
    axes[kTurns + 2] = limited(-swing, swing);
    return axes;
}

Axes ball_axes() {
    Axes axes{};
    for (std::size_t axis = kTurns; axis < axes.size(); ++axis) {
        axes[axis] = JointAxis::free();
    }
    return axes;
}

struct SixWays {
    const Generic6DOFJoint3D &joint;

    [[nodiscard]] double value(int axis, Generic6DOFJoint3D::Param param) const {
        switch (axis) {
        case 0:
            return joint.get_param_x(param);
        case 1:
            return joint.get_param_y(param);
        default:
            return joint.get_param_z(param);
        }
    }
    [[nodiscard]] bool flag(int axis, Generic6DOFJoint3D::Flag flag) const {
        switch (axis) {
        case 0:
            return joint.get_flag_x(flag);
        case 1:
            return joint.get_flag_y(flag);
        default:
            return joint.get_flag_z(flag);
        }
    }
};

Axes axes_of(const Generic6DOFJoint3D &joint) {
    using Six = Generic6DOFJoint3D;
    const SixWays ways{joint};
    Axes axes{};
    for (int k = 0; k < 3; ++k) {
        JointAxis &way = axes[static_cast<std::size_t>(k)];
        way = ways.flag(k, Six::FLAG_ENABLE_LINEAR_LIMIT)
                  ? limited(ways.value(k, Six::PARAM_LINEAR_LOWER_LIMIT),
                            ways.value(k, Six::PARAM_LINEAR_UPPER_LIMIT))
                  : JointAxis::free();
        if (ways.flag(k, Six::FLAG_ENABLE_LINEAR_SPRING)) {
            way.stiffness = ways.value(k, Six::PARAM_LINEAR_SPRING_STIFFNESS);
            way.damping = ways.value(k, Six::PARAM_LINEAR_SPRING_DAMPING);
            way.rest = ways.value(k, Six::PARAM_LINEAR_SPRING_EQUILIBRIUM_POINT);
        }
        if (ways.flag(k, Six::FLAG_ENABLE_LINEAR_MOTOR)) {
            way.motor_speed = ways.value(k, Six::PARAM_LINEAR_MOTOR_TARGET_VELOCITY);
            way.motor_most = ways.value(k, Six::PARAM_LINEAR_MOTOR_FORCE_LIMIT);
        }
        JointAxis &turn = axes[kTurns + static_cast<std::size_t>(k)];
        turn = ways.flag(k, Six::FLAG_ENABLE_ANGULAR_LIMIT)
                   ? limited(ways.value(k, Six::PARAM_ANGULAR_LOWER_LIMIT),
                             ways.value(k, Six::PARAM_ANGULAR_UPPER_LIMIT))
                   : JointAxis::free();
        if (ways.flag(k, Six::FLAG_ENABLE_ANGULAR_SPRING)) {
            turn.stiffness = ways.value(k, Six::PARAM_ANGULAR_SPRING_STIFFNESS);
            turn.damping = ways.value(k, Six::PARAM_ANGULAR_SPRING_DAMPING);
            turn.rest = ways.value(k, Six::PARAM_ANGULAR_SPRING_EQUILIBRIUM_POINT);
        }
        if (ways.flag(k, Six::FLAG_ENABLE_MOTOR)) {
            turn.motor_speed = ways.value(k, Six::PARAM_ANGULAR_MOTOR_TARGET_VELOCITY);
            turn.motor_most = ways.value(k, Six::PARAM_ANGULAR_MOTOR_FORCE_LIMIT);
        }
    }
    return axes;
}

Axes axes_of(const godot::Joint3D &joint, double tick_s) {
    if (const auto *hinge = Object::cast_to<HingeJoint3D>(&joint)) {
        return axes_of(*hinge, tick_s);
    }
    if (const auto *slider = Object::cast_to<SliderJoint3D>(&joint)) {
        return axes_of(*slider);
    }
    if (const auto *cone = Object::cast_to<ConeTwistJoint3D>(&joint)) {
        return axes_of(*cone);
    }
    if (const auto *six = Object::cast_to<Generic6DOFJoint3D>(&joint)) {
        return axes_of(*six);
    }
    return ball_axes();
}

// Returns the axis counted in the opposite sense.
JointAxis mirrored(const JointAxis &axis) {
    JointAxis other = axis;
    other.lower = -axis.upper;
    other.upper = -axis.lower;
    other.rest = -axis.rest;
    other.motor_speed = -axis.motor_speed;
    return other;
}

// Converts an axis from scene to device meters. Forces are equal in both; a moment of the scene acts
// at levers that are `scale` times as long.
JointAxis in_device(const JointAxis &axis, bool is_turn, double scale) {
    JointAxis device = axis;
    if (is_turn) {
        device.stiffness /= scale;
        device.damping /= scale;
        device.motor_most /= scale;
        return device;
    }
    if (axis.is_limited() || axis.is_locked()) {
        device.lower /= scale;
        device.upper /= scale;
    }
    device.rest /= scale;
    device.motor_speed /= scale;
    device.stiffness *= scale;
    device.damping *= scale;
    return device;
}

// Adds the body's own dampings, by which the engine slows it, along and about the axes that are not
// locked.
void add_damping(const godot::RigidBody3D &body, const Transform3D &frame, Axes &axes) {
    auto *const state =
        godot::PhysicsServer3D::get_singleton()->body_get_direct_state(body.get_rid());
    if (state == nullptr) {
        return;
    }
    const auto mass_kg = static_cast<double>(body.get_mass());
    const double linear = mass_kg * static_cast<double>(state->get_total_linear_damp());
    const auto angular = static_cast<double>(state->get_total_angular_damp());
    const Vec3 lever_m = to_core(
        body.get_global_transform().xform(state->get_center_of_mass_local()) - frame.origin);
    const Mat3 inverse = to_core(state->get_inverse_inertia_tensor());
    const Mat3 turn = to_core(frame.basis);
    for (int k = 0; k < 3; ++k) {
        JointAxis &way = axes[static_cast<std::size_t>(k)];
        JointAxis &about = axes[kTurns + static_cast<std::size_t>(k)];
        way.damping += way.is_locked() ? 0.0 : linear;
        const double soft = glm::dot(turn[k], inverse * turn[k]);
        const Vec3 arm_m = lever_m - glm::dot(lever_m, turn[k]) * turn[k];
        if (!about.is_locked() && soft > 0.0) {
            about.damping += angular / soft + linear * glm::dot(arm_m, arm_m);
        }
    }
}

// A body that nothing holds in place hangs on the held one: the physics engine moves it.
bool gives_way(const godot::PhysicsBody3D *body) {
    const auto *const rigid = Object::cast_to<godot::RigidBody3D>(body);
    return rigid != nullptr && !rigid->is_freeze_enabled();
}

} // namespace

int HeldJoints::take(SceneJoints &joints, const godot::RigidBody3D &body) {
    held_ = joints.of(body.get_instance_id());
    const int more = static_cast<int>(held_.size()) - kMaxToolJoints;
    if (more > 0) {
        held_.resize(kMaxToolJoints);
    }
    return std::max(more, 0);
}

std::vector<ToolJoint> HeldJoints::now(const godot::RigidBody3D &body, const Transform3D &in_grip,
                                       const WorldFrame &frame, double tick_s) {
    std::vector<ToolJoint> all;
    std::unordered_map<std::uint64_t, Placement> bases;
    std::erase_if(held_, [](const SceneJoints::Found &one) {
        const auto *const node = Object::cast_to<godot::Joint3D>(ObjectDB::get_instance(one.joint));
        const bool ties = node != nullptr && node->is_inside_tree() &&
                          !node->is_queued_for_deletion() &&
                          !(node->get_node_a().is_empty() && node->get_node_b().is_empty());
        return !ties || (one.other.body != 0 && ObjectDB::get_instance(one.other.body) == nullptr);
    });
    for (const SceneJoints::Found &one : held_) {
        const auto *const node = Object::cast_to<godot::Joint3D>(ObjectDB::get_instance(one.joint));
        const auto *const other =
            Object::cast_to<godot::PhysicsBody3D>(ObjectDB::get_instance(one.other.body));
        if (gives_way(other)) {
            continue;
        }
        const Transform3D base =
            other != nullptr ? other->get_global_transform().orthonormalized() * one.other.frame
                             : one.other.frame;
        ToolJoint joint = joint_between(one.joint, base, in_grip * one.held.frame, frame);
        const auto before = bases_.find(one.joint);
        if (before != bases_.end()) {
            joint.velocity_m_s = (joint.base.origin_m - before->second.origin_m) / tick_s;
            joint.angular_rad_s =
                rotation_log(joint.base.rotation * glm::transpose(before->second.rotation)) /
                tick_s;
        }
        bases[one.joint] = joint.base;
        Axes axes = axes_of(*node, tick_s);
        add_damping(body, base, axes);
        for (std::size_t axis = 0; axis < axes.size(); ++axis) {
            const bool is_turn = axis >= kTurns;
            // The engine measures translations of the second body in the first, and turns of the
            // first in the second.
            const JointAxis &counted =
                one.held_is_first == is_turn ? axes[axis] : mirrored(axes[axis]);
            joint.axes[axis] = in_device(counted, is_turn, frame.scale);
        }
        all.push_back(joint);
    }
    bases_ = std::move(bases);
    return all;
}

} // namespace spidar
