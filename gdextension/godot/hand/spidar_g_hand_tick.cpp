// Physics tick of a hand: reading the device, deciding what is held, and moving it.
#include "godot/hand/spidar_g_hand.h"

#include <cmath>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <godot_cpp/classes/engine.hpp>
#include <godot_cpp/variant/callable_method_pointer.hpp>

#include <godot_cpp/variant/utility_functions.hpp>

#include "godot/base/physics_tick.h"
#include "godot/base/type_conversions.h"

using godot::RigidBody3D;
using godot::Transform3D;
using spidar::Vec3;

namespace {

// A grip that has closed to within this angle of a body's width counts as touching.
constexpr double kTouchTolerance_rad = 0.01;
// Opening beyond the held body's width that releases it: 3 degrees. A smaller angle would drop it
// when a hand trembles.
constexpr double kReleaseAngle_rad = 0.052;
// Time within which trembling pads press a body again.
constexpr double kPinchKept_s = 0.1;
// Rate below which the jaws count as resting, and the time for it: a body that was grasped askew
// turns until its faces lie on the pads.
constexpr double kRestingRate_rad_s = 0.3;
constexpr double kRestTime_s = 0.04;
// Time constant that smooths the trembling of the fingers.
constexpr double kSqueezeTime_s = 0.024;

// Smallest changes of the held body's values that are emitted.
constexpr double kToldWeight_n = 0.01;
constexpr double kToldWidth_m = 1e-4;
constexpr double kToldSqueeze_nm = 2e-3;

} // namespace

void SpidarGHand::note_node(godot::Node *node) {
    scene_joints_.note(*node);
}

void SpidarGHand::_physics_process(double delta) {
    scene_joints_.update();
    acts_ = place_.may_act(*this) && is_open();
    if (!acts_) {
        release();
        withdraw();
        return;
    }
    now_ = spidar_->world();
    call_deferred("_remember_place");
    clock_.read(spidar_->get_device_time(), spidar::physics_tick_s());
    if (clock_.elapsed_s() > 0.0) {
        read_device(clock_.elapsed_s());
    }
    if (hold_.holds()) {
        watch_hold();
    }
    if (!hold_.holds() && delta > 0.0) { // nothing is lifted while the game's time stands still
        try_grasp();
    }
    if (hold_.holds()) {
        carry(delta);
    }
    gather();
    publish();
    if (clock_.elapsed_s() > 0.0) {
        push_bodies(clock_.elapsed_s());
    }
    draw();
    tell_held();
    news_.tell(spidar_->snapshot().touch, touched_, now_, *this);
}

void SpidarGHand::tell_held() {
    HeldFeel now;
    if (hold_.holds()) {
        now = {glm::length(pull_.weight_n), get_held_width(), squeeze_nm_};
    }
    const bool changed = std::abs(now.weight_n - told_.weight_n) > kToldWeight_n ||
                         std::abs(now.width_m - told_.width_m) > kToldWidth_m ||
                         std::abs(now.squeeze_nm - told_.squeeze_nm) > kToldSqueeze_nm ||
                         (told_.width_m > 0.0) != (now.width_m > 0.0);
    if (changed) {
        told_ = now;
        emit_signal("hold_changed", now.weight_n, now.width_m, now.squeeze_nm);
    }
}

// Called at the end of the tick. A velocity that a push has just given is not yet limited by the
// floor and other bodies, and would move the body's shapes in the device.
void SpidarGHand::push_bodies(double since_s) {
    spidar::BodyPushes::Terms terms;
    terms.frame = stepped();
    terms.most_n = spidar_->get_effective_config()->get_max_force();
    terms.since_s = since_s;
    terms.time_scale = godot::Engine::get_singleton()->get_time_scale();
    terms.jaws = jaws();
    terms.pose = proxy_pose();
    terms.twist = spidar_->snapshot().grip.twist;
    terms.node_m_s = spidar::to_core(spidar_->get_linear_velocity()) -
                     now_.velocity_to_world(terms.twist.linear_m_s);
    pushes_.push(spidar_->snapshot().touch, touched_, terms);
}

// The bodies of the physics space are where the last step left them, while the node of a device on
// a lift has moved on: by 17 mm at 1 m/s and 60 ticks per second. Called deferred, when all nodes
// have moved.
void SpidarGHand::remember_place() {
    if (spidar_ != nullptr && spidar_->is_inside_tree()) {
        stepped_ = spidar_->world();
    }
}

// Reads the device's events since the last pose.
void SpidarGHand::read_device(double since_s) {
    load_.follow(device_pose().position_m, since_s);
    watch_pinch(since_s);
}

void SpidarGHand::watch_pinch(double since_s) {
    const spidar::TouchReport &touch = spidar_->snapshot().touch;
    bool is_squeezing = hold_.holds() || touch.stop_push_nm > 0.0;
    if (!hold_.holds()) {
        const spidar::Pinch found = spidar::find_pinch(touch, touched_);
        if (found.body != 0) {
            if (found.body != pinch_.body) {
                judge_.reset();
                squeeze_nm_ = 0.0;
            }
            is_squeezing = true;
            pinch_age_s_ = 0.0;
            const double moved_rad = std::abs(found.width_rad - pinch_.width_rad);
            const bool rests =
                found.body == pinch_.body && moved_rad < kRestingRate_rad_s * since_s;
            resting_s_ = rests ? resting_s_ + since_s : 0.0;
            pinch_ = found;
        } else {
            pinch_age_s_ += since_s;
            if (pinch_age_s_ > kPinchKept_s) {
                pinch_ = {};
                resting_s_ = 0.0;
            }
        }
    }
    const double torque_nm =
        is_squeezing ? spidar::squeeze_nm(touch, spidar_->get_grasp_angle()) : 0.0;
    const double kept = std::exp(-since_s / kSqueezeTime_s);
    squeeze_nm_ =
        is_squeezing || pinch_.body != 0 ? torque_nm + kept * (squeeze_nm_ - torque_nm) : 0.0;
}

