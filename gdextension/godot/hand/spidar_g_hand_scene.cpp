// Publishing of a hand's scene to its device, and reports about it.
#include "godot/hand/spidar_g_hand.h"

#include <cmath>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <godot_cpp/classes/engine.hpp>
#include <godot_cpp/classes/physics_direct_body_state3d.hpp>
#include <godot_cpp/classes/physics_direct_space_state3d.hpp>
#include <godot_cpp/classes/physics_server3d.hpp>
#include <godot_cpp/classes/scene_tree.hpp>
#include <godot_cpp/classes/world3d.hpp>
#include <godot_cpp/variant/utility_functions.hpp>

#include "godot/base/physics_tick.h"
#include "godot/base/type_conversions.h"

using godot::Engine;
using godot::PhysicsServer3D;
using spidar::Placement;
using spidar::ToolPose;
using spidar::Vec3;

namespace {

// Limit of a stiffness relative to mass / frame^2. The reaction on a pushed body comes one game
// frame late; above the limit a light body would bounce between the tool's push and its own answer.
// In fast motion a frame is long in game time.
constexpr double kPushedStiffnessRatio = 0.5;

// Returns a box around the tool on its way from the device's pose to the proxy's.
spidar::SearchVolume spanned(const Placement &proxy, const Vec3 &device_m, const Vec3 &half_m) {
    spidar::SearchVolume volume;
    const Vec3 apart = device_m - proxy.origin_m;
    volume.at = {proxy.origin_m + 0.5 * apart, proxy.rotation};
    volume.half_extents_m = half_m + 0.5 * glm::abs(glm::transpose(proxy.rotation) * apart);
    return volume;
}

const char *name_of(spidar::ShapeKind kind) {
    switch (kind) {
    case spidar::ShapeKind::box:
        return "box";
    case spidar::ShapeKind::sphere:
        return "sphere";
    case spidar::ShapeKind::capsule:
        return "capsule";
    case spidar::ShapeKind::cylinder:
        return "cylinder";
    case spidar::ShapeKind::hull:
        return "hull";
    case spidar::ShapeKind::mesh:
        return "mesh";
    case spidar::ShapeKind::height_map:
        return "height_map";
    case spidar::ShapeKind::half_space:
        return "half_space";
    case spidar::ShapeKind::relief:
        return "relief";
    }
    return "";
}

} // namespace

spidar::SearchVolume SpidarGHand::pads_volume() const {
    const ToolPose proxy = proxy_pose();
    const ToolPose device = device_pose();
    const spidar::Jaws jaw = jaws();
    const double gap_m = std::max(jaw.gap_m(proxy.grasp_rad), jaw.gap_m(device.grasp_rad));
    const Vec3 half_m(0.5 * gap_m + spidar::pad_thickness_m(jaw), spidar::pad_radius_m(jaw),
                      spidar::pad_radius_m(jaw));
    spidar::SearchVolume volume =
        spanned({proxy.position_m, proxy.rotation}, device.position_m, half_m);
    volume.margin_m = contact_margin_;
    volume.mask = static_cast<std::uint32_t>(collision_mask_);
    if (hold_.holds()) {
        volume.excluded.push_back(hold_.body()->get_rid());
    }
    return volume;
}

Placement SpidarGHand::held_in_grip() const {
    const godot::Transform3D in_grip = hold_.in_grip();
    return {spidar::to_core(in_grip.origin) / spidar_->get_workspace_scale(),
            spidar::to_core(in_grip.basis.orthonormalized())};
}

spidar::SearchVolume SpidarGHand::held_volume() const {
    const ToolPose proxy = proxy_pose();
    const Placement in_grip = held_in_grip();
    const spidar::TurnedBox &box = held_shapes_.box();
    const Placement middle = Placement{proxy.position_m, proxy.rotation} * in_grip * box.at;
    const Vec3 ahead = device_pose().position_m - proxy.position_m;
    spidar::SearchVolume volume = spanned(middle, middle.origin_m + ahead, box.half_extents_m);
    volume.margin_m = contact_margin_;
    volume.mask = static_cast<std::uint32_t>(hold_.body()->get_collision_mask());
    volume.excluded.push_back(hold_.body()->get_rid());
    return volume;
}

void SpidarGHand::gather() {
    const godot::Ref<godot::World3D> world = get_world_3d();
    spidar::SearchSpace space;
    space.state = world->get_direct_space_state();
    space.space = world->get_space();
    space.now = now_;
    space.stepped = stepped();
    space.tick_s = spidar::physics_tick_s();
    space.time_scale = Engine::get_singleton()->get_time_scale();
    const spidar::SearchVolume pads = pads_volume();
    if (hold_.holds() && !hold_.is_detained()) {
        const spidar::SearchVolume held = held_volume();
        surroundings_.update(space, pads, &held, hold_.body_id());
    } else {
        surroundings_.update(space, pads, nullptr, hold_.body_id());
    }
    touched_.note(surroundings_.shapes());
    for (const std::string &message : surroundings_.take_messages()) {
        godot::UtilityFunctions::push_warning(spidar::to_godot("SpidarGHand: " + message));
    }
}

