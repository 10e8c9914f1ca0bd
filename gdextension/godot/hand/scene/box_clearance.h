// A lower bound of the distance between two boxes: the largest separation along the six directions
// of their axes.
#pragma once

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "device/contact/shapes/placement.h"

namespace spidar {

struct TurnedBox {
    Placement at; // the origin is the box's center
    Vec3 half_extents_m{0.0};
};

// Returns a lower bound of the distance between two boxes (unit: m): their largest separation along
// the six axes of the boxes. Negative when they overlap along all six.
[[nodiscard]] inline double clearance(const TurnedBox &a, const TurnedBox &b) noexcept {
    const Mat3 turn = glm::transpose(a.at.rotation) * b.at.rotation;
    const Vec3 apart = b.at.origin_m - a.at.origin_m;
    const Vec3 in_a = glm::abs(glm::transpose(a.at.rotation) * apart);
    const Vec3 in_b = glm::abs(glm::transpose(b.at.rotation) * apart);
    double largest = -1e9;
    for (int i = 0; i < 3; ++i) {
        double reach_a = a.half_extents_m[i];
        double reach_b = b.half_extents_m[i];
        for (int k = 0; k < 3; ++k) {
            reach_a += std::abs(turn[k][i]) * b.half_extents_m[k];
            reach_b += std::abs(turn[i][k]) * a.half_extents_m[k];
        }
        largest = std::max({largest, in_a[i] - reach_a, in_b[i] - reach_b});
    }
    return largest;
}

// Returns the distance (unit: m) between a box and the half space below normal . x = offset_m;
// negative when they overlap.
[[nodiscard]] inline double clearance(const TurnedBox &box, const Vec3 &normal,
                                      double offset_m) noexcept {
    double result = glm::dot(normal, box.at.origin_m) - offset_m;
    for (int i = 0; i < 3; ++i) {
        result -= std::abs(glm::dot(normal, box.at.rotation[i])) * box.half_extents_m[i];
    }
    return result;
}

} // namespace spidar
