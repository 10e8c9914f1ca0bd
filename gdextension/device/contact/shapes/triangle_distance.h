// A triangle and the cores that touch meshes most, in closed form.
#pragma once

#include <array>
#include <cstdint>

#include "core/base/types.h"

namespace spidar {

using Corners = std::array<Vec3, 3>; // counter-clockwise seen from the front

// Where on a triangle: edge i leads from corner i to the next.
struct TrianglePart {
    enum Kind : std::uint8_t { inside, edge, corner };
    Kind kind;
    std::uint8_t number;
};

struct TriangleDistance {
    double distance_m = 0.0; // infinite: no point of this triangle can be the nearest of its mesh
    Vec3 on_core{0.0};
    Vec3 on_triangle{0.0};
    Vec3 normal{0.0}; // unit, from the triangle to the core
    TrianglePart part{TrianglePart::inside, 0};
    bool overlap = false; // they meet; only `overlap` is set
};

[[nodiscard]] TriangleDistance point_to_triangle(const Vec3 &point,
                                                 const Corners &triangle) noexcept;

// A flat disc. face: the triangle's unit normal, on the side where the disc's centre is. sharp_edges: bit i for edges
// that can be the nearest to something; others are left out.
[[nodiscard]] TriangleDistance disc_to_triangle(const Vec3 &centre, const Vec3 &axis,
                                                double radius_m, const Corners &triangle,
                                                const Vec3 &face,
                                                std::uint8_t sharp_edges) noexcept;

// Does the foot of a point on the triangle's plane lie inside? A foot on an edge does, within rounding.
[[nodiscard]] bool over_triangle(const Vec3 &point, const Corners &triangle) noexcept;

// Which part a point of the triangle lies on.
[[nodiscard]] TrianglePart part_of(const Vec3 &point, const Corners &triangle) noexcept;

} // namespace spidar
