#include "device/rendering/coupling_request.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "core/geometry/rotation_log.h"
#include "device/contract/dof_lanes.h"

namespace spidar {

namespace {

constexpr double kMaxProxySpeed_m_s = 10.0;
constexpr double kMaxProxyTurnRate_rad_s = 50.0;

Vec3 no_longer_than(const Vec3 &v, double limit) noexcept {
    const double length = glm::length(v);
    return length > limit ? v * (limit / length) : v;
}

bool has(std::uint8_t mask, int dof) noexcept {
    return ((mask >> dof) & 1U) != 0;
}

} // namespace

void CouplingRequest::configure(const ServoSettings &settings) noexcept {
    *this = CouplingRequest();
    strength_.configure(settings.safety);
    caps_ = gain_caps(settings.render, settings.rate_hz);
}

void CouplingRequest::retune(const ServoSettings &settings) noexcept {
    caps_ = gain_caps(settings.render, settings.rate_hz);
}

CouplingRequest::Proxy CouplingRequest::proxy_now() const noexcept {
    const double moved_s = clock_.carried_s();
    const double left = 1.0 - cross_fade(clock_.age_s());
    const Twist &twist = coupling_.twist;
    Proxy proxy;
    proxy.position_m = coupling_.position_m + moved_s * twist.linear_m_s + left * jump_.linear_m;
    proxy.rotation =
        rotation_exp(moved_s * twist.angular_rad_s + left * jump_.angular_rad) * coupling_.rotation;
    proxy.grasp_angle_rad =
        coupling_.grasp_angle_rad + moved_s * twist.grasp_rate_rad_s + left * jump_.grasp_rad;
    return proxy;
}

GainClamp CouplingRequest::accept(const Coupling &coupling, double now_s) noexcept {
    using Gain = GainClamp::Gain;
    GainClamp clamp;
    clamp.request = GainClamp::Request::coupling;
    Coupling next = coupling;
    for (std::int32_t dof = 0; dof < kDofCount; ++dof) {
        const auto i = static_cast<std::size_t>(dof);
        if (!has(next.dof_mask, dof)) {
            next.stiffness[i] = 0.0;
            next.damping[i] = 0.0;
        }
        const DofCap stiffness = stiffness_cap(caps_, i);
        const DofCap damping = damping_cap(caps_, i);
        next.stiffness[i] = capped(next.stiffness[i], stiffness.most, stiffness.gain, dof,
                                   caps_.from_latency, clamp);
        next.damping[i] = capped(next.damping[i], damping.most, damping.gain, dof, false, clamp);
    }
    for (int k = 0; k < 3; ++k) {
        next.position_m[k] = std::clamp(next.position_m[k], -kFarAway_m, kFarAway_m);
        next.twist.linear_m_s[k] =
            capped(next.twist.linear_m_s[k], kMaxProxySpeed_m_s, Gain::speed, k, false, clamp);
        next.twist.angular_rad_s[k] = capped(next.twist.angular_rad_s[k], kMaxProxyTurnRate_rad_s,
                                             Gain::speed, 3 + k, false, clamp);
    }
    next.grasp_angle_rad = std::clamp(next.grasp_angle_rad, -kFarAway_m, kFarAway_m);
    next.twist.grasp_rate_rad_s =
        capped(next.twist.grasp_rate_rad_s, kMaxProxyTurnRate_rad_s, Gain::speed, 6, false, clamp);
    // Orthonormalized: the game computes in single precision.
    next.rotation[0] = glm::normalize(next.rotation[0]);
    next.rotation[2] = glm::normalize(glm::cross(next.rotation[0], next.rotation[1]));
    next.rotation[1] = glm::cross(next.rotation[2], next.rotation[0]);

    const bool carries_on = live_ && coupling_.dof_mask != 0;
    if (carries_on) {
        const Proxy old = proxy_now();
        const double s = cross_fade(clock_.age_s());
        for (std::size_t i = 0; i < from_stiffness_.size(); ++i) {
            from_stiffness_[i] = blend(from_stiffness_[i], coupling_.stiffness[i], s);
            from_damping_[i] = blend(from_damping_[i], coupling_.damping[i], s);
        }
        // From the old proxy to the present place of the new one.
        coupling_ = next;
        clock_.receive(next.state_time_s, now_s);
        jump_ = Displacement();
        const Proxy young = proxy_now();
        jump_ = {old.position_m - young.position_m,
                 rotation_log(old.rotation * glm::transpose(young.rotation)),
                 old.grasp_angle_rad - young.grasp_angle_rad};
    } else {
        from_stiffness_ = next.stiffness;
        from_damping_ = next.damping;
        jump_ = Displacement();
        strength_.set(0.0);
        clock_ = GameClock();
        clock_.receive(next.state_time_s, now_s);
    }
    coupling_ = next;
    live_ = next.dof_mask != 0 || carries_on; // an empty coupling still fades out the last one
    return clamp;
}

bool CouplingRequest::age(double dt_s) noexcept {
    if (!live_) {
        return false;
    }
    clock_.advance(dt_s);
    if (coupling_.dof_mask == 0) {
        live_ = clock_.age_s() < kCrossFade_s;
        return false; // withdrawn by the game, not expired
    }
    live_ = strength_.advance(clock_.age_s(), dt_s);
    return !live_;
}

Wrench CouplingRequest::render(const GripMotion &motion) const noexcept {
    if (!live_) {
        return {};
    }
    const Proxy proxy = proxy_now();
    const GripState &grip = motion.grip;
    const Twist pull = clock_.carries() ? coupling_.twist : Twist();
    // Proxy and grip are taken at the same time.
    const Vec3 apart_m = proxy.position_m + motion.lead_s * pull.linear_m_s - grip.pose.position_m -
                         motion.ahead.linear_m;
    const Vec3 apart_rad = rotation_log(proxy.rotation * glm::transpose(grip.frame.rotation)) +
                           motion.lead_s * pull.angular_rad_s - motion.ahead.angular_rad;
    const double s = cross_fade(clock_.age_s());
    const auto gain = [s](const DofGains &from, const DofGains &to, std::size_t i) {
        return blend(from[i], to[i], s);
    };
    Wrench wrench;
    for (int k = 0; k < 3; ++k) {
        const auto i = static_cast<std::size_t>(k);
        const Twist &v = motion.velocity;
        wrench.force_n[k] =
            gain(from_stiffness_, coupling_.stiffness, i) * apart_m[k] +
            gain(from_damping_, coupling_.damping, i) * (pull.linear_m_s[k] - v.linear_m_s[k]);
        wrench.moment_nm[k] = gain(from_stiffness_, coupling_.stiffness, i + 3) * apart_rad[k] +
                              gain(from_damping_, coupling_.damping, i + 3) *
                                  (pull.angular_rad_s[k] - v.angular_rad_s[k]);
    }
    wrench.grasp_torque_nm = gain(from_stiffness_, coupling_.stiffness, kGraspLane) *
                                 (proxy.grasp_angle_rad + motion.lead_s * pull.grasp_rate_rad_s -
                                  grip.frame.grasp_angle_rad - motion.ahead.grasp_rad) +
                             gain(from_damping_, coupling_.damping, kGraspLane) *
                                 (pull.grasp_rate_rad_s - motion.velocity.grasp_rate_rad_s);
    const double strength = strength_.value();
    wrench.force_n = strength * no_longer_than(wrench.force_n, coupling_.max_force_n);
    wrench.moment_nm = strength * no_longer_than(wrench.moment_nm, coupling_.max_moment_nm);
    wrench.grasp_torque_nm =
        strength * std::clamp(wrench.grasp_torque_nm, -coupling_.max_grasp_torque_nm,
                              coupling_.max_grasp_torque_nm);
    return wrench;
}

} // namespace spidar
