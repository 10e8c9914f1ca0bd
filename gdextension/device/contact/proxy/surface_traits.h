// Properties of a surface besides compliance and friction: sticking, adhesion, attraction and
// texture. The servo loop renders them from the contact's motion (tool_proxy_surface.cpp,
// tool_proxy_friction.cpp).
#pragma once

#include "core/base/types.h"
#include "device/contact/shapes/cooked_shape.h"

namespace spidar {

// Valleys in the surface, with crests flush with the shape: a cosine.
struct SurfaceTexture {
    double wavelength_m = 0.0; // 0: no texture
    double depth_m = 0.0;      // from crest to valley
    // Unit vector in the part's frame, perpendicular to the grooves. Zero: pits, with this
    // wavelength along the part's three axes.
    Vec3 across{0.0};
    // In place of grooves and pits: an image of heights, whose width along the surface is wavelength_m. It is laid on the
    // part from the three axes of its frame, each counted as far as the surface faces along it. Of kind relief; the game
    // keeps it alive. Null: none.
    const CookedShape *relief = nullptr;
};

struct SurfaceTraits {
    // Coulomb coefficient of a sticking contact; ScenePart::friction is that of a sliding one. A
    // smaller value counts as equal to the sliding one.
    double static_friction = 0.0;
    // True: a sliding contact may stick again (stick-slip). False: it slides until it stands still.
    bool catches_again = false;
    // Pull at which a contact that has touched the surface comes off (unit: N).
    double adhesion_n = 0.0;
    // Attraction at the surface (unit: N), which falls linearly to 0 at the range.
    double magnet_n = 0.0;
    // Range of the attraction. It is enlarged where the pull would rise more steeply than the
    // stiffness between grip and proxy.
    double magnet_range_m = 0.0;
    SurfaceTexture texture;
};

// Returns whether some trait besides friction can be felt.
[[nodiscard]] inline bool acts(const SurfaceTraits &traits) noexcept {
    return traits.adhesion_n > 0.0 || traits.magnet_n > 0.0 || traits.texture.depth_m > 0.0;
}

} // namespace spidar
