// Overlap of two faces that face each other. The corners of the overlap are the points of a flat
// contact.
#pragma once

#include <array>

#include "device/contact/shapes/convex_core.h"
#include "device/contact/shapes/placement.h"

namespace spidar {

// Largest number of corners per face. Of a face with more corners, evenly spread ones are used.
inline constexpr int kMaxFaceCorners = 16;

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

// Returns the core's face in the direction `way` (unit vector): a line at a round side, a corner at
// a rim.
[[nodiscard]] CoreFace face_towards(const CoreView &core, const Vec3 &way) noexcept;
// Same for a placed core.
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

// Returns the corners of the overlap of two faces as seen along `normal`, which points from shape
// to tool. Empty when a face is a single corner.
[[nodiscard]] FacePairs overlap_of(const CoreFace &tool, const CoreFace &shape,
                                   const Vec3 &normal) noexcept;

} // namespace spidar
