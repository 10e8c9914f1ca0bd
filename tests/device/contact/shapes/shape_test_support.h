// What the tests of this room check of every answer.
#pragma once

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

} // namespace spidar::test