spidar::HandFeel SpidarGHand::feel() const {
    spidar::HandFeel feel;
    feel.contacts = render_contacts_;
    feel.width = render_width_;
    feel.stiffness_n_m = contact_stiffness_;
    feel.damping_n_s_m = contact_damping_;
    feel.friction = contact_friction_;
    feel.centres_itself = !hold_.holds() && spidar_->get_state() != SpidarG::STATE_ACTIVE;
    feel.pinched = hold_.holds() ? 0 : pinch_.body;
    feel.squeeze_nm_rad = hold_.holds() ? held_squeeze_nm_rad_ : pinch_.facts.squeeze_nm_rad;
    const double per_frame = spidar::physics_ticks_per_second() /
                             std::max(Engine::get_singleton()->get_time_scale(), 1.0);
    // Stiffness is per device meter, but the body moves in scene meters.
    feel.pushed_n_m_kg =
        kPushedStiffnessRatio * per_frame * per_frame * spidar_->get_workspace_scale();
    return feel;
}

// Evaluated for each new pose only: ticks that share a drawn frame get the same result.
void SpidarGHand::look_at_held() {
    const godot::RigidBody3D *const body = hold_.body();
    const auto *const state =
        PhysicsServer3D::get_singleton()->body_get_direct_state(body->get_rid());
    held_ = {};
    if (state == nullptr) {
        return;
    }
    held_.mass_kg = body->get_mass();
    held_.gravity_m_s2 = now_.turn_to_device(spidar::to_core(state->get_total_gravity()));
    const Vec3 in_grip = spidar::to_core(hold_.in_grip().xform(state->get_center_of_mass_local()));
    held_.center_m = proxy_pose().rotation * in_grip / spidar_->get_workspace_scale();
}

spidar::HeldLoad::Pull SpidarGHand::load_of_held() const {
    spidar::HeldLoad::Terms terms;
    // Hands that hold a body together share its load.
    const auto others = spidar::other_holds(hold_.body_id(), get_instance_id()).size();
    terms.gain = weight_scale_ / (1.0 + static_cast<double>(others));
    terms.max_force_n = spidar_->get_effective_config()->get_max_force();
    terms.with_weight = render_weight_ && !hold_.is_detained(); // a socket carries what snapped in
    terms.with_inertia = render_inertia_ && !hold_.is_detained();
    return load_.pull(held_, terms);
}

void SpidarGHand::publish() {
    const spidar::Jaws jaw = jaws();
    const std::uint64_t sequence = spidar_->snapshot().touch.sequence;
    const bool is_new_device = sequence < seen_sequence_;
    seen_sequence_ = sequence;
    const bool is_empty = surroundings_.shapes().empty() && !hold_.holds();
    const bool is_told = published_ == Published::empty && !is_new_device &&
                         jaw.open_m == published_jaws_.open_m &&
                         jaw.closed_rad == published_jaws_.closed_rad;
    if (is_empty && is_told) {
        return; // the servo loop keeps it
    }
    published_ = is_empty ? Published::empty : Published::scene;
    published_jaws_ = jaw;
    pads_.fit(jaw);
    pull_ = {};
    if (!hold_.holds()) {
        spidar_->publish_touch(spidar::make_touch_scene(pads_, jaw, surroundings_.shapes(), nullptr,
                                                        feel(), spidar_->servo_settings(), {}));
        return;
    }
    const ToolPose proxy = proxy_pose();
    const spidar::HeldTool held{held_shapes_.parts(),
                                {proxy.position_m, proxy.rotation},
                                held_in_grip(),
                                held_stop_rad_,
                                hold_.is_detained()};
    if (render_weight_ || render_inertia_) {
        if (clock_.elapsed_s() > 0.0 || held_.mass_kg == 0.0) {
            look_at_held();
        }
        pull_ = load_of_held();
    }
    auto touch = spidar::make_touch_scene(pads_, jaw, surroundings_.shapes(), &held, feel(),
                                          spidar_->servo_settings(), pull_.all);
    if (!hold_.is_detained()) {
        add_joints(touch->tool);
    }
    spidar_->publish_touch(std::move(touch));
}

