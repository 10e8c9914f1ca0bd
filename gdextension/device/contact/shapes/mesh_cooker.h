// Prepares a mesh: merges equal corners, drops triangles without area, finds neighbors.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "device/contact/shapes/cooked_shape.h"

namespace spidar {

class TriangleSource;

// Merges corners at the same place and drops triangles without area. Returns the number of dropped
// triangles.
int weld(ShapeDescription &mesh);

// Returns, per triangle, the neighbor across edge i (from corner i to the next). 0xffffffff at a
// border and where more than two triangles meet.
[[nodiscard]] std::vector<std::array<std::uint32_t, 3>>
find_neighbours(std::span<const std::uint32_t> indices);

// Returns NearTriangle::sharp_edges of each triangle of a mesh with known neighbors.
[[nodiscard]] std::vector<std::uint8_t> find_sharp_edges(const TriangleSource &mesh);

} // namespace spidar
