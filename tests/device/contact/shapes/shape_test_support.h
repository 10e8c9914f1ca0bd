// What the tests of this room check of every answer.
#pragma once

#include <algorithm>
#include <cmath>

#include <doctest/doctest.h>

#include "support/shape_samples.h"

namespace spidar::test {

// Nothing remembered.
inline ClosestPoints ask(const ToolShape &tool, const Placement &tool_at, const CookedShape &shape,
                         const Placement &shape_at, double margin_m) {
    auto memory = std::make_unique<PairMemory>();
    ClosestPoints out;
    REQUIRE(closest_points(tool, tool_at, shape, shape_at, margin_m, *memory, out) == Status::ok);
    return out;
}

// Every listed point tells the truth about itself: normal of length 1 from shape to tool, and gap along it.
inline void check_points(const ClosestPoints &found, double margin_m) {
    for (int i = 0; i < found.count; ++i) {
        const ContactPoint &point = found.points[static_cast<std::size_t>(i)];
        CHECK(glm::length(point.normal) == doctest::Approx(1.0).epsilon(1e-12));
        CHECK(std::abs(glm::dot(point.on_tool_m - point.on_shape_m, point.normal) - point.gap_m) <
              1e-12);
        CHECK(point.gap_m <= margin_m + 1e-12);
    }
}

// A flat tool across a block stands on four points, this far off, on the edges at +-half_m along x.
inline void check_stands_on_edges(const ClosestPoints &found, double half_m, double gap_m,
                                  double gap_error_m) {
    REQUIRE(found.count == 4);
    double left = 1.0;
    double right = -1.0;
    for (int i = 0; i < 4; ++i) {
        const ContactPoint &point = found.points[static_cast<std::size_t>(i)];
        CHECK(std::abs(point.gap_m - gap_m) < gap_error_m);
        left = std::min(left, point.on_shape_m.x);
        right = std::max(right, point.on_shape_m.x);
    }
    CHECK(std::abs(left + half_m) < 1e-9);
    CHECK(std::abs(right - half_m) < 1e-9);
}

} // namespace spidar::test
