// Report of a gain that was clamped: the requested value, the value used and what set the limit.
#pragma once

#include <cmath>
#include <cstdint>
#include <string>

#include "core/base/sound_state.h"
#include "device/settings/render_settings.h"

namespace spidar {

struct GainClamp {
    enum class Gain : std::uint8_t {
        none = 0,
        stiffness = 1,       // N/m
        damping = 2,         // N s/m
        turn_stiffness = 3,  // N m/rad
        turn_damping = 4,    // N m s/rad
        grasp_stiffness = 5, // N m/rad of grasp_angle
        grasp_damping = 6,   // N m s/rad of grasp_angle
        friction = 7,
        speed = 8, // speed of a plane or proxy, m/s or rad/s
        force = 9, // strength of an effect, N or N m
        // The whole request was scaled: `asked` is 1, `given` the factor.
        wrench = 10,
    };
    enum class Request : std::uint8_t { contact, coupling, effect, wrench };

    Gain gain = Gain::none;
    Request request = Request::contact;
    // True if the latency and the rate of the loop set the limit; false if a setting did.
    bool from_latency = false;
    std::int32_t index = 0; // of the contact, effect or DOF
    // Requested value.
    double asked = 0.0;
    // Value used instead.
    double given = 0.0;

    explicit operator bool() const noexcept { return gain != Gain::none; }
};

// Largest Coulomb coefficient, whatever the settings: no hand can use more.
inline constexpr double kMaxFriction = 10.0;
// Largest speed of a surface, whatever the settings: a faster one is an error of the physics
// engine.
inline constexpr double kMaxSurfaceSpeed_m_s = 10.0;

// Returns `value` clamped to +-cap. Records the first clamped gain of a request in `clamp`.
inline double capped(double value, double cap, GainClamp::Gain gain, std::int32_t index,
                     bool from_latency, GainClamp &clamp) noexcept {
    if (std::abs(value) <= cap) {
        return value;
    }
    if (clamp.gain == GainClamp::Gain::none) {
        clamp.gain = gain;
        clamp.from_latency = from_latency;
        clamp.index = index;
        clamp.asked = value;
        clamp.given = std::copysign(cap, value);
    }
    return std::copysign(cap, value);
}

// Largest gain in one DOF (0-2: x, y, z; 3-5: turns; 6: grasp) and the kind of that gain.
struct DofCap {
    double most = 0.0;
    GainClamp::Gain gain = GainClamp::Gain::none;
};
[[nodiscard]] inline DofCap stiffness_cap(const GainCaps &caps, std::size_t dof) noexcept {
    if (dof < 3) {
        return {caps.stiffness_n_m, GainClamp::Gain::stiffness};
    }
    return dof < 6 ? DofCap{caps.turn_stiffness_nm_rad, GainClamp::Gain::turn_stiffness}
                   : DofCap{caps.grasp_stiffness_nm_rad, GainClamp::Gain::grasp_stiffness};
}
[[nodiscard]] inline DofCap damping_cap(const GainCaps &caps, std::size_t dof) noexcept {
    if (dof < 3) {
        return {caps.damping_n_s_m, GainClamp::Gain::damping};
    }
    return dof < 6 ? DofCap{caps.turn_damping_nm_s_rad, GainClamp::Gain::turn_damping}
                   : DofCap{caps.grasp_damping_nm_s_rad, GainClamp::Gain::grasp_damping};
}

// Returns one sentence with the requested value, the value used, the reason and the remedy. Empty
// when nothing was clamped. Allocates.
[[nodiscard]] std::string describe(const GainClamp &clamp, const RenderSettings &settings,
                                   double rate_hz);

// Checks restored memory: see core/base/sound_state.h.
[[nodiscard]] inline bool is_sound(const GainClamp &clamp) noexcept {
    return are_flags(clamp.from_latency) && is_one_of(clamp.gain, GainClamp::Gain::wrench) &&
           is_one_of(clamp.request, GainClamp::Request::wrench);
}

} // namespace spidar
