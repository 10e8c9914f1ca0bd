// Results of cooking. Used within this folder only.
#pragma once

#include "device/contact/shapes/convex_core.h"
#include "device/contact/shapes/cooked_shape.h"
#include "device/contact/shapes/tool_shape.h"
#include "device/contact/shapes/triangle_tree.h"

namespace spidar {

struct CookedShape::Data {
    // The servo loop too reads a mesh's points and a height map's heights here.
    ShapeDescription description;
    Vec3 lower_m{0.0};
    Vec3 upper_m{0.0};
    ConvexCore core; // box to hull only
    double skin_m = 0.0;
    TriangleTree tree;                     // mesh only
    std::vector<std::uint8_t> sharp_edges; // mesh only: NearTriangle::sharp_edges
    ReliefLevels relief;                   // relief only: finest first
    // Mesh only: neighbor across each edge, or kNone.
    std::vector<std::array<std::uint32_t, 3>> neighbours;
};

struct ToolShape::Data {
    ToolDescription description;
    ConvexCore core;
    double skin_m = 0.0;
    double reach_m = 0.0; // with skin
};

} // namespace spidar