void SpidarGHand::try_grasp() {
    const double angle_rad = spidar_->get_grasp_angle();
    if (pinch_.body == 0 || angle_rad < pinch_.width_rad - kReleaseAngle_rad) {
        judge_.reset();
        return;
    }
    if (angle_rad < pinch_.width_rad - kTouchTolerance_rad) {
        return;
    }
    // The fingers push at the poles' ends: force = torque / pole half length.
    const double lever_m = spidar_->get_effective_config()->get_effective_pole_half_length();
    auto *const body = cast_to<RigidBody3D>(godot::ObjectDB::get_instance(pinch_.collider));
    const auto verdict =
        judge_.judge(pinch_, body, {pad_friction_, hold_torque_ / lever_m, weight_scale_},
                     squeeze_nm_ / lever_m, spidar_->get_grasp_rate(), clock_.elapsed_s());
    if (verdict == spidar::GraspJudge::Verdict::hold) {
        if (resting_s_ >= kRestTime_s) {
            attach(*body);
        }
    } else if (verdict == spidar::GraspJudge::Verdict::refuse) {
        emit_signal("grasp_refused", body, spidar::to_godot(judge_.reason()));
    }
}

void SpidarGHand::attach(RigidBody3D &body) {
    const spidar::ToolPose proxy = proxy_pose();
    // A body that does not yield keeps the proxy's pads around it, away from the device. Once held,
    // it no longer does, and is moved to the proxy.
    const Vec3 beside = proxy.position_m - device_pose().position_m;
    const double off_m = glm::dot(beside, proxy.rotation[0]);
    const Transform3D grip =
        stepped().pose_to_world(proxy.position_m - off_m * proxy.rotation[0], proxy.rotation);
    hold_.attach(*this, body, grip, off_m * spidar_->get_workspace_scale());
    held_shapes_.take(body, spidar_->get_workspace_scale());
    if (const int more = held_joints_.take(scene_joints_, body); more > 0) {
        godot::UtilityFunctions::push_warning(
            "SpidarGHand: ", body.get_name(), " is tied by ", spidar::kMaxToolJoints + more,
            " joints, of which ", spidar::kMaxToolJoints,
            " are felt: use fewer joints, for instance one Generic6DOFJoint3D.");
    }
    held_stop_rad_ = proxy.grasp_rad;
    held_squeeze_nm_rad_ = pinch_.facts.squeeze_nm_rad;
    watch_.reset();
    load_.reset();
    held_ = {};
    body.connect("tree_exiting", callable_mp(this, &SpidarGHand::release));
    emit_signal("body_grasped", &body);
}

// Releases the body when the jaws open beyond it, or when the world pulls at it for long enough.
void SpidarGHand::watch_hold() {
    if (!hold_.is_movable()) {
        release();
        return;
    }
    Vec3 press_n(0.0);
    const spidar::TouchReport &touch = spidar_->snapshot().touch;
    const bool forces_on = spidar_->get_state() == SpidarG::STATE_ACTIVE;
    for (int i = 0; i < touch.point_count && forces_on; ++i) {
        const spidar::TouchPointReport &point = touch.points[static_cast<std::size_t>(i)];
        if (point.tool_id >= spidar::kFirstHeldId) {
            press_n += point.force_n;
        }
    }
    const bool opened = spidar_->get_grasp_angle() < held_stop_rad_ - kReleaseAngle_rad;
    const bool broken =
        watch_.breaks(glm::length(press_n), break_force_, clock_.elapsed_s(),
                      hold_.stretch_m() / spidar_->get_workspace_scale(), spidar::physics_tick_s());
    if (opened || broken || hold_.body()->is_freeze_enabled()) {
        release();
    }
}

// Moves the held body with the proxy, which stops where the world stops the body.
void SpidarGHand::carry(double delta_s) {
    hold_.advance(delta_s);
    held_shapes_.update();
    load_.clear();
    emit_signal("carrying", delta_s);
    if (!hold_.holds()) {
        return; // a listener released the body
    }
    const spidar::ToolPose pose = proxy_pose();
    const Transform3D proxy = now_.pose_to_world(pose.position_m, pose.rotation);
    const double moved_m = glm::length(now_.origin - stepped().origin);
    if (!hold_.is_detained() && moved_m > spidar::kFastestBody_m_s * delta_s) {
        hold_.jump(proxy);
    }
    hold_.follow(agree_on(hold_.where(proxy)) * hold_.in_grip().affine_inverse());
}

Transform3D SpidarGHand::agree_on(const Transform3D &mine) {
    const std::uint64_t body = hold_.body_id();
    const spidar::Twist &twist = spidar_->snapshot().grip.twist;
    const Vec3 turning = now_.turn_to_world(twist.angular_rad_s);
    const Vec3 lever = spidar::to_core(mine.origin) - now_.point_to_world(device_pose().position_m);
    const Vec3 velocity = now_.velocity_to_world(twist.linear_m_s) + glm::cross(turning, lever);
    spidar::note_hold(
        body, {get_instance_id(), mine, spidar::to_godot(velocity), spidar::to_godot(turning)});
    return spidar::shared_place(mine, spidar::other_holds(body, get_instance_id()));
}
