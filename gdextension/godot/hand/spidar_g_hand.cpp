// Functions of a hand for scripts, and its place in the scene tree.
#include "godot/hand/spidar_g_hand.h"

#include <cmath>
#include <cstdio>
#include <limits>

#include <godot_cpp/classes/engine.hpp>
#include <godot_cpp/classes/scene_tree.hpp>
#include <godot_cpp/variant/callable_method_pointer.hpp>
#include <godot_cpp/variant/utility_functions.hpp>

#include "device/contract/dof_lanes.h"
#include "godot/base/type_conversions.h"

using godot::Transform3D;
using godot::Vector3;
using spidar::ToolPose;
using spidar::Vec3;

void SpidarGHand::refuse(const std::string &message) const {
    godot::UtilityFunctions::push_error(spidar::to_godot("SpidarGHand." + message));
}

double SpidarGHand::checked_number(const char *name, double value, double old, double least,
                                   double most, const char *unit) const {
    if (value >= least && value <= most) {
        return value;
    }
    char text[200];
    (void)std::snprintf(text, sizeof text, "%s = %g %s: give %g to %g; the old value stays.", name,
                        value, unit, least, most);
    refuse(text);
    return old;
}

void SpidarGHand::set_collision_mask(std::int64_t mask) {
    if (mask < 0 || mask > std::numeric_limits<std::uint32_t>::max()) {
        refuse("collision_mask = " + std::to_string(mask) +
               ": give 0 to 4294967295 (32 bits); the old value stays.");
        return;
    }
    collision_mask_ = mask;
}

void SpidarGHand::_enter_tree() {
    spidar_ = cast_to<SpidarG>(get_parent());
    set_physics_process(spidar_ != nullptr && !godot::Engine::get_singleton()->is_editor_hint());
    update_configuration_warnings();
    place_.entered(*this);
    if (!godot::Engine::get_singleton()->is_editor_hint()) {
        surroundings_.open();
        scene_joints_.read(*get_node_or_null(godot::NodePath("/root")));
        get_tree()->connect("node_added", callable_mp(this, &SpidarGHand::note_node));
    }
}

void SpidarGHand::_ready() {
    // Repeated, since the engine turns physics processing on just before this.
    set_physics_process(spidar_ != nullptr && !godot::Engine::get_singleton()->is_editor_hint());
}

void SpidarGHand::_exit_tree() {
    if (!godot::Engine::get_singleton()->is_editor_hint()) {
        release();
        withdraw();
        surroundings_.clear();
        get_tree()->disconnect("node_added", callable_mp(this, &SpidarGHand::note_node));
        scene_joints_.clear();
    }
    spidar_ = nullptr;
    stepped_.reset();
}

godot::PackedStringArray SpidarGHand::_get_configuration_warnings() const {
    return spidar::HandPlace::warnings(*this);
}

bool SpidarGHand::is_open() const {
    return spidar_ != nullptr && spidar_->get_state() != SpidarG::STATE_CLOSED;
}

spidar::Jaws SpidarGHand::jaws() const {
    const godot::Ref<SpidarGConfig> config = spidar_->get_effective_config();
    return {config->get_jaw_open(), config->get_jaw_closed_angle()};
}

ToolPose SpidarGHand::device_pose() const {
    const spidar::GripState &grip = spidar_->snapshot().grip;
    return {grip.pose.position_m, grip.frame.rotation, grip.frame.grasp_angle_rad};
}

ToolPose SpidarGHand::proxy_pose() const {
    const spidar::TouchReport &touch = spidar_->snapshot().touch;
    // Before the first scene is rendered, and while none is wanted.
    if (touch.sequence == 0 || published_ == Published::nothing) {
        return device_pose();
    }
    return {touch.position_m, touch.rotation, touch.grasp_rad};
}

double SpidarGHand::get_held_width() const {
    if (!hold_.holds() || spidar_ == nullptr) {
        return 0.0;
    }
    return jaws().gap_m(held_stop_rad_) * spidar_->get_workspace_scale();
}

