#include "device/contact/relief/relief_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

namespace spidar {

namespace {

// Smallest number of columns or rows of a coarser level: twice the four heights that a point of a
// cubic B-spline depends on.
constexpr int kFewest = 8;

int wrapped(int index, int count) noexcept {
    return (index % count + count) % count;
}

double height_of(const ReliefLevel &level, int column, int row) noexcept {
    return static_cast<double>(
        level.heights[static_cast<std::size_t>(wrapped(row, level.rows)) *
                          static_cast<std::size_t>(level.columns) +
                      static_cast<std::size_t>(wrapped(column, level.columns))]);
}

// The second derivative of a cubic B-spline is linear between its heights, so it is largest at one
// of them. The average over the other direction does not enlarge it.
void measure_curvature(ReliefLevel &level) {
    for (int row = 0; row < level.rows; ++row) {
        for (int column = 0; column < level.columns; ++column) {
            const double middle = 2.0 * height_of(level, column, row);
            const double along_u =
                height_of(level, column - 1, row) + height_of(level, column + 1, row) - middle;
            const double along_v =
                height_of(level, column, row - 1) + height_of(level, column, row + 1) - middle;
            level.most_curvature =
                std::max({level.most_curvature, std::abs(along_u), std::abs(along_v)});
        }
    }
    level.most_curvature *= static_cast<double>(level.columns) * level.columns;
}

ReliefLevel halved(const ReliefLevel &finer) {
    ReliefLevel level;
    level.columns = finer.columns / 2;
    level.rows = finer.rows / 2;
    level.heights.reserve(static_cast<std::size_t>(level.columns) *
                          static_cast<std::size_t>(level.rows));
    for (int row = 0; row < level.rows; ++row) {
        for (int column = 0; column < level.columns; ++column) {
            // The kernel (1 2 1) / 4 in both directions, centered on the height that both levels
            // share.
            double sum = 0.0;
            for (int dr = -1; dr <= 1; ++dr) {
                for (int dc = -1; dc <= 1; ++dc) {
                    const double weight = (dr == 0 ? 0.5 : 0.25) * (dc == 0 ? 0.5 : 0.25);
                    sum += weight * height_of(finer, 2 * column + dc, 2 * row + dr);
                }
            }
            level.heights.push_back(static_cast<float>(sum));
        }
    }
    measure_curvature(level);
    return level;
}

// The four heights on which a point of a repeating cubic B-spline depends, and the weight of each
// in value and slope.
struct Weights {
    std::array<int, 4> index{};
    std::array<double, 4> value{};
    std::array<double, 4> slope{}; // per spacing of the heights
};

Weights weights_at(double position, int count) noexcept {
    double within = position - count * std::floor(position / count);
    // A position that is not finite, or so large that its digits do not tell the place.
    if (!(within >= 0.0 && within <= count)) {
        within = 0.0;
    }
    const double floor = std::floor(within);
    const double t = within - floor;
    const double s = 1.0 - t;
    Weights weights;
    for (int i = 0; i < 4; ++i) {
        weights.index[static_cast<std::size_t>(i)] =
            wrapped(static_cast<int>(floor) - 1 + i, count);
    }
    weights.value = {s * s * s / 6.0, (4.0 + 3.0 * t * t * (t - 2.0)) / 6.0,
                     (4.0 + 3.0 * s * s * (s - 2.0)) / 6.0, t * t * t / 6.0};
    weights.slope = {-0.5 * s * s, 0.5 * t * (3.0 * t - 4.0), -0.5 * s * (3.0 * s - 4.0),
                     0.5 * t * t};
    return weights;
}

ReliefPoint point_of_level(const ReliefLevel &level, double u, double v) noexcept {
    const double spacings = level.columns; // per tile width, along both directions
    const Weights wu = weights_at(u * spacings, level.columns);
    const Weights wv = weights_at(v * spacings, level.rows);
    ReliefPoint point;
    for (std::size_t i = 0; i < 4; ++i) {
        const float *const row = level.heights.data() + static_cast<std::size_t>(wv.index[i]) *
                                                            static_cast<std::size_t>(level.columns);
        double value = 0.0;
        double slope = 0.0;
        for (std::size_t j = 0; j < 4; ++j) {
            const auto height = static_cast<double>(row[wu.index[j]]);
            value += wu.value[j] * height;
            slope += wu.slope[j] * height;
        }
        point.height += wv.value[i] * value;
        point.slope_u += wv.value[i] * slope * spacings;
        point.slope_v += wv.slope[i] * value * spacings;
    }
    return point;
}

} // namespace

ReliefLevels make_relief_levels(int columns, int rows, std::vector<float> heights) {
    ReliefLevel finest;
    finest.columns = columns;
    finest.rows = rows;
    finest.heights = std::move(heights);
    measure_curvature(finest);
    ReliefLevels levels;
    levels.push_back(std::move(finest));
    // With an odd count, the heights of the coarser copy would not lie on heights of the finer one.
    while (levels.back().columns >= 2 * kFewest && levels.back().rows >= 2 * kFewest &&
           levels.back().columns % 2 == 0 && levels.back().rows % 2 == 0) {
        levels.push_back(halved(levels.back()));
    }
    return levels;
}

ReliefPoint relief_point(const ReliefLevels &levels, double coarseness, double u,
                         double v) noexcept {
    const double last = static_cast<double>(levels.size() - 1);
    const double level = std::clamp(coarseness, 0.0, last);
    const auto finer = static_cast<std::size_t>(level);
    const double share = level - static_cast<double>(finer);
    ReliefPoint point = point_of_level(levels[finer], u, v);
    if (share > 0.0) {
        const ReliefPoint coarser = point_of_level(levels[finer + 1], u, v);
        point.height += share * (coarser.height - point.height);
        point.slope_u += share * (coarser.slope_u - point.slope_u);
        point.slope_v += share * (coarser.slope_v - point.slope_v);
    }
    return point;
}

double relief_coarseness(const ReliefLevels &levels, double spacing, double curvature) noexcept {
    double coarseness = std::max(0.0, std::log2(std::max(spacing, 1e-9) * levels[0].columns));
    for (std::size_t k = 0; k < levels.size() && levels[k].most_curvature > curvature; ++k) {
        // Blended with the next level, the curvature is at most the blend of both.
        const bool is_last = k + 1 == levels.size();
        const double next = is_last ? 0.0 : levels[k + 1].most_curvature;
        const double here = levels[k].most_curvature;
        const double share =
            here > next ? std::clamp((here - curvature) / (here - next), 0.0, 1.0) : 1.0;
        coarseness = std::max(coarseness, static_cast<double>(k) + (is_last ? 0.0 : share));
    }
    return coarseness;
}

} // namespace spidar
