// Where two faces that look at each other overlap: the corners of the overlap carry a flat contact.
#pragma once

#include <array>

#include "device/contact/shapes/convex_core.h"
#include "device/contact/shapes/placement.h"

namespace spidar {

inline constexpr int kMaxFaceCorners = 16; // of a face with more, evenly spread ones are taken

// A corner, an edge or a face of a core.
struct CoreFace { // NOLINT(cppcoreguidelines-pro-type-member-init)
    std::array<Vec3, kMaxFaceCorners> corners;
    int count = 0;
    std::uint32_t number = 0;

    void add(const Vec3 &corner) noexcept {
        if (count < kMaxFaceCorners) {
            corners[static_cast<std::size_t>(count++)] = corner;
        }
    }
};

// The face of the core that looks most along `way`, a unit vector; of a round side the line, of a rim the corner.
[[nodiscard]] CoreFace face_towards(const CoreView &core, const Vec3 &way) noexcept;
// The same of a placed core.
[[nodiscard]] CoreFace face_towards(const CoreView &core, const Placement &at,
                                    const Vec3 &way) noexcept;

struct FacePair {
    Vec3 on_tool{0.0};
    Vec3 on_shape{0.0};
};

inline constexpr int kMaxFacePairs = 2 * kMaxFaceCorners;

struct FacePairs { // NOLINT(cppcoreguidelines-pro-type-member-init)
    std::array<FacePair, kMaxFacePairs> pairs;
    int count = 0;
};

// Corners of the overlap of both faces as seen along `normal`, which leads from shape to tool. None for a corner.
[[nodiscard]] FacePairs overlap_of(const CoreFace &tool, const CoreFace &shape,
                                   const Vec3 &normal) noexcept;

} // namespace spidar
