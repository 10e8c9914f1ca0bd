// A relief that repeats in two directions, for the texture of a surface: heights from 0 (valley) to 1 (crest), cooked from a
// ShapeDescription of kind relief. Between its heights it is a uniform cubic B-spline, so that height, slope and curvature are
// continuous. Coarser copies, each with half the columns and rows of the one before, serve fast motion and hard pushes.
#pragma once

#include <vector>

namespace spidar {

struct ReliefLevel {
    int columns = 0;
    int rows = 0;
    std::vector<float> heights; // heights[row * columns + column], from 0 to 1
    // Largest curvature of the height along either direction, for a tile of width 1 (1 / tile width).
    double most_curvature = 0.0;
};

// The copies of a relief, finest first.
using ReliefLevels = std::vector<ReliefLevel>;

// Returns at least one level. heights: columns * rows values from 0 to 1.
[[nodiscard]] ReliefLevels make_relief_levels(int columns, int rows, std::vector<float> heights);

struct ReliefPoint {
    double height = 0.0;  // from 0 to 1
    double slope_u = 0.0; // of the height along u, for one tile width
    double slope_v = 0.0; // along v, for one tile width
};

// The relief at (u, v), both in tile widths: it repeats after 1 along u and after rows / columns of the finest level along v.
// coarseness: 0 is the finest level, 1 the next; in between, the two are blended. Beyond the last level the last is used.
[[nodiscard]] ReliefPoint relief_point(const ReliefLevels &levels, double coarseness, double u,
                                       double v) noexcept;

// The smallest coarseness at which two neighbouring heights are at least `spacing` apart (tile widths) and no curvature
// exceeds `curvature`. It may be larger than the last level's: then even that one is too fine.
[[nodiscard]] double relief_coarseness(const ReliefLevels &levels, double spacing,
                                       double curvature) noexcept;

} // namespace spidar