// Takes as many joints of the scene and ties to other hands as there is room for.
void SpidarGHand::add_joints(spidar::Tool &tool) {
    const godot::Transform3D in_grip = hold_.in_grip();
    const double tick_s = spidar::physics_tick_s();
    std::vector<spidar::ToolJoint> joints = held_joints_.now(*hold_.body(), in_grip, now_, tick_s);
    for (const spidar::ToolJoint &partner :
         partners_.now(spidar::other_holds(hold_.body_id(), get_instance_id()),
                       spidar_->snapshot().touch.stiffness, in_grip, now_, tick_s)) {
        joints.push_back(partner);
    }
    tool.joint_count = std::min(static_cast<int>(joints.size()), spidar::kMaxToolJoints);
    std::copy_n(joints.begin(), tool.joint_count, tool.joints.begin());
}

// Removes everything from the device.
void SpidarGHand::withdraw() {
    if (spidar_ != nullptr && published_ != Published::nothing) {
        spidar_->publish_touch(nullptr);
    }
    published_ = Published::nothing;
    pull_ = {};
    seen_sequence_ = 0;
    pinch_ = {};
    squeeze_nm_ = 0.0;
    pushes_.clear();
    touched_.clear();
    news_.clear(*this);
    drawing_.hide();
}

void SpidarGHand::draw() {
    const bool wanted = debug_draw_ || get_tree()->is_debugging_collisions_hint();
    if (!wanted) {
        drawing_.hide();
        return;
    }
    drawing_.draw(*this, {spidar_->world(), surroundings_.shapes(), spidar_->snapshot().touch,
                          proxy_pose(), device_pose(), jaws(), held_shapes_.parts(),
                          hold_.holds() ? held_in_grip() : Placement()});
}

// Hides the drawing at once: a hand in a paused tree has no tick that would.
void SpidarGHand::set_debug_draw(bool wanted) {
    debug_draw_ = wanted;
    if (!wanted) {
        drawing_.hide();
    }
}

godot::Array SpidarGHand::get_shapes_in_reach() const {
    godot::Array list;
    if (!acts_ || spidar_ == nullptr) {
        return list;
    }
    const spidar::WorldFrame frame = spidar_->world();
    for (const spidar::NearShape &shape : surroundings_.shapes()) {
        godot::Dictionary one;
        one["body"] = shape.body;
        one["collider"] = godot::ObjectDB::get_instance(shape.collider);
        one["shape"] = shape.shape_index;
        one["id"] = shape.id;
        one["type"] = name_of(shape.shape->kind());
        one["transform"] = frame.pose_to_world(shape.at.origin_m, shape.at.rotation);
        one["by_pads"] = (shape.seen_by & spidar::kSeenByPads) != 0;
        one["by_held"] = (shape.seen_by & spidar::kSeenByHeld) != 0;
        list.push_back(one);
    }
    return list;
}

godot::Array SpidarGHand::get_touch_points() const {
    godot::Array list;
    if (!acts_ || spidar_ == nullptr) {
        return list;
    }
    const spidar::WorldFrame frame = spidar_->world();
    const spidar::TouchReport &touch = spidar_->snapshot().touch;
    for (int i = 0; i < touch.point_count; ++i) {
        const spidar::TouchPointReport &point = touch.points[static_cast<std::size_t>(i)];
        const spidar::TouchedBody *const body = touched_.find(point.scene_id);
        godot::Dictionary one;
        one["position"] = spidar::to_godot(frame.point_to_world(point.point_m));
        one["normal"] = spidar::to_godot(frame.turn_to_world(point.normal));
        one["force"] = spidar::to_godot(frame.turn_to_world(point.force_n));
        one["gap"] = point.gap_m * frame.scale;
        one["collider"] = body != nullptr ? godot::ObjectDB::get_instance(body->collider) : nullptr;
        one["id"] = point.scene_id;
        one["tool"] = point.tool_id == spidar::kPadIds[0]   ? "pad0"
                      : point.tool_id == spidar::kPadIds[1] ? "pad1"
                                                            : "held";
        list.push_back(one);
    }
    return list;
}

godot::Dictionary SpidarGHand::get_touch_statistics() const {
    godot::Dictionary all;
    const spidar::SurroundingsCounts &near = surroundings_.counts();
    all["acts"] = acts_;
    all["since_s"] = clock_.elapsed_s();
    all["queries"] = near.queries;
    all["bodies"] = near.bodies;
    all["shapes"] = near.shapes;
    all["shapes_far"] = near.far;
    all["shapes_left_out"] = near.left_out;
    all["shapes_cooking"] = near.cooking;
    all["shapes_refused"] = near.refused;
    all["soft_bodies"] = near.soft_bodies;
    all["shapes_kept"] = surroundings_.shelf().held;
    const spidar::TouchReport touch =
        spidar_ != nullptr ? spidar_->snapshot().touch : spidar::TouchReport();
    all["points"] = touch.point_count;
    all["pairs"] = touch.queries;
    all["passes"] = touch.passes;
    all["cycles_skipped"] = static_cast<std::int64_t>(touch.skipped);
    return all;
}
