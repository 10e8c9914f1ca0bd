// all_finite() returns true when no number in its arguments is NaN or infinite.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <span>

#include "core/base/types.h"

namespace spidar {

[[nodiscard]] inline bool all_finite(double value) noexcept {
    return std::isfinite(value);
}

[[nodiscard]] inline bool all_finite(const Vec3 &v) noexcept {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

[[nodiscard]] inline bool all_finite(const Mat3 &m) noexcept {
    return all_finite(m[0]) && all_finite(m[1]) && all_finite(m[2]);
}

[[nodiscard]] inline bool all_finite(std::span<const double> values) noexcept {
    for (const double value : values) {
        if (!std::isfinite(value)) {
            return false;
        }
    }
    return true;
}

// Accepts arrays of the types above, and arrays of such arrays.
template <class T, std::size_t kCount>
[[nodiscard]] bool all_finite(const std::array<T, kCount> &values) noexcept {
    for (const T &value : values) {
        if (!all_finite(value)) {
            return false;
        }
    }
    return true;
}

template <class Meaning>
[[nodiscard]] bool all_finite(const SevenDof<Meaning> &row) noexcept {
    return all_finite(row.values);
}

// True when all arguments are finite.
template <class First, class Second, class... Rest>
[[nodiscard]] bool all_finite(const First &first, const Second &second,
                              const Rest &...rest) noexcept {
    return all_finite(first) && all_finite(second) && (all_finite(rest) && ...);
}

[[nodiscard]] inline bool all_finite(const Wrench &wrench) noexcept {
    return all_finite(wrench.force_n, wrench.moment_nm, wrench.grasp_torque_nm);
}

[[nodiscard]] inline bool all_finite(const Twist &twist) noexcept {
    return all_finite(twist.linear_m_s, twist.angular_rad_s, twist.grasp_rate_rad_s);
}

// True for a number above 0 that is not infinite.
[[nodiscard]] inline bool positive_finite(double value) noexcept {
    return value > 0.0 && std::isfinite(value);
}

} // namespace spidar
