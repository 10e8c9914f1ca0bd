// A relief for the texture of a surface: a grid of heights from 0 (valley) to 1 (crest), called a
// tile, that repeats in both directions. It is cooked from a ShapeDescription of kind relief. The
// heights control a uniform cubic B-spline, so that height, slope and curvature are continuous.
// Each coarser copy (level) has half the columns and rows of the one before. Coarse levels serve
// fast motion and hard pushes.
#pragma once

#include <vector>

namespace spidar {

struct ReliefLevel {
    int columns = 0;
    int rows = 0;
    std::vector<float> heights; // heights[row * columns + column], from 0 to 1
    // Upper bound of the second derivative of the height along u and along v, in tile widths.
    double most_curvature = 0.0;
};

// The levels of a relief, finest first.
using ReliefLevels = std::vector<ReliefLevel>;

// Returns at least one level; halving ends at an odd number of columns or rows or below 16.
// heights: columns * rows values from 0 to 1.
[[nodiscard]] ReliefLevels make_relief_levels(int columns, int rows, std::vector<float> heights);

struct ReliefPoint {
    double height = 0.0;  // from 0 to 1
    double slope_u = 0.0; // change of the height per tile width along u
    double slope_v = 0.0; // the same along v
};

// Returns the relief at (u, v), both in tile widths. It repeats after 1 along u, and after rows /
// columns of the finest level along v. coarseness: number of the level, 0 for the finest. A
// fraction blends two levels; a number beyond the last level means the last.
[[nodiscard]] ReliefPoint relief_point(const ReliefLevels &levels, double coarseness, double u,
                                       double v) noexcept;

// Returns a coarseness at which neighboring heights lie at least `spacing` apart along the surface
// (in tile widths; a blend counts as between its two levels), and at which the second derivative is
// at most `curvature`. If every level is too fine for `spacing`, the result exceeds the number of
// the last level. If every level exceeds `curvature`, the result is at least that number, and the
// caller has to flatten the relief.
[[nodiscard]] double relief_coarseness(const ReliefLevels &levels, double spacing,
                                       double curvature) noexcept;

} // namespace spidar
