// Properties of a surface besides compliance and friction: sticking, adhesion, attraction and
// texture. The servo loop renders them from the contact's motion (tool_proxy_surface.cpp,
// tool_proxy_friction.cpp).
#pragma once

#include "core/base/types.h"
#include "device/contact/shapes/cooked_shape.h"

namespace spidar {

// Valleys in the surface; the crests are flush with the shape. Grooves and pits have the shape of a
// cosine.
struct SurfaceTexture {
    double wavelength_m = 0.0; // 0: no texture
    double depth_m = 0.0;      // from crest to valley
    // Unit vector in the part's frame, perpendicular to the grooves. Zero: pits, with this
    // wavelength along the part's three axes.
    Vec3 across{0.0};
    // A shape of kind relief in place of grooves and pits; null: none. A tile of it is wavelength_m
    // wide. It is projected on the part along each axis of the part's frame; a projection counts by
    // the square of the normal's component along its axis. The game keeps it alive.
    const CookedShape *relief = nullptr;

    friend bool operator==(const SurfaceTexture &, const SurfaceTexture &) = default;
};

struct SurfaceTraits {
    // Coulomb coefficient of a sticking contact. A value below ScenePart::friction, the coefficient
    // of a sliding contact, counts as equal to it.
    double static_friction = 0.0;
    // True: a sliding contact sticks again after some milliseconds, even in motion (stick-slip).
    // False: it sticks again only when it is almost at rest.
    bool catches_again = false;
    // Pull at which a contact that has touched the surface comes off (unit: N).
    double adhesion_n = 0.0;
    // Attraction at the surface (unit: N). It falls linearly to 0 at magnet_range_m.
    double magnet_n = 0.0;
    // Distance at which the attraction ends. It is raised to magnet_n / (stiffness between grip and
    // proxy), so that the pull rises no more steeply than the force of those springs.
    double magnet_range_m = 0.0;
    SurfaceTexture texture;

    friend bool operator==(const SurfaceTraits &, const SurfaceTraits &) = default;
};

// Returns whether some trait besides friction can be felt.
[[nodiscard]] inline bool acts(const SurfaceTraits &traits) noexcept {
    return traits.adhesion_n > 0.0 || traits.magnet_n > 0.0 || traits.texture.depth_m > 0.0;
}

} // namespace spidar
