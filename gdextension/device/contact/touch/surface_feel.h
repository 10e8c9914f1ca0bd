// How a surface of the scene feels, apart from where it is. A game may change it while the hand is on the surface (a material's
// slider, a pinch that begins): the servo loop then goes over to the new one within kFeelFade_s, so that the hand feels no jolt.
#pragma once

#include "device/contact/proxy/contact_scene.h"
#include "device/contact/proxy/tool_proxy.h"

namespace spidar {

// A wall of 1000 N/m that a finger presses by 2 mm then gives way by 0.04 N in a cycle.
inline constexpr double kFeelFade_s = 0.05;

struct SurfaceFeel {
    double stiffness_n_m = 0.0; // 0: rigid
    double damping_n_s_m = 0.0;
    double friction = 0.0;
    SurfaceTraits traits;
};

[[nodiscard]] SurfaceFeel feel_of(const ScenePart &part) noexcept;
void set_feel(const SurfaceFeel &feel, ScenePart &part) noexcept;
[[nodiscard]] bool same(const SurfaceFeel &a, const SurfaceFeel &b) noexcept;

// The feel one cycle of dt_s further on its way from `now` to `wanted`, which is reached in left_s (at most kFeelFade_s). A
// texture with another pattern comes when the old one has become flat, half way; one with another relief comes at once, as
// nobody keeps the old relief alive, and rises from flat.
[[nodiscard]] SurfaceFeel approach(const SurfaceFeel &now, const SurfaceFeel &wanted, double left_s,
                                   double dt_s) noexcept;
// The same for the springs between grip and proxy.
[[nodiscard]] bool same(const ProxySettings &a, const ProxySettings &b) noexcept;
[[nodiscard]] ProxySettings approach(const ProxySettings &now, const ProxySettings &wanted,
                                     double left_s, double dt_s) noexcept;

} // namespace spidar
