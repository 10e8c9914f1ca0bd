// Shapes, tools and exact answers for the tests of device/contact/shapes. What cannot be cooked ends the program.
#pragma once

#include <cstdio>
#include <cstdlib>
#include <limits>
#include <memory>
#include <vector>

#include "device/contact/shapes/closest_points.h"
#include "device/contact/shapes/gjk.h"
#include "device/contact/shapes/shape_data.h"
#include "device/contact/shapes/triangle_source.h"
#include "support/case_random.h"

namespace spidar::test {

using ShapePtr = std::shared_ptr<const CookedShape>;
using ToolPtr = std::shared_ptr<const ToolShape>;

inline ShapePtr cooked(ShapeDescription description) {
    CookResult result = cook(std::move(description));
    if (!result.shape) {
        std::fprintf(stderr, "%s\n", result.sentence.c_str());
        std::abort();
    }
    return result.shape;
}

inline ShapePtr box(const Vec3 &half_extents_m) {
    ShapeDescription shape;
    shape.kind = ShapeKind::box;
    shape.half_extents_m = half_extents_m;
    return cooked(shape);
}

inline ShapePtr round_shape(ShapeKind kind, double radius_m, double half_height_m = 0.0) {
    ShapeDescription shape;
    shape.kind = kind;
    shape.radius_m = radius_m;
    shape.half_height_m = half_height_m;
    return cooked(shape);
}

inline ShapePtr hull(std::vector<Vec3> points_m) {
    ShapeDescription shape;
    shape.kind = ShapeKind::hull;
    shape.points_m = std::move(points_m);
    return cooked(shape);
}

inline ShapePtr half_space(const Vec3 &normal, double offset_m) {
    ShapeDescription shape;
    shape.kind = ShapeKind::half_space;
    shape.normal = normal;
    shape.offset_m = offset_m;
    return cooked(shape);
}

inline std::vector<Vec3> random_points(CaseRandom &random, int count, double size_m) {
    std::vector<Vec3> points;
    for (int i = 0; i < count; ++i) {
        points.push_back(random.vector(size_m));
    }
    return points;
}

// A height over a grid of cells * cells cells, cells of `cell_m`, centred; two triangles a cell, front up.
template <class Height>
ShapeDescription field(int cells, double cell_m, Height &&height) {
    ShapeDescription shape;
    shape.kind = ShapeKind::mesh;
    const int side = cells + 1;
    for (int row = 0; row < side; ++row) {
        for (int column = 0; column < side; ++column) {
            const double x = (column - 0.5 * cells) * cell_m;
            const double z = (row - 0.5 * cells) * cell_m;
            // As a height map has it: float32.
            shape.points_m.emplace_back(x, static_cast<double>(static_cast<float>(height(x, z))),
                                        z);
        }
    }
    for (int row = 0; row < cells; ++row) {
        for (int column = 0; column < cells; ++column) {
            const auto here = static_cast<std::uint32_t>(row * side + column);
            const auto below = here + static_cast<std::uint32_t>(side);
            for (const std::uint32_t index : {here, below, here + 1, here + 1, below, below + 1}) {
                shape.indices.push_back(index);
            }
        }
    }
    return shape;
}

inline ShapeDescription as_height_map(const ShapeDescription &mesh, int cells, double cell_m) {
    ShapeDescription map;
    map.kind = ShapeKind::height_map;
    map.columns = map.rows = cells + 1;
    map.spacing_x_m = map.spacing_z_m = cell_m;
    for (const Vec3 &point : mesh.points_m) {
        map.heights_m.push_back(static_cast<float>(point.y));
    }
    return map;
}

// A box as a mesh of twelve triangles, fronts outwards.
inline ShapeDescription box_mesh(const Vec3 &half) {
    ShapeDescription shape;
    shape.kind = ShapeKind::mesh;
    for (int i = 0; i < 8; ++i) {
        shape.points_m.emplace_back((i & 1) != 0 ? half.x : -half.x,
                                    (i & 2) != 0 ? half.y : -half.y,
                                    (i & 4) != 0 ? half.z : -half.z);
    }
    shape.indices = {0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4,
                     2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5};
    return shape;
}

inline ToolPtr tool(ToolResult result) {
    if (!result.tool) {
        std::fprintf(stderr, "%s\n", result.sentence.c_str());
        std::abort();
    }
    return result.tool;
}

inline double smallest_gap(const ClosestPoints &found) {
    double gap = std::numeric_limits<double>::infinity();
    for (int i = 0; i < found.count; ++i) {
        gap = std::min(gap, found.points[static_cast<std::size_t>(i)].gap_m);
    }
    return gap;
}

// Of the tool's outer surface to the nearest triangle of all, each looked at by itself; NaN when that one has
// one side and the tool, or its middle, is behind it.
inline double brute_gap(const ToolShape &tool, const Placement &tool_at, const CookedShape &mesh,
                        const Placement &mesh_at) {
    const TriangleSource source(mesh.data());
    const Mat3 back = glm::transpose(mesh_at.rotation);
    const Placement at{back * (tool_at.origin_m - mesh_at.origin_m), back * tool_at.rotation};
    const CoreView core = view_of(tool.data().core);
    double least = std::numeric_limits<double>::infinity();
    bool from_behind = false;
    source.visit_box(Vec3(-1e9), Vec3(1e9), [&](std::uint32_t triangle) {
        const Corners corners = source.corners(triangle);
        CoreView other;
        other.kind = CoreKind::points;
        other.points = corners;
        Vec3 axis(0.0);
        const CoreDistance found =
            core_distance(core, at, other, std::numeric_limits<double>::infinity(), axis);
        const double gap = (found.overlap ? 0.0 : found.distance_m) - tool.skin_m();
        const Vec3 front = normal_of(corners);
        const bool behind =
            !source.two_sided() && (glm::dot(at.origin_m - corners[0], front) < 0.0 ||
                                    (!found.overlap && glm::dot(found.normal, front) < 0.0));
        // Of two that share the nearest point, the one seen from its front counts.
        if (gap < least - 1e-10 || (from_behind && !behind && gap < least + 1e-10)) {
            least = gap;
            from_behind = behind;
        }
    });
    return from_behind ? std::numeric_limits<double>::quiet_NaN() : least;
}

} // namespace spidar::test