Transform3D SpidarGHand::get_wanted_pose() const {
    if (!hold_.holds() || spidar_ == nullptr) {
        return {};
    }
    // Below the device by the distance to which the weight bends the tool's springs.
    const spidar::TouchReport &touch = spidar_->snapshot().touch;
    spidar::DofLanes bent = spidar::lanes(pull_.own);
    for (std::size_t dof = 0; dof < bent.size(); ++dof) {
        bent[dof] = touch.stiffness[dof] > 0.0 ? bent[dof] / touch.stiffness[dof] : 0.0;
    }
    const ToolPose free =
        spidar::moved(device_pose(), spidar::of_lanes<spidar::Displacement>(bent));
    return hold_.where(spidar_->world().pose_to_world(free.position_m, free.rotation));
}

double SpidarGHand::get_stop_angle() const {
    if (hold_.holds()) {
        return held_stop_rad_;
    }
    if (pinch_.body != 0) {
        return pinch_.width_rad;
    }
    if (is_open() && published_ != Published::nothing &&
        spidar_->snapshot().touch.stop_push_nm > 0.0) {
        return jaws().closed_rad;
    }
    return std::numeric_limits<double>::quiet_NaN();
}

void SpidarGHand::add_load(const Vector3 &force_n, const Vector3 &moment_nm) {
    if (spidar_ == nullptr) {
        return;
    }
    const spidar::WorldFrame frame = spidar_->world();
    load_.add(frame.turn_to_device(spidar::to_core(force_n)),
              frame.turn_to_device(spidar::to_core(moment_nm)));
}

void SpidarGHand::detain(const Transform3D &seat) {
    if (hold_.holds()) {
        hold_.detain(seat);
    }
}

void SpidarGHand::release() {
    if (!hold_.holds()) {
        return;
    }
    godot::RigidBody3D *const body = hold_.body();
    const godot::Callable let_go = callable_mp(this, &SpidarGHand::release);
    if (body != nullptr && body->is_connected("tree_exiting", let_go)) {
        body->disconnect("tree_exiting", let_go);
    }
    spidar::forget_hold(hold_.body_id(), get_instance_id());
    hold_.detach(spidar_ != nullptr ? spidar_->get_workspace_scale() : 1.0);
    held_shapes_.drop();
    held_joints_.drop();
    partners_.drop();
    judge_.reset();
    pinch_ = {};
    emit_signal("body_released", body);
    tell_held();
}

Transform3D SpidarGHand::shown_grip() const {
    if (hold_.holds()) {
        return hold_.carried_grip();
    }
    const ToolPose pose = proxy_pose();
    return spidar_->world().pose_to_world(pose.position_m, pose.rotation);
}

Transform3D SpidarGHand::get_proxy_transform() const {
    return spidar_ != nullptr ? shown_grip() : get_global_transform();
}

Transform3D SpidarGHand::get_pad_transform(int side) const {
    if (spidar_ == nullptr) {
        return get_global_transform();
    }
    const double scale = spidar_->get_workspace_scale();
    const Transform3D grip = shown_grip();
    const ToolPose pose{Vec3(0.0), spidar::to_core(grip.basis),
                        hold_.holds() ? held_stop_rad_ : proxy_pose().grasp_rad};
    const spidar::Placement face = spidar::Pads::face(side, jaws(), pose);
    return {spidar::to_godot(face.rotation), grip.origin + spidar::to_godot(scale * face.origin_m)};
}

Vector3 SpidarGHand::get_pad_position(int side) const {
    return get_pad_transform(side).origin;
}

double SpidarGHand::get_pad_radius() const {
    if (spidar_ == nullptr) {
        return spidar::pad_radius_m(spidar::Jaws());
    }
    return spidar::pad_radius_m(jaws()) * spidar_->get_workspace_scale();
}
