#include "device/rendering/effect_set.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "core/geometry/rotation_log.h"
#include "device/contract/dof_lanes.h"
#include "device/contract/request_fade.h"

namespace spidar {

namespace {

constexpr double kTurn_rad = 2.0 * std::numbers::pi;
// Highest vibration frequency relative to the servo rate: above it the samples are no sine.
constexpr double kHighestVibration = 0.25;
// Largest constant force: keeps it from overflowing. The limit of the sum is checked elsewhere.
constexpr double kMostForce = 1e6;

bool has(const Effect &effect, std::size_t dof) noexcept {
    return ((effect.dof_mask >> dof) & 1U) != 0;
}

} // namespace

void EffectSet::configure(const ServoSettings &settings) noexcept {
    *this = EffectSet();
    fade_out_s_ = settings.safety.wrench_fade_s;
    rate_hz_ = settings.rate_hz;
    caps_ = gain_caps(settings.render, settings.rate_hz);
}

void EffectSet::retune(const ServoSettings &settings) noexcept {
    caps_ = gain_caps(settings.render, settings.rate_hz);
}

GainClamp EffectSet::cap(Effect &effect, std::int32_t index) const noexcept {
    using Gain = GainClamp::Gain;
    GainClamp clamp;
    clamp.request = GainClamp::Request::effect;
    for (int k = 0; k < 3; ++k) {
        effect.centre_m[k] = std::clamp(effect.centre_m[k], -kFarAway_m, kFarAway_m);
    }
    effect.centre_grasp_rad = std::clamp(effect.centre_grasp_rad, -kFarAway_m, kFarAway_m);
    effect.frequency_hz = std::min(effect.frequency_hz, kHighestVibration * rate_hz_);
    for (std::size_t i = 0; i < effect.gain.size(); ++i) {
        double &gain = effect.gain[i];
        if (!has(effect, i)) {
            gain = 0.0;
            continue;
        }
        const DofCap stiffest = stiffness_cap(caps_, i);
        const DofCap damping = damping_cap(caps_, i);
        switch (effect.kind) {
        case EffectKind::viscous:
            gain = capped(gain, damping.most, damping.gain, index, false, clamp);
            break;
        case EffectKind::spring:
            gain = capped(gain, stiffest.most, stiffest.gain, index, caps_.from_latency, clamp);
            break;
        case EffectKind::detents:
            // The stiffness at the bottom of a valley is 2 pi / spacing times its depth.
            gain = capped(gain, stiffest.most * effect.spacing[i] / kTurn_rad, Gain::force, index,
                          caps_.from_latency, clamp);
            break;
        case EffectKind::vibration:
            gain = capped(gain, i < 3 ? kMaxVibration_n : kMaxVibration_nm, Gain::force, index,
                          false, clamp);
            break;
        case EffectKind::constant:
            gain = capped(gain, kMostForce, Gain::force, index, false, clamp);
            break;
        }
    }
    return clamp;
}

GainClamp EffectSet::accept(const HapticCommand &command) noexcept {
    GainClamp clamp;
    const std::array<Track, kMaxEffects> old = tracks_;
    const std::array<DofLanes, kMaxEffects> given = last_;
    std::array<bool, kMaxEffects> used{};
    const std::size_t old_count = count_;
    count_ = static_cast<std::size_t>(std::clamp(command.effect_count, 0, kMaxEffects));
    last_ = {};
    for (std::size_t i = 0; i < count_; ++i) {
        Track track;
        track.effect = command.effects[i];
        const GainClamp own = cap(track.effect, static_cast<std::int32_t>(i));
        clamp = clamp.gain == GainClamp::Gain::none ? own : clamp;
        for (std::size_t j = 0; j < old_count; ++j) {
            const Effect &before = old[j].effect;
            if (used[j] || before.id != track.effect.id || before.kind != track.effect.kind) {
                continue;
            }
            used[j] = true;
            last_[i] = given[j];
            if (before.renewal == track.effect.renewal) {
                track = old[j]; // not refreshed: continues, or has ended
            } else {
                track.from = gain_now(old[j]);
                track.phase_rad = old[j].phase_rad;
            }
            break;
        }
        tracks_[i] = track;
    }
    DofLanes gone{};
    for (std::size_t i = 0; i < gone.size(); ++i) {
        gone[i] = leaving_part_ * leaving_[i];
        for (std::size_t j = 0; j < old_count; ++j) {
            gone[i] += used[j] ? 0.0 : given[j][i];
        }
    }
    leaving_ = gone;
    leaving_part_ = 1.0;
    return clamp;
}

int EffectSet::age(double dt_s) noexcept {
    leaving_part_ = std::max(0.0, leaving_part_ - dt_s / kCrossFade_s);
    int ended = 0;
    for (std::size_t i = 0; i < count_; ++i) {
        Track &track = tracks_[i];
        track.age_s += dt_s;
        track.fade_s += dt_s;
        track.phase_rad =
            std::fmod(track.phase_rad + kTurn_rad * track.effect.frequency_hz * dt_s, kTurn_rad);
        if (!track.ended && track.age_s >= track.effect.duration_s + fade_out_s_) {
            track.ended = true;
            ++ended;
        }
    }
    return ended;
}

bool EffectSet::at_rest() const noexcept {
    bool over = leaving_part_ <= 0.0;
    for (std::size_t i = 0; i < count_; ++i) {
        over = over && tracks_[i].ended;
    }
    return over;
}

DofGains EffectSet::gain_now(const Track &track) const noexcept {
    const double s = cross_fade(track.fade_s);
    const double left =
        track.ended ? 0.0 : faded_out(track.age_s - track.effect.duration_s, fade_out_s_);
    DofGains gain{};
    for (std::size_t i = 0; i < gain.size(); ++i) {
        gain[i] = left * blend(track.from[i], track.effect.gain[i], s);
    }
    return gain;
}

DofLanes EffectSet::force(const Track &track, const GripMotion &motion) const noexcept {
    const Effect &effect = track.effect;
    DofLanes result = gain_now(track).values;
    switch (effect.kind) {
    case EffectKind::constant:
        return result;
    case EffectKind::vibration: {
        const double wave = std::sin(track.phase_rad);
        for (double &value : result) {
            value *= wave;
        }
        return result;
    }
    case EffectKind::viscous: {
        const DofLanes v = lanes(motion.velocity);
        for (std::size_t i = 0; i < result.size(); ++i) {
            result[i] *= -v[i];
        }
        return result;
    }
    case EffectKind::spring:
    case EffectKind::detents:
        break;
    }
    const GripState &grip = motion.grip;
    const DofLanes away =
        lanes(grip.pose.position_m + motion.ahead.linear_m - effect.centre_m,
              rotation_log(grip.frame.rotation * glm::transpose(effect.centre_rotation)) +
                  motion.ahead.angular_rad,
              grip.frame.grasp_angle_rad + motion.ahead.grasp_rad - effect.centre_grasp_rad);
    for (std::size_t i = 0; i < result.size(); ++i) {
        if (!has(effect, i)) {
            result[i] = 0.0;
        } else if (effect.kind == EffectKind::spring) {
            result[i] *= -away[i];
        } else {
            result[i] *= -std::sin(kTurn_rad * away[i] / effect.spacing[i]);
        }
    }
    return result;
}

Wrench EffectSet::render(const GripMotion &motion) noexcept {
    DofLanes sum{};
    for (std::size_t i = 0; i < sum.size(); ++i) {
        sum[i] = leaving_part_ * leaving_[i];
    }
    for (std::size_t t = 0; t < count_; ++t) {
        last_[t] = force(tracks_[t], motion);
        for (std::size_t i = 0; i < sum.size(); ++i) {
            sum[i] += last_[t][i];
        }
    }
    return of_lanes<Wrench>(sum);
}

} // namespace spidar
