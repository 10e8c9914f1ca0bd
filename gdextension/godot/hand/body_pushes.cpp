#include "godot/hand/body_pushes.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <glm/geometric.hpp>

#include <godot_cpp/classes/physics_direct_body_state3d.hpp>
#include <godot_cpp/classes/physics_server3d.hpp>

#include "core/base/finite.h"
#include "godot/base/type_conversions.h"
#include "godot/hand/grasp/pinch.h"

namespace spidar {

namespace {

using godot::PhysicsServer3D;

// Limits of a push. It makes a body at most this much faster than the tool, moves it at most this
// far ahead of the tool before the next push, and not much further than the device is pressed in.
// Without limits a light body would be thrown: a real force ends when the body moves, but here it
// is held for a whole frame.
constexpr double kMostLead_m_s = 0.5;
constexpr double kMostLead_m = 0.0085;
constexpr double kMostPressed = 1.5;
// Share of the speed between tool and body that is removed per frame. A body answers a push one
// frame late, which adds energy in each swing between tool and spring; half the ratio of stiffness
// to mass / frame^2 would just suffice.
constexpr double kDamped = 0.6;
constexpr double kMostShare = 2.0;

// Scene axes and meters. The impulse acts at `origin`, the part's origin; the angular impulse is
// additional.
struct Push {
    Vec3 origin{0.0};
    Vec3 impulse_ns{0.0};
    Vec3 angular_nms{0.0};
};

// Returns the tool's velocity where it touches this part, weighted by force. Scene m/s of device
// time.
Vec3 tool_velocity(const TouchReport &report, std::int32_t part, const BodyPushes::Terms &terms) {
    Vec3 sum(0.0);
    double weight = 0.0;
    for (int i = 0; i < report.point_count; ++i) {
        const TouchPointReport &point = report.points[static_cast<std::size_t>(i)];
        if (point.scene_id != part) {
            continue;
        }
        ToolPart touches;
        touches.mount = point.tool_id == kPadIds[0]   ? ToolMount::jaw_minus
                        : point.tool_id == kPadIds[1] ? ToolMount::jaw_plus
                                                      : ToolMount::grip;
        const double force_n = glm::length(point.force_n);
        sum +=
            force_n * point_velocity(touches, terms.jaws, terms.pose, terms.twist, point.point_m);
        weight += force_n;
    }
    const Vec3 velocity = weight > 0.0 ? sum / weight : terms.twist.linear_m_s;
    return terms.frame.velocity_to_world(velocity) + terms.node_m_s;
}

// Returns the share of the push that the body gets. tool_m_s: velocity of the tool where it pushes,
// scene meters per second of game time.
double share_of(const Push &push, const godot::PhysicsDirectBodyState3D &state,
                const BodyPushes::Terms &terms, const Vec3 &tool_m_s, double stiffness_n_m) {
    const double tick_s = terms.time_scale * terms.since_s; // of the game's time
    const double size_ns = glm::length(push.impulse_ns);
    const double pressed_m = kMostPressed * terms.frame.scale * size_ns / (tick_s * stiffness_n_m);
    const double lead_m_s = std::min(kMostLead_m_s, std::min(kMostLead_m, pressed_m) / tick_s);
    const double inverse_mass = state.get_inverse_mass();
    const Mat3 inverse_inertia = to_core(state.get_inverse_inertia_tensor());
    const Vec3 centre = to_core(state.get_transform().origin) + to_core(state.get_center_of_mass());
    const Vec3 moment = push.angular_nms + glm::cross(push.origin - centre, push.impulse_ns);
    const Vec3 turns = inverse_inertia * moment;
    double share = 1.0;
    if (size_ns > 0.0) {
        const Vec3 along = push.impulse_ns / size_ns;
        // The point on the line of the impulse that is nearest to the center of mass.
        const Vec3 lever = glm::cross(push.impulse_ns, moment) / (size_ns * size_ns);
        const Vec3 velocity = to_core(state.get_linear_velocity()) +
                              glm::cross(to_core(state.get_angular_velocity()), lever);
        const double gains =
            glm::dot(inverse_mass * push.impulse_ns + glm::cross(turns, lever), along);
        const double ahead = glm::dot(velocity - tool_m_s, along);
        const double fastest = std::max(glm::dot(tool_m_s, along), 0.0) + lead_m_s;
        const double left = std::max(fastest - glm::dot(velocity, along), 0.0);
        if (gains > 0.0) {
            share = std::clamp(1.0 - kDamped * ahead / gains, 0.0, kMostShare);
            share = std::min(share, left / gains);
        }
        share = std::min(share, terms.most_n * tick_s / size_ns);
    }
    // Same for a turn, at the body's radius of gyration.
    const double trace = inverse_inertia[0][0] + inverse_inertia[1][1] + inverse_inertia[2][2];
    const double spin = glm::length(turns);
    if (trace > 0.0 && spin > 0.0) {
        const double radius = std::sqrt(3.0 * inverse_mass / trace);
        share = std::min(share, lead_m_s / (radius * spin));
    }
    return share;
}

} // namespace

void BodyPushes::push(const TouchReport &report, const TouchedBodies &bodies, const Terms &terms) {
    std::unordered_map<std::int32_t, Sum> now;
    auto *const server = PhysicsServer3D::get_singleton();
    for (int i = 0; i < report.part_count; ++i) {
        const TouchPartReport &part = report.parts[static_cast<std::size_t>(i)];
        const Sum sum{part.impulse_ns, part.angular_impulse_nms};
        now[part.id] = sum;
        const auto known = sums_.find(part.id);
        const Sum before = known != sums_.end() ? known->second : Sum();
        const TouchedBody *const body = bodies.find(part.id);
        if (body == nullptr || !body->is_pushed || body->is_gone() || !(terms.time_scale > 0.0) ||
            server->body_get_mode(body->rid) < PhysicsServer3D::BODY_MODE_RIGID) {
            continue;
        }
        const auto *const state = server->body_get_direct_state(body->rid);
        Push push;
        push.origin = terms.frame.point_to_world(body->at.origin_m);
        push.impulse_ns =
            terms.time_scale * terms.frame.turn_to_world(sum.impulse_ns - before.impulse_ns);
        push.angular_nms =
            terms.time_scale * terms.frame.scale *
            terms.frame.turn_to_world(sum.angular_impulse_nms - before.angular_impulse_nms);
        const bool is_none = push.impulse_ns == Vec3(0.0) && push.angular_nms == Vec3(0.0);
        if (state == nullptr || is_none || !all_finite(push.impulse_ns) ||
            !all_finite(push.angular_nms)) {
            continue;
        }
        const double share =
            share_of(push, *state, terms, tool_velocity(report, part.id, terms) / terms.time_scale,
                     std::max(report.stiffness[0], 1.0));
        if (!(share > 0.0)) {
            continue;
        }
        const Vec3 from_body = push.origin - to_core(state->get_transform().origin);
        server->body_apply_impulse(body->rid, to_godot(share * push.impulse_ns),
                                   to_godot(from_body));
        server->body_apply_torque_impulse(body->rid, to_godot(share * push.angular_nms));
    }
    sums_ = std::move(now);
}

} // namespace spidar
