// A mesh made ready: equal corners are one, triangles without area are gone, and each knows those over its edges.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "device/contact/shapes/cooked_shape.h"

namespace spidar {

class TriangleSource;

// Corners at the same place become one. Returns how many triangles were dropped.
int weld(ShapeDescription &mesh);

// For each triangle the one over edge i, from corner i to the next; 0xffffffff at a border, and where more than two meet.
[[nodiscard]] std::vector<std::array<std::uint32_t, 3>>
find_neighbours(std::span<const std::uint32_t> indices);

// For each triangle of a mesh whose neighbours are known, as NearTriangle::sharp_edges has it.
[[nodiscard]] std::vector<std::uint8_t> find_sharp_edges(const TriangleSource &mesh);

} // namespace spidar
