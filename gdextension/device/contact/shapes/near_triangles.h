// The triangles of a mesh near a tool, gathered once for many cycles.
#pragma once

#include "device/contact/shapes/closest_points.h"
#include "device/contact/shapes/convex_core.h"
#include "device/contact/shapes/triangle_source.h"

namespace spidar {

// Returns true while gathering anew would not help: the memory holds all triangles within margin_m
// of the tool, or it is full and the tool has hardly moved.
[[nodiscard]] bool still_near(const PairMemory &memory, const ToolShape::Data &tool,
                              const Placement &tool_at, double margin_m) noexcept;

// Gathers the triangles near the tool into the memory.
void gather_triangles(const TriangleSource &source, const ToolShape::Data &tool,
                      const Placement &tool_at, double margin_m, PairMemory &memory) noexcept;

} // namespace spidar
