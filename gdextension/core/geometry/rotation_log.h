// Rotation vectors: from a rotation matrix, to a rotation matrix, and between two directions.
#pragma once

#include <cmath>

#include <glm/geometric.hpp>

#include "core/base/types.h"

namespace spidar {

// Returns axis times angle (unit: rad). Requires an angle below pi.
[[nodiscard]] inline Vec3 rotation_log(const Mat3 &turn) noexcept {
    const Vec3 sine(0.5 * (turn[1][2] - turn[2][1]), 0.5 * (turn[2][0] - turn[0][2]),
                    0.5 * (turn[0][1] - turn[1][0]));
    const double s2 = glm::dot(sine, sine);
    // Small turns, as between two servo cycles, use the series of asin(s) / s; the next term is
    // below the last bit.
    constexpr double kShort2 = 2.5e-3;
    if (s2 < kShort2 && turn[0][0] + turn[1][1] + turn[2][2] > 1.0) {
        const double ratio =
            1.0 +
            s2 * (1.0 / 6.0 + s2 * (3.0 / 40.0 + s2 * (5.0 / 112.0 +
                                                       s2 * (35.0 / 1152.0 + s2 * 63.0 / 2816.0))));
        return ratio * sine;
    }
    const double s = std::sqrt(s2);
    const double c = 0.5 * (turn[0][0] + turn[1][1] + turn[2][2] - 1.0);
    constexpr double kSmall = 1e-9; // angle / sine is 1 to double precision below this
    return s > kSmall ? (std::atan2(s, c) / s) * sine : sine;
}

// Inverse of rotation_log(): returns the rotation about `turn` by its length (unit: rad).
[[nodiscard]] inline Mat3 rotation_exp(const Vec3 &turn) noexcept {
    const double angle = glm::length(turn);
    constexpr double kSmall = 1e-9;
    if (!(angle > kSmall)) {
        return Mat3(1.0);
    }
    const Vec3 k = turn / angle;
    const double s = std::sin(angle);
    const double c = 1.0 - std::cos(angle);
    Mat3 result(1.0);
    for (int column = 0; column < 3; ++column) {
        Vec3 unit(0.0);
        unit[column] = 1.0;
        result[column] = unit + s * glm::cross(k, unit) + c * glm::cross(k, glm::cross(k, unit));
    }
    return result;
}

// Returns the shortest rotation vector (unit: rad) that turns `from` into `to`, both unit vectors.
// Zero when they are opposite.
[[nodiscard]] inline Vec3 rotation_between(const Vec3 &from, const Vec3 &to) noexcept {
    const Vec3 axis = glm::cross(from, to);
    const double s = glm::length(axis);
    return s > 0.0 ? (std::atan2(s, glm::dot(from, to)) / s) * axis : Vec3(0.0);
}

} // namespace spidar
