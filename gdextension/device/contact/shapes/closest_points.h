// Finds where a tool and a shape of the scene are closest, so that the servo loop's proxy stops
// there. All functions are servo-safe: no allocation, lock or exception.
//
// Largest errors while the cores are apart: 1e-7 m on spheres, else 1e-5 m; 0.1 degree for normals.
#pragma once

#include <array>
#include <cstdint>

#include "core/base/status.h"
#include "device/contact/shapes/cooked_shape.h"
#include "device/contact/shapes/placement.h"
#include "device/contact/shapes/tool_shape.h"

namespace spidar {

inline constexpr int kMaxContactPoints = 24; // of one tool on one shape
// Largest number of points with one direction of the normal.
inline constexpr int kPointsPerFace = 4;

struct ContactPoint {
    Vec3 on_tool_m{0.0};  // on the outer surface of the tool, device frame
    Vec3 on_shape_m{0.0}; // device frame
    Vec3 normal{0.0};     // unit, from the shape to the tool, device frame
    // (on_tool - on_shape) . normal. Negative when the skin penetrates the shape.
    double gap_m = 0.0;
    // Number of the triangle (mesh, height map) or of the face (other shapes).
    std::uint32_t face = 0;
    // True when the tool's core is inside the shape. The normal then leads out, but the gap is not
    // the exact distance: for recovery only.
    bool core_inside = false;
};

struct ClosestPoints {
    std::array<ContactPoint, kMaxContactPoints> points;
    int count = 0;
    // More points lie within the margin than `points` or the memory of triangles can hold.
    bool left_out = false;
};

// A triangle of a mesh that was near the tool when the triangles were gathered.
struct NearTriangle {
    std::uint32_t index = 0;
    // Index in PairMemory::triangles of the triangle across edge i, or kNoTriangle.
    std::array<std::uint16_t, 3> neighbour{};
    std::array<float, 3> middle_m{}; // center of a ball around the triangle
    float radius_m = 0.0F;
    // Bit i: edge i is sharp: a border, convex, or (of a two-sided shape) concave. Bit 4 + i: a
    // border, or sharp by more than 3 degrees.
    std::uint8_t sharp_edges = 0;
};

// Largest number of gathered triangles. A box of 40 mm on triangles of 2.5 mm^2 has 1100 near it.
inline constexpr int kMaxNearTriangles = 1536;
inline constexpr std::uint16_t kNoTriangle = 0xffff;

// Memory of one pair of tool and shape between cycles. It only saves time: without it an answer
// changes by less than the errors above. Call forget() before it serves another pair.
struct PairMemory {
    // Direction of the last answer in the shape's frame, where the next search starts.
    Vec3 axis{0.0};
    // Meshes: `triangles` holds all that can come within margin_m while the tool moves by slack_m,
    // unless `full`.
    Placement gathered_at; // tool in the shape's frame
    double slack_m = -1.0; // below 0: nothing is gathered
    double margin_m = 0.0;
    int count = 0;
    bool full = false;
    std::array<NearTriangle, kMaxNearTriangles> triangles;

    void forget() noexcept {
        axis = Vec3(0.0);
        slack_m = -1.0;
        count = 0;
        full = false;
    }
};

// Returns true when no point of the tool is within margin_m of the shape, as far as the tool's
// reach and the shape's bounding box show. tool_m: the tool's origin in the shape's frame.
[[nodiscard]] bool is_far(const ToolShape &tool, const Vec3 &tool_m, const CookedShape &shape,
                          double margin_m) noexcept;

// Finds contact points with a gap of at most margin_m: the nearest first, then others, at most
// kPointsPerFace per direction of the normal and kMaxContactPoints in all. No points: the tool may
// move by margin_m without touching. Returns not_finite for a placement or margin that is not
// finite; `out` is then empty.
[[nodiscard]] Status closest_points(const ToolShape &tool, const Placement &tool_at,
                                    const CookedShape &shape, const Placement &shape_at,
                                    double margin_m, PairMemory &memory,
                                    ClosestPoints &out) noexcept;

} // namespace spidar
