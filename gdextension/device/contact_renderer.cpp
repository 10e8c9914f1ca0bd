#include "device/contact_renderer.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "device/grip_points.h"
#include "device/wrench_request.h"

namespace spidar {

namespace {

// After a pause of the game the contacts come back over this time, not with a blow.
constexpr double kRecovery_s = 0.050;
// Deeper than any grip can be in a frame of half a metre: keeps absurd offsets from overflowing.
constexpr double kMaxDepth_m = 0.5;
constexpr double kMaxGraspDepth_rad = 1.6;
// No game object meets a hand faster; a larger plane velocity is a mistake of the physics engine.
constexpr double kMaxPlaneSpeed_m_s = 10.0;
constexpr double kMaxFriction = 10.0;
constexpr double kFarAway_m = 10.0; // beyond any frame: such a plane never or always touches
// Normals within 10 degrees count as one surface, beyond 15 as two; in between partly, so nothing snaps.
constexpr double kSameSurfaceCosine = 0.98480775301220806;
constexpr double kOtherSurfaceCosine = 0.96592582628906831;

double capped(double value, double cap, bool &was_capped) noexcept {
    if (value > cap) {
        was_capped = true;
        return cap;
    }
    return value;
}

bool is_stop(const ContactPlane &plane) noexcept {
    return plane.target == ContactTarget::grasp_stop;
}

double blend(double from, double to, double s) noexcept {
    return from + s * (to - from);
}

} // namespace

void ContactRenderer::configure(const SafetySettings &safety) noexcept {
    *this = ContactRenderer();
    full_s_ = safety.contacts_full_s;
    gone_s_ = safety.contacts_gone_s;
}

bool ContactRenderer::accept(const HapticCommand &command) noexcept {
    bool was_capped = false;
    for (std::size_t i = 0; i < count_; ++i) {
        place(tracks_[i], 0.0); // where the old planes are now: the cross-fade starts there
    }
    const std::array<Track, kMaxContacts> old = tracks_;
    std::array<bool, kMaxContacts> used{};
    const std::size_t old_count = count_;
    count_ = static_cast<std::size_t>(std::clamp(command.contact_count, 0, kMaxContacts));
    for (std::size_t i = 0; i < count_; ++i) {
        ContactPlane plane = command.contacts[i];
        if (is_stop(plane)) {
            plane.normal = Vec3(plane.normal.x > 0.0 ? 1.0 : -1.0, 0.0, 0.0);
            plane.velocity_m_s = Vec3(plane.velocity_m_s.x, 0.0, 0.0);
        } else {
            plane.normal = glm::normalize(plane.normal);
        }
        const bool stop = is_stop(plane);
        plane.stiffness_n_m = capped(
            plane.stiffness_n_m, stop ? kMaxGraspStiffness_nm_rad : kMaxStiffness_n_m, was_capped);
        plane.damping_n_s_m = capped(
            plane.damping_n_s_m, stop ? kMaxGraspDamping_nm_s_rad : kMaxDamping_n_s_m, was_capped);
        plane.friction = capped(plane.friction, kMaxFriction, was_capped);
        plane.offset_m = std::clamp(plane.offset_m, -kFarAway_m, kFarAway_m);
        for (int k = 0; k < 3; ++k) {
            double &v = plane.velocity_m_s[k];
            v = std::copysign(capped(std::abs(v), kMaxPlaneSpeed_m_s, was_capped), v);
        }

        Track track;
        for (std::size_t j = 0; j < old_count; ++j) {
            if (!used[j] && old[j].plane.id == plane.id && old[j].plane.target == plane.target) {
                used[j] = true;
                track = old[j];
                track.from = old[j].now;
                // Turned by more than a right angle it is another surface: nothing lies in between.
                track.fading_in = glm::dot(old[j].now.normal, plane.normal) > 0.0;
                track.anchored = track.anchored && track.fading_in;
                break;
            }
        }
        track.plane = plane;
        tracks_[i] = track;
    }
    age_s_ = 0.0;
    if (count_ == 0) {
        strength_ = 1.0; // the game goes on and touches nothing: nothing to recover from
    }
    return was_capped;
}

bool ContactRenderer::age(double dt_s) noexcept {
    age_s_ += dt_s;
    if (count_ == 0) {
        return false; // an empty set never grows old
    }
    const double left = std::clamp(1.0 - (age_s_ - full_s_) / (gone_s_ - full_s_), 0.0, 1.0);
    strength_ = std::min(left, strength_ + dt_s / kRecovery_s);
    if (left > 0.0) {
        return false;
    }
    count_ = 0;
    return true;
}

void ContactRenderer::place(Track &track, double dt_s) const noexcept {
    const ContactPlane &plane = track.plane;
    const double moved_s = std::min(age_s_, kContactExtrapolation_s);
    const bool moving = age_s_ <= kContactExtrapolation_s;
    const double shift_m = glm::dot(plane.normal, plane.velocity_m_s) * moved_s;

    Surface to;
    to.normal = plane.normal;
    to.velocity_m_s = moving ? plane.velocity_m_s : Vec3(0.0);
    to.offset_m = plane.offset_m + shift_m;
    to.stiffness_n_m = plane.stiffness_n_m;
    to.damping_n_s_m = plane.damping_n_s_m;
    to.friction = plane.friction;

    const double s = track.fading_in ? std::min(1.0, age_s_ / kContactCrossFade_s) : 1.0;
    Surface now = to;
    if (s < 1.0) {
        // Both ends of the fade move on alike: a plane that moves as announced is not dragged back.
        const Surface &from = track.from;
        const Vec3 normal = from.normal + s * (to.normal - from.normal);
        const double length = glm::length(normal);
        now.normal = normal / length; // at least sqrt(1/2): accept() saw to it
        now.offset_m = blend(from.offset_m + shift_m, to.offset_m, s) / length;
        now.stiffness_n_m = blend(from.stiffness_n_m, to.stiffness_n_m, s);
        now.damping_n_s_m = blend(from.damping_n_s_m, to.damping_n_s_m, s);
        now.friction = blend(from.friction, to.friction, s);
    }
    track.now = now;
    if (track.anchored) {
        track.anchor_m += now.velocity_m_s * dt_s; // friction holds to the moving surface
    }
}

// Weight of contact `index` among those that push the same way: deeper ones carry more, all weights sum to
// 1 on one surface, and a contact that has just touched carries nothing, so forces are continuous.
double ContactRenderer::share_of(std::size_t index) const noexcept {
    const Track &track = tracks_[index];
    double sum_m = 0.0;
    for (std::size_t j = 0; j < count_; ++j) {
        const Track &other = tracks_[j];
        if (!other.touching || is_stop(other.plane) != is_stop(track.plane)) {
            continue;
        }
        const double cosine = glm::dot(track.now.normal, other.now.normal);
        const double alike = std::clamp(
            (cosine - kOtherSurfaceCosine) / (kSameSurfaceCosine - kOtherSurfaceCosine), 0.0, 1.0);
        sum_m += (j == index ? 1.0 : alike) * other.depth_m;
    }
    return sum_m > 0.0 ? track.depth_m / sum_m : 1.0;
}

void ContactRenderer::push_point(Track &track, const GripState &grip, double share,
                                 double damping_scale) const noexcept {
    const Surface &surface = track.now;
    const Vec3 point_m = grip_point(grip.pose, track.plane.target);
    const Vec3 velocity_m_s =
        damping_scale * (grip_point_velocity(grip, track.plane.target) - surface.velocity_m_s);
    const double leaving_m_s = glm::dot(surface.normal, velocity_m_s);
    const double stiffness_n_m = share * surface.stiffness_n_m;
    const double damping_n_s_m = share * surface.damping_n_s_m;
    const double push_n =
        std::max(0.0, stiffness_n_m * track.depth_m - damping_n_s_m * leaving_m_s);
    track.force_n = push_n * surface.normal;

    const double grip_limit_n = surface.friction * push_n;
    if (!(surface.friction > 0.0) || !(stiffness_n_m > 0.0)) {
        track.anchored = false;
        return;
    }
    if (!track.anchored) {
        track.anchored = true;
        track.anchor_m = point_m;
    }
    const auto along = [&surface](const Vec3 &v) {
        return v - glm::dot(surface.normal, v) * surface.normal;
    };
    Vec3 stretch_m = along(point_m - track.anchor_m);
    const double spring_n = stiffness_n_m * glm::length(stretch_m);
    if (spring_n > grip_limit_n) {
        stretch_m *= grip_limit_n / spring_n; // slips: the anchor is dragged along
        track.anchor_m = point_m - stretch_m;
    }
    Vec3 rub_n = -stiffness_n_m * stretch_m - damping_n_s_m * along(velocity_m_s);
    const double rub = glm::length(rub_n);
    if (rub > grip_limit_n) {
        rub_n *= grip_limit_n / rub;
    }
    track.force_n += rub_n;
}

void ContactRenderer::push_grasp(Track &track, const GripState &grip, double share,
                                 double damping_scale) const noexcept {
    const double side = track.now.normal.x;
    const double leaving_rad_s =
        damping_scale * side * (grip.twist.grasp_rate_rad_s - track.now.velocity_m_s.x);
    const double push_nm = std::max(0.0, share * (track.now.stiffness_n_m * track.depth_m -
                                                  track.now.damping_n_s_m * leaving_rad_s));
    track.grasp_torque_nm = side * push_nm;
}

Wrench ContactRenderer::render(const GripState &grip, double dt_s, double damping_scale) noexcept {
    for (std::size_t i = 0; i < count_; ++i) {
        Track &track = tracks_[i];
        place(track, dt_s);
        const bool stop = is_stop(track.plane);
        const double place_m =
            stop ? track.now.normal.x * grip.frame.grasp_angle_rad
                 : glm::dot(track.now.normal, grip_point(grip.pose, track.plane.target));
        const double depth_m = track.now.offset_m - place_m;
        track.touching = depth_m > 0.0; // false for NaN
        track.depth_m =
            track.touching ? std::min(depth_m, stop ? kMaxGraspDepth_rad : kMaxDepth_m) : 0.0;
        track.force_n = Vec3(0.0);
        track.grasp_torque_nm = 0.0;
    }
    Wrench sum;
    for (std::size_t i = 0; i < count_; ++i) {
        Track &track = tracks_[i];
        if (!track.touching) {
            track.anchored = false;
            continue;
        }
        const double share = share_of(i);
        if (is_stop(track.plane)) {
            push_grasp(track, grip, share, damping_scale);
        } else {
            push_point(track, grip, share, damping_scale);
        }
        track.force_n *= strength_;
        track.grasp_torque_nm *= strength_;
        sum = sum + wrench_of_force(grip, track.plane.target, track.force_n);
        sum.grasp_torque_nm += track.grasp_torque_nm;
    }
    return sum;
}

void ContactRenderer::integrate(double scale, double dt_s) noexcept {
    if (!(scale > 0.0)) {
        return;
    }
    for (std::size_t i = 0; i < count_; ++i) {
        tracks_[i].impulse_ns += (scale * dt_s) * tracks_[i].force_n;
        tracks_[i].grasp_impulse_nms += (scale * dt_s) * tracks_[i].grasp_torque_nm;
    }
}

int ContactRenderer::report(std::array<ContactReport, kMaxContacts> &reports) const noexcept {
    for (std::size_t i = 0; i < count_; ++i) {
        const Track &track = tracks_[i];
        reports[i] = {track.plane.id, track.impulse_ns, track.grasp_impulse_nms, track.touching};
    }
    return static_cast<int>(count_);
}

} // namespace spidar
