// Rotation vector of a rotation matrix.
#pragma once

#include <cmath>

#include <glm/geometric.hpp>

#include "core/types.h"

namespace spidar {

// Axis times angle (unit: rad), for turns below half a turn.
[[nodiscard]] inline Vec3 rotation_log(const Mat3 &turn) noexcept {
    const Vec3 sine(0.5 * (turn[1][2] - turn[2][1]), 0.5 * (turn[2][0] - turn[0][2]),
                    0.5 * (turn[0][1] - turn[1][0]));
    const double s2 = glm::dot(sine, sine);
    // From one servo cycle to the next: the series of asin(s) / s, whose next term is below the last bit.
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

} // namespace spidar
