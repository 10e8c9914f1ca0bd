// Where a tool and a shape of the scene are closest: what the proxy of the servo loop must not pass. All functions here
// are for the servo side: no allocation, no lock, no exception.
//
// Errors against the exact answer while the cores are apart: 1e-7 m on spheres, 1e-5 m on everything else, normals
// within 0.1 degree.
#pragma once

#include <array>
#include <cstdint>

#include "core/base/status.h"
#include "device/contact/shapes/cooked_shape.h"
#include "device/contact/shapes/placement.h"
#include "device/contact/shapes/tool_shape.h"

namespace spidar {

inline constexpr int kMaxContactPoints = 24; // of one tool on one shape
inline constexpr int kPointsPerFace = 4;

struct ContactPoint {
    Vec3 on_tool_m{0.0};  // on the tool's outer surface, device frame
    Vec3 on_shape_m{0.0}; // device frame
    Vec3 normal{0.0};     // unit, from the shape to the tool, device frame
    double gap_m =
        0.0; // (on_tool - on_shape) . normal; below 0: the skin is inside the shape by so much
    // Triangle of a mesh or height map, else face of the shape: tells contacts of one shape apart from cycle to cycle.
    std::uint32_t face = 0;
    // The tool's core is inside the shape: the gap is a way out, but not the exact distance. For recovery only.
    bool core_inside = false;
};

struct ClosestPoints {
    std::array<ContactPoint, kMaxContactPoints> points;
    int count = 0;
    bool left_out = false; // more points lie within the margin than are listed or gathered
};

// A triangle of a mesh that was near the tool when the triangles were gathered.
struct NearTriangle {
    std::uint32_t index = 0;
    std::array<std::uint16_t, 3> neighbour{}; // over edge i: place in the list; kNoTriangle
    std::array<float, 3> middle_m{};          // of a ball that holds the triangle
    float radius_m = 0.0F;
    // Bit i: edge i is convex or a border; bit 4 + i: by more than 3 degrees.
    std::uint8_t sharp_edges = 0;
};

// A box of 40 mm on triangles of 2.5 mm^2 has 1100 of them near.
inline constexpr int kMaxNearTriangles = 1536;
inline constexpr std::uint16_t kNoTriangle = 0xffff;

// What one tool remembers of one shape between cycles. It only saves time: forgetting it changes an answer by less than
// the errors above. One for each pair of tool and shape: forget() comes before it serves another.
struct PairMemory {
    Vec3 axis{0.0}; // of the last answer, shape's frame: where to begin
    // Meshes: the triangles that can come within the margin while the tool has moved less than slack_m.
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

// No point of the tool is within margin_m of the shape: told by its reach and the shape's bounding box, without looking at
// the shape itself. tool_m: the tool's origin in the shape's frame.
[[nodiscard]] bool is_far(const ToolShape &tool, const Vec3 &tool_m, const CookedShape &shape,
                          double margin_m) noexcept;

// All contact points with a gap of at most margin_m; none: the tool may move by margin_m without touching. Up to four
// for each pair of faces, the nearest first. Status::not_finite: a placement or the margin is not finite, out is empty.
[[nodiscard]] Status closest_points(const ToolShape &tool, const Placement &tool_at,
                                    const CookedShape &shape, const Placement &shape_at,
                                    double margin_m, PairMemory &memory,
                                    ClosestPoints &out) noexcept;

} // namespace spidar
