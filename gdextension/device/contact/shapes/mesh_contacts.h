// Finds the contacts of a tool with a mesh or height map, from the triangles near the tool
// (near_triangles.h).
#pragma once

#include "device/contact/shapes/contact_choice.h"
#include "device/contact/shapes/convex_core.h"
#include "device/contact/shapes/shape_data.h"

namespace spidar {

// Adds the contact candidates to `found`. All values are in the mesh's frame.
void mesh_contacts(const CookedShape::Data &mesh, const ToolShape::Data &tool,
                   const Placement &tool_at, double margin_m, PairMemory &memory,
                   ContactCandidates &found) noexcept;

} // namespace spidar
