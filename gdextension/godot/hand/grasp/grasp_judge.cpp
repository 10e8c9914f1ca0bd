#include "godot/hand/grasp/grasp_judge.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include <godot_cpp/classes/physics_direct_body_state3d.hpp>
#include <godot_cpp/classes/physics_server3d.hpp>
#include <godot_cpp/classes/rigid_body3d.hpp>

#include "godot/hand/scene/near_body.h"

namespace spidar {

namespace {

using godot::PhysicsServer3D;
using godot::RigidBody3D;

// Smallest angle between the two sides' normals: less opposite faces would slip out of the jaws.
constexpr double kMinOpposition_deg = 150.0;
// Rate below which the hand has finished closing.
constexpr double kSettledRate_rad_s = 0.2;
// Time after which a closed hand that squeezes too little is told so.
constexpr double kRefuseAfter_s = 0.25;

template <typename... Values>
std::string text(const char *format, Values... values) {
    char buffer[200];
    (void)std::snprintf(buffer, sizeof buffer, format, values...);
    return buffer;
}

double gravity_on(const RigidBody3D &body) {
    const auto *state = PhysicsServer3D::get_singleton()->body_get_direct_state(body.get_rid());
    return state != nullptr ? static_cast<double>(state->get_total_gravity().length()) : 0.0;
}

// Returns the reason against a hold, or an empty string.
std::string problem_of(const Pinch &pinch, const RigidBody3D &body, const GraspJudge::Terms &terms,
                       double finger_force_n) {
    const double friction = pinch.facts.resting_friction(terms.pad_friction);
    const double carried_n = 2.0 * friction * finger_force_n;
    const double weight_n = terms.weight_scale * body.get_mass() * gravity_on(body);
    if (body.is_freeze_enabled()) {
        return "the body is frozen: set freeze to false so that it can be lifted";
    }
    if (PhysicsServer3D::get_singleton()->body_get_mode(body.get_rid()) <
        PhysicsServer3D::BODY_MODE_RIGID) {
        return "the body is disabled: set its process_mode so that it runs and can be lifted";
    }
    if (pinch.opposition_deg < kMinOpposition_deg) {
        return text(
            "its faces are %.0f degrees apart, but at least %.0f degrees are needed: turn the grip",
            pinch.opposition_deg, kMinOpposition_deg);
    }
    if (finger_force_n < terms.min_force_n) {
        return text(
            "the squeeze is %.2f N, but at least %.2f N is needed (hold_torque): close further",
            finger_force_n, terms.min_force_n);
    }
    if (carried_n < weight_n) {
        return text(
            "a squeeze of %.2f N carries %.2f N at friction %.2f, but the body weighs %.2f N: "
            "close further, raise the friction or lower weight_scale",
            finger_force_n, carried_n, friction, weight_n);
    }
    return {};
}

} // namespace

void GraspJudge::reset() noexcept {
    settled_s_ = 0.0;
    told_ = false;
}

GraspJudge::Verdict GraspJudge::judge(const Pinch &pinch, RigidBody3D *body, const Terms &terms,
                                      double finger_force_n, double grasp_rate_rad_s,
                                      double delta_s) {
    if (body == nullptr || body->is_queued_for_deletion()) {
        return Verdict::
            wait; // a wall or a fixed peg: it has a width, and nobody expects to lift it
    }
    std::string problem = problem_of(pinch, *body, terms, finger_force_n);
    if (problem.empty()) {
        return Verdict::hold;
    }
    settled_s_ = std::abs(grasp_rate_rad_s) < kSettledRate_rad_s ? settled_s_ + delta_s : 0.0;
    if (told_ || settled_s_ < kRefuseAfter_s) {
        return Verdict::wait;
    }
    told_ = true;
    reason_ = std::move(problem);
    return Verdict::refuse;
}

} // namespace spidar
