#include "device/contact/contact_renderer.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "core/geometry/rotation_log.h"
#include "device/contract/dof_lanes.h"
#include "device/contract/grip_points.h"

namespace spidar {

namespace {

// Largest depth, beyond any grip in a frame of half a meter: absurd offsets must not overflow.
constexpr double kMaxDepth_m = 0.5;
constexpr double kMaxGraspDepth_rad = 1.6;
// Smallest depth that counts as a contact: below it the share of a push is not a usable divisor.
constexpr double kLeastDepth_m = 1e-9;
// Smallest stiffness, so that 1 / stiffness is finite for a contact that only damps.
constexpr double kSoftestContact_n_m = 1e-3;
// 1 / sqrt of the god-object's stiffnesses.
constexpr double kTurnSoftness = 1.0;
constexpr double kGraspSoftness = 2.0;
static_assert(kTurnSoftness * kTurnSoftness * kGodObjectTurnStiffness_nm_rad == 1.0);
static_assert(kGraspSoftness * kGraspSoftness * kGodObjectGraspStiffness_nm_rad == 1.0);
// Largest rotation vector that equals its own derivative to double precision.
constexpr double kSmallTurn_rad = 1e-6;

bool is_grasp_stop(const ContactPlane &plane) noexcept {
    return plane.target == ContactTarget::grasp_stop;
}

bool is_turn_stop(const ContactPlane &plane) noexcept {
    return plane.target == ContactTarget::turn_stop;
}

bool is_stop(const ContactPlane &plane) noexcept {
    return is_grasp_stop(plane) || is_turn_stop(plane);
}

// Returns a DOF of the kind on which the contact acts: caps differ between the kinds.
std::size_t kind_of_dof(const ContactPlane &plane) noexcept {
    constexpr std::size_t kTurn = 3;
    if (is_stop(plane)) {
        return is_grasp_stop(plane) ? kGraspLane : kTurn;
    }
    return 0;
}

// Returns how the component of the rotation vector `turn` along `axis` changes with an angular
// velocity (a covector).
Vec3 turn_gradient(const Vec3 &turn, const Vec3 &axis) noexcept {
    const double angle = glm::length(turn);
    if (angle < kSmallTurn_rad) {
        return axis;
    }
    // Transpose of the inverse left Jacobian of the rotation group.
    const double half = 0.5 * angle;
    const double rest = (1.0 - half / std::tan(half)) / (angle * angle);
    return axis + 0.5 * glm::cross(turn, axis) + rest * glm::cross(turn, glm::cross(turn, axis));
}

} // namespace

void ContactRenderer::configure(const ServoSettings &settings) noexcept {
    *this = ContactRenderer();
    strength_.configure(settings.safety);
    caps_ = gain_caps(settings.render, settings.rate_hz);
}

void ContactRenderer::retune(const ServoSettings &settings) noexcept {
    caps_ = gain_caps(settings.render, settings.rate_hz);
}

GainClamp ContactRenderer::accept(const HapticCommand &command, double now_s) noexcept {
    using Gain = GainClamp::Gain;
    GainClamp clamp;
    for (std::size_t i = 0; i < count_; ++i) {
        place(tracks_[i], 0.0); // the cross-fade starts at the present planes
    }
    const std::array<Track, kMaxContacts> old = tracks_;
    std::array<bool, kMaxContacts> used{};
    const std::size_t old_count = count_;
    count_ = static_cast<std::size_t>(std::clamp(command.contact_count, 0, kMaxContacts));
    active_mask_ = 0; // contacts may have changed places
    // Time between two sets on the game's clock, where the game reports it.
    const bool stamped = command.contacts_state_time_s >= 0.0 && state_time_s_ >= 0.0;
    const double apart_s = stamped ? command.contacts_state_time_s - state_time_s_ : clock_.age_s();
    state_time_s_ = command.contacts_state_time_s;
    for (std::size_t i = 0; i < count_; ++i) {
        ContactPlane plane = command.contacts[i];
        const auto index = static_cast<std::int32_t>(i);
        if (is_grasp_stop(plane)) {
            plane.normal = Vec3(plane.normal.x > 0.0 ? 1.0 : -1.0, 0.0, 0.0);
            plane.velocity_m_s = Vec3(plane.velocity_m_s.x, 0.0, 0.0);
        } else {
            plane.normal = glm::normalize(plane.normal);
        }
        const DofCap stiffness = stiffness_cap(caps_, kind_of_dof(plane));
        const DofCap damping = damping_cap(caps_, kind_of_dof(plane));
        plane.stiffness_n_m = capped(plane.stiffness_n_m, stiffness.most, stiffness.gain, index,
                                     caps_.from_latency, clamp);
        plane.damping_n_s_m =
            capped(plane.damping_n_s_m, damping.most, damping.gain, index, false, clamp);
        plane.friction = capped(plane.friction, kMaxFriction, Gain::friction, index, false, clamp);
        plane.offset_m = std::clamp(plane.offset_m, -kFarAway_m, kFarAway_m);
        for (int k = 0; k < 3; ++k) {
            plane.velocity_m_s[k] = capped(plane.velocity_m_s[k], kMaxSurfaceSpeed_m_s, Gain::speed,
                                           index, false, clamp);
        }

        Track track;
        bool same = false;
        for (std::size_t j = 0; j < old_count; ++j) {
            if (!used[j] && old[j].plane.id == plane.id && old[j].plane.target == plane.target) {
                used[j] = true;
                track = old[j];
                // A plane that turned by more than a right angle is another surface: nothing lies
                // in between.
                same = glm::dot(old[j].now.normal, plane.normal) > 0.0;
                track.anchored = track.anchored && same;
                break;
            }
        }
        if (same) {
            track.surface.renew(plane, track.now, apart_s, foot(plane));
        } else {
            track.surface.begin(plane);
        }
        track.plane = plane;
        tracks_[i] = track;
    }
    clock_.receive(command.contacts_state_time_s, now_s);
    if (count_ == 0) {
        strength_.set(1.0); // the game continues without contacts: no onset is needed
    }
    return clamp;
}

bool ContactRenderer::age(double dt_s) noexcept {
    clock_.advance(dt_s);
    if (count_ == 0) {
        return false; // an empty set does not expire
    }
    if (strength_.advance(clock_.age_s(), dt_s)) {
        return false;
    }
    count_ = 0;
    return true;
}

void ContactRenderer::place(Track &track, double dt_s) const noexcept {
    track.now = track.surface.now(clock_);
    if (track.anchored) {
        track.anchor_m += track.now.velocity_m_s * dt_s; // friction sticks to the moving surface
    }
}

// Returns where the last rendered contact point lies on this plane.
Vec3 ContactRenderer::foot(const ContactPlane &plane) const noexcept {
    const Vec3 point_m = grip_point(pose_, plane.target);
    return point_m + (plane.offset_m - glm::dot(plane.normal, point_m)) * plane.normal;
}

// Returns the depth and the direction in which the contact moves with the grip. Requires a placed
// track.
ConstraintRow ContactRenderer::measure(Track &track, const GripMotion &motion) const noexcept {
    const ContactSurface &surface = track.now;
    const GripState &grip = motion.grip;
    double place = 0.0;
    Vec3 along(0.0); // motion per unit of linear, angular and grasp motion
    Vec3 turn(0.0);
    double grasp = 0.0;
    double most_m = kMaxDepth_m;
    if (is_grasp_stop(track.plane)) {
        grasp = surface.normal.x;
        place = grasp * grip.frame.grasp_angle_rad;
        most_m = kMaxGraspDepth_rad;
    } else if (is_turn_stop(track.plane)) {
        const Vec3 turned = rotation_log(grip.frame.rotation);
        place = glm::dot(surface.normal, turned);
        turn = turn_gradient(turned, surface.normal);
        most_m = kMaxGraspDepth_rad;
    } else {
        place = glm::dot(surface.normal, grip_point(grip.pose, track.plane.target));
        const Wrench unit = wrench_of_force(grip, track.plane.target, surface.normal);
        along = surface.normal;
        turn = unit.moment_nm;
        grasp = unit.grasp_torque_nm;
    }
    const Displacement &ahead = motion.ahead;
    const Twist &v = motion.velocity;
    const double ahead_m = glm::dot(along, ahead.linear_m) + glm::dot(turn, ahead.angular_rad) +
                           grasp * ahead.grasp_rad;
    const double surface_m_s = glm::dot(surface.normal, surface.velocity_m_s);
    const double leaving_m_s = glm::dot(along, v.linear_m_s) + glm::dot(turn, v.angular_rad_s) +
                               grasp * v.grasp_rate_rad_s - surface_m_s;
    // Surface and grip are taken at the same time, so that an object that moves with the hand feels
    // like one at rest.
    const double depth_m = surface.offset_m + motion.lead_s * surface_m_s - place - ahead_m;
    track.touching = depth_m > 0.0; // false for NaN
    track.depth_m = std::clamp(depth_m, -most_m, most_m);

    const double stiffness_n_m = std::max(surface.stiffness_n_m, kSoftestContact_n_m);
    ConstraintRow row;
    row.depth = track.depth_m;
    if (track.touching) {
        // The damper acts as a deeper spring, so that the whole push stays one-sided and is shared.
        row.depth = std::max(0.0, surface.stiffness_n_m * track.depth_m -
                                      surface.damping_n_s_m * leaving_m_s) /
                    stiffness_n_m;
    }
    const double softness = 1.0 / std::sqrt(stiffness_n_m);
    const double turn_softness = is_turn_stop(track.plane) ? softness : kTurnSoftness;
    const double grasp_softness = is_grasp_stop(track.plane) ? softness : kGraspSoftness;
    row.row = {softness * along.x,     softness * along.y,
               softness * along.z,     turn_softness * turn.x,
               turn_softness * turn.y, turn_softness * turn.z,
               grasp_softness * grasp, 0.0};
    return row;
}

// Coulomb friction of a contact that pushes: a spring to the point of first touch, dragged along
// beyond the cone.
void ContactRenderer::rub(Track &track, const GripMotion &motion) const noexcept {
    const ContactSurface &surface = track.now;
    if (!(surface.friction > 0.0) || !(surface.stiffness_n_m > 0.0) || is_stop(track.plane)) {
        track.anchored = false;
        return;
    }
    const GripState &grip = motion.grip;
    const Vec3 lever_m = grip_point(grip.pose, track.plane.target) - grip.pose.position_m;
    const Vec3 point_m = grip.pose.position_m + lever_m + motion.ahead.linear_m +
                         glm::cross(motion.ahead.angular_rad, lever_m);
    GripState moving = grip;
    moving.twist = motion.velocity;
    const Vec3 velocity_m_s =
        grip_point_velocity(moving, track.plane.target) - surface.velocity_m_s;
    if (!track.anchored) {
        track.anchored = true;
        track.anchor_m = point_m;
    }
    // Of several contacts with one surface each rubs in proportion to its push.
    const double share = std::min(
        1.0, track.push / (surface.stiffness_n_m * std::max(track.depth_m, kLeastDepth_m)));
    const double stiffness_n_m = share * surface.stiffness_n_m;
    const double limit_n = surface.friction * track.push;
    const auto along = [&surface](const Vec3 &v) {
        return v - glm::dot(surface.normal, v) * surface.normal;
    };
    Vec3 stretch_m = along(point_m - track.anchor_m);
    const double spring_n = stiffness_n_m * glm::length(stretch_m);
    if (spring_n > limit_n) {
        stretch_m *= limit_n / spring_n; // slipping: the anchor is dragged along
        track.anchor_m = point_m - stretch_m;
    }
    Vec3 rub_n = -stiffness_n_m * stretch_m - (share * surface.damping_n_s_m) * along(velocity_m_s);
    const double size_n = glm::length(rub_n);
    if (size_n > limit_n) {
        rub_n *= limit_n / size_n;
    }
    track.force_n += rub_n;
}

Wrench ContactRenderer::render(const GripMotion &motion, double dt_s) noexcept {
    pose_ = motion.grip.pose;
    std::array<ConstraintRow, kMaxConstraints> rows;
    bool any = false;
    for (std::size_t i = 0; i < count_; ++i) {
        place(tracks_[i], dt_s);
        rows[i] = measure(tracks_[i], motion);
        any = any || tracks_[i].touching;
    }
    GodObjectSolution solution;
    if (any) {
        solution = solve_god_object(rows, static_cast<int>(count_), active_mask_);
    }
    active_mask_ = solution.active_mask;
    std::array<double, kMaxConstraints> alone{};
    double deepest = 0.0;
    for (std::size_t i = 0; i < count_; ++i) {
        if (solution.push[i] > 0.0) {
            alone[i] = own_push(rows[i]);
            deepest = std::max(deepest, alone[i]);
        }
    }
    Wrench sum;
    for (std::size_t i = 0; i < count_; ++i) {
        Track &track = tracks_[i];
        // Contradicting constraints, such as both sides of a slot that is too narrow, would push
        // without limit.
        track.push = std::min(solution.push[i], kMostPush * (alone[i] + deepest));
        track.force_n = Vec3(0.0);
        track.moment_nm = Vec3(0.0);
        track.grasp_torque_nm = 0.0;
        if (!(track.push > 0.0)) {
            track.anchored = false;
            continue;
        }
        track.push *= strength_.value();
        if (is_grasp_stop(track.plane)) {
            track.grasp_torque_nm = track.push * track.now.normal.x;
            sum.grasp_torque_nm += track.grasp_torque_nm;
        } else if (is_turn_stop(track.plane)) {
            track.moment_nm = track.push * turn_gradient(rotation_log(motion.grip.frame.rotation),
                                                         track.now.normal);
            sum.moment_nm += track.moment_nm;
        } else {
            track.force_n = track.push * track.now.normal;
            rub(track, motion);
            sum = sum + wrench_of_force(motion.grip, track.plane.target, track.force_n);
        }
    }
    return sum;
}

void ContactRenderer::integrate(double scale, double dt_s) noexcept {
    if (!(scale > 0.0)) {
        return;
    }
    for (std::size_t i = 0; i < count_; ++i) {
        // A turn stop's impulse is in N m s; it uses the same three numbers.
        tracks_[i].impulse_ns += (scale * dt_s) * (tracks_[i].force_n + tracks_[i].moment_nm);
        tracks_[i].grasp_impulse_nms += (scale * dt_s) * tracks_[i].grasp_torque_nm;
    }
}

int ContactRenderer::report(std::array<ContactReport, kMaxContacts> &reports) const noexcept {
    for (std::size_t i = 0; i < count_; ++i) {
        const Track &track = tracks_[i];
        ContactReport &report = reports[i];
        report.id = track.plane.id;
        report.impulse_ns = track.impulse_ns;
        report.grasp_impulse_nms = track.grasp_impulse_nms;
        report.touching = track.touching;
    }
    return static_cast<int>(count_);
}

} // namespace spidar
