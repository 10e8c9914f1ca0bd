#include "godot/hand/grasp/held_load.h"

#include <algorithm>
#include <numbers>

#include <glm/geometric.hpp>

#include "core/base/finite.h"

namespace spidar {

namespace {

// Cut-off of the acceleration, which is a difference at game rate: higher frequencies are noise and
// delay.
constexpr double kAccelerationCutoff_hz = 10.0;
// Largest mass whose inertia is rendered. Inertia at game rate acts about 30 ms late, like a
// delayed mass, and oscillates near the hand's own mass. A light hand with grip and rotors has 0.16
// kg (gain margin above 4). At 0.1 kg a normal hand that squeezes hard in a far corner, where a
// string nears its limit, reached the speed limit in simulation.
constexpr double kMaxInertiaMass_kg = 0.05;
// Share of the device's largest force that inertia may use, so that a jerk never masks the weight.
constexpr double kInertiaForceShare = 0.3;
// Time over which the weight is applied: a step would be felt as a knock.
constexpr double kOnsetTime_s = 0.1;

Vec3 limited(const Vec3 &force_n, double most_n) noexcept {
    const double length = glm::length(force_n);
    return length > most_n ? (most_n / length) * force_n : force_n;
}

} // namespace

void HeldLoad::reset() noexcept {
    acceleration_m_s2_ = Vec3(0.0);
    age_s_ = 0.0;
}

void HeldLoad::clear() noexcept {
    added_n_ = Vec3(0.0);
    added_nm_ = Vec3(0.0);
}

void HeldLoad::add(const Vec3 &force_n, const Vec3 &moment_nm) noexcept {
    if (all_finite(force_n) && all_finite(moment_nm)) {
        added_n_ += force_n;
        added_nm_ += moment_nm;
    }
}

void HeldLoad::follow(const Vec3 &center_m, double since_s) noexcept {
    if (!(since_s > 0.0)) {
        return;
    }
    if (!known_) {
        center_m_ = center_m;
        known_ = true;
    }
    // Uses the mean velocity: the device's own twist, sampled at game rate, would alias the 100 Hz
    // of the strings.
    const Vec3 newest = (center_m - center_m_) / since_s;
    // Each mean velocity belongs to the middle of its interval.
    const double apart_s = since_s_ > 0.0 ? 0.5 * (since_s + since_s_) : since_s;
    const double blend =
        since_s / (since_s + 1.0 / (2.0 * std::numbers::pi * kAccelerationCutoff_hz));
    acceleration_m_s2_ += blend * ((newest - velocity_m_s_) / apart_s - acceleration_m_s2_);
    velocity_m_s_ = newest;
    center_m_ = center_m;
    since_s_ = since_s;
    age_s_ += since_s;
}

HeldLoad::Pull HeldLoad::pull(const Body &body, const Terms &terms) const noexcept {
    Vec3 weight_n(0.0);
    if (terms.with_weight) {
        weight_n = terms.gain * body.mass_kg * body.gravity_m_s2;
    }
    Vec3 force_n = weight_n;
    if (terms.with_inertia) {
        // Limits the hand's own motion, so that a large scale does not turn a small jerk into a
        // large force.
        const double mass_kg = std::min(terms.gain * body.mass_kg, kMaxInertiaMass_kg);
        force_n -= limited(mass_kg * acceleration_m_s2_, kInertiaForceShare * terms.max_force_n);
    }
    force_n *= std::clamp(age_s_ / kOnsetTime_s, 0.0, 1.0);
    const Vec3 moment_nm = glm::cross(body.center_m, force_n);
    return {{limited(force_n, terms.max_force_n), moment_nm, 0.0},
            {limited(force_n + added_n_, terms.max_force_n), moment_nm + added_nm_, 0.0},
            weight_n};
}

} // namespace spidar
