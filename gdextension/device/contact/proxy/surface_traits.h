// What a surface does beside giving way and rubbing: it catches, sticks, attracts, and has a texture. All of it is rendered
// in the servo loop from the contact's own motion (tool_proxy_surface.cpp, tool_proxy_friction.cpp).
#pragma once

#include "core/base/types.h"
#include "device/contact/shapes/cooked_shape.h"

namespace spidar {

// Valleys cut into the surface, so that its crests are flush with the shape. Smooth: a cosine.
struct SurfaceTexture {
    double wavelength_m = 0.0; // 0: no texture
    double depth_m = 0.0;      // from crest to valley
    // Unit, in the part's frame: the grooves run at right angles to it. Zero: pits, with this wavelength along the part's
    // three axes.
    Vec3 across{0.0};
    // In place of grooves and pits: an image of heights, whose width along the surface is wavelength_m. It is laid on the
    // part from the three axes of its frame, each counted as far as the surface faces along it. Of kind relief; the game
    // keeps it alive. Null: none.
    const CookedShape *relief = nullptr;
};

struct SurfaceTraits {
    // Coulomb coefficient of a contact that does not slip; ScenePart::friction is that of one that slips. At most that: the
    // same for both.
    double static_friction = 0.0;
    // A contact that slips catches again at once, and creaks. Without it, it slips until it stands.
    bool catches_again = false;
    // What has touched the surface comes off at this pull.
    double adhesion_n = 0.0;
    // Attraction: this on the surface, and nothing at the range from it; linear in between. The range is at least what
    // keeps the pull from rising more steeply than the stiffness between grip and proxy.
    double magnet_n = 0.0;
    double magnet_range_m = 0.0;
    SurfaceTexture texture;
};

// Whether some of it is felt beside friction.
[[nodiscard]] inline bool acts(const SurfaceTraits &traits) noexcept {
    return traits.adhesion_n > 0.0 || traits.magnet_n > 0.0 || traits.texture.depth_m > 0.0;
}

} // namespace spidar
