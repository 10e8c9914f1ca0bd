// What cooking leaves, for this room alone.
#pragma once

#include "device/contact/shapes/convex_core.h"
#include "device/contact/shapes/cooked_shape.h"
#include "device/contact/shapes/relief_map.h"
#include "device/contact/shapes/tool_shape.h"
#include "device/contact/shapes/triangle_tree.h"

namespace spidar {

struct CookedShape::Data {
    ShapeDescription description; // points of a mesh and heights of a height map stay here
    Vec3 lower_m{0.0};
    Vec3 upper_m{0.0};
    ConvexCore core; // of a convex kind
    double skin_m = 0.0;
    TriangleTree tree;                                    // of a mesh
    std::vector<std::uint8_t> sharp_edges;                // of a mesh: NearTriangle::sharp_edges
    std::vector<ReliefLevel> relief;                      // of a relief: finest first
    std::vector<std::array<std::uint32_t, 3>> neighbours; // of a mesh: over each edge, or kNone
};

struct ToolShape::Data {
    ToolDescription description;
    ConvexCore core;
    double skin_m = 0.0;
    double reach_m = 0.0; // skin included
};

} // namespace spidar
