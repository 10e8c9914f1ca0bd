#include "device/contact/contact_surface.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "core/geometry/rotation_log.h"
#include "device/contract/request_fade.h"

namespace spidar {

namespace {

// Largest turn by which a surface is extrapolated.
constexpr double kMostTurn_rad = 0.35;
// Largest distance that the acceleration adds to an extrapolation.
constexpr double kMostAdded_m = 0.002;
// Shortest time between two updates from which rates are computed.
constexpr double kLeastApart_s = 1e-4;

bool is_stop(const ContactPlane &plane) noexcept {
    return plane.target == ContactTarget::grasp_stop || plane.target == ContactTarget::turn_stop;
}

// Returns the common part of two consecutive rates. A surface that turns or accelerates steadily is
// extrapolated; one that jumps (an edge, a bounce) or trembles is not.
double in_common(double last, double newest) noexcept {
    if (!(last * newest > 0.0)) {
        return 0.0;
    }
    return std::abs(last) < std::abs(newest) ? last : newest;
}
Vec3 in_common(const Vec3 &last, const Vec3 &newest) noexcept {
    const double last_2 = glm::dot(last, last);
    const double newest_2 = glm::dot(newest, newest);
    const double both = glm::dot(last, newest);
    if (!(both > 0.0)) {
        return Vec3(0.0);
    }
    const double cosine = both / std::sqrt(last_2 * newest_2);
    return cosine * (last_2 < newest_2 ? last : newest);
}

} // namespace

void SurfaceTrack::begin(const ContactPlane &plane) noexcept {
    *this = SurfaceTrack();
    plane_ = plane;
}

void SurfaceTrack::renew(const ContactPlane &plane, const ContactSurface &from, double apart_s,
                         const Vec3 &pivot_m) noexcept {
    if (!is_stop(plane) && apart_s > kLeastApart_s && apart_s <= kMostExtrapolation_s) {
        const Vec3 seen_turn_rad_s = rotation_between(plane_.normal, plane.normal) / apart_s;
        const double seen_m_s2 =
            glm::dot(plane.normal, plane.velocity_m_s - plane_.velocity_m_s) / apart_s;
        turn_rad_s_ = in_common(seen_turn_rad_s_, seen_turn_rad_s);
        acceleration_m_s2_ = in_common(seen_acceleration_m_s2_, seen_m_s2);
        seen_turn_rad_s_ = seen_turn_rad_s;
        seen_acceleration_m_s2_ = seen_m_s2;
    } else {
        seen_turn_rad_s_ = turn_rad_s_ = Vec3(0.0);
        seen_acceleration_m_s2_ = acceleration_m_s2_ = 0.0;
    }
    plane_ = plane;
    from_ = from;
    fading_in_ = true;
    pivot_m_ = pivot_m;
}

ContactSurface SurfaceTrack::now(const GameClock &clock) const noexcept {
    const double moved_s = clock.carried_s();
    const double since_s = clock.carried_since_s();
    const double speed_m_s = glm::dot(plane_.normal, plane_.velocity_m_s);
    const auto way_m = [&](double t_s) {
        const double added_m = 0.5 * acceleration_m_s2_ * t_s * t_s;
        return speed_m_s * t_s + std::clamp(added_m, -kMostAdded_m, kMostAdded_m);
    };
    const bool turning = turn_rad_s_ != Vec3(0.0);
    const auto turned = [&](const Vec3 &normal, double t_s) {
        Vec3 turn_rad = t_s * turn_rad_s_;
        const double angle = glm::length(turn_rad);
        if (angle > kMostTurn_rad) {
            turn_rad *= kMostTurn_rad / angle;
        }
        return rotation_exp(turn_rad) * normal;
    };

    ContactSurface to;
    to.normal = plane_.normal;
    to.velocity_m_s = clock.carries()
                          ? plane_.velocity_m_s + moved_s * acceleration_m_s2_ * plane_.normal
                          : Vec3(0.0);
    to.offset_m = plane_.offset_m + way_m(moved_s);
    to.stiffness_n_m = plane_.stiffness_n_m;
    to.damping_n_s_m = plane_.damping_n_s_m;
    to.friction = plane_.friction;
    if (turning) {
        to.normal = turned(plane_.normal, moved_s);
        to.offset_m += glm::dot(to.normal - plane_.normal, pivot_m_);
    }
    const double s = fading_in_ ? cross_fade(clock.age_s()) : 1.0;
    if (!(s < 1.0)) {
        return to;
    }
    // Both ends of the cross-fade are extrapolated alike, so that a plane that moves as announced
    // is not dragged back. The old end was already extrapolated to the time of the update.
    Vec3 from_normal = from_.normal;
    double from_m = from_.offset_m + way_m(moved_s) - way_m(moved_s - since_s);
    if (turning) {
        from_normal = turned(from_.normal, since_s);
        from_m += glm::dot(from_normal - from_.normal, pivot_m_);
    }
    ContactSurface now = to;
    const Vec3 normal = from_normal + s * (to.normal - from_normal);
    const double length = glm::length(normal); // at least sqrt(1/2)
    now.normal = normal / length;
    now.offset_m = blend(from_m, to.offset_m, s) / length;
    now.stiffness_n_m = blend(from_.stiffness_n_m, to.stiffness_n_m, s);
    now.damping_n_s_m = blend(from_.damping_n_s_m, to.damping_n_s_m, s);
    now.friction = blend(from_.friction, to.friction, s);
    return now;
}

} // namespace spidar
