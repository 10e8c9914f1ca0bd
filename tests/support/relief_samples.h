// Reliefs for tests: descriptions of repeating images of heights.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

#include "device/contact/shapes/cooked_shape.h"

namespace spidar::test {

inline ShapeDescription relief_of(int columns, int rows, std::vector<float> heights) {
    ShapeDescription shape;
    shape.kind = ShapeKind::relief;
    shape.columns = columns;
    shape.rows = rows;
    shape.heights_m = std::move(heights);
    return shape;
}

// Waves along u and v, this many in a tile.
inline ShapeDescription relief_waves(int columns, int rows, int along_u, int along_v) {
    std::vector<float> heights;
    for (int row = 0; row < rows; ++row) {
        for (int column = 0; column < columns; ++column) {
            const double phase = 2.0 * std::numbers::pi *
                                 (static_cast<double>(along_u * column) / columns +
                                  static_cast<double>(along_v * row) / rows);
            heights.push_back(static_cast<float>(0.5 + 0.5 * std::cos(phase)));
        }
    }
    return relief_of(columns, rows, std::move(heights));
}

inline ShapeDescription relief_noise(int columns, int rows, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> height(0.0F, 1.0F);
    std::vector<float> heights(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
    std::ranges::generate(heights, [&] { return height(random); });
    return relief_of(columns, rows, std::move(heights));
}

} // namespace spidar::test
