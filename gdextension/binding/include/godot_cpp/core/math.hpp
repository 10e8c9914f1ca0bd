#pragma once

#include <godot_cpp/core/defs.hpp>

#include <cmath>

namespace godot::Math {

// Uses the engine's tolerance: 1e-5, times |a| if that is above 1.
inline bool is_equal_approx(float a, float b) {
    constexpr float kTolerance = 0.00001F;
    if (a == b) { // also equal infinities
        return true;
    }
    return std::abs(a - b) < kTolerance * std::fmax(1.0F, std::abs(a));
}

inline bool is_zero_approx(float value) {
    return is_equal_approx(value, 0.0F);
}

inline bool is_finite(float value) {
    return std::isfinite(value);
}

inline bool is_finite(double value) {
    return std::isfinite(value);
}

inline double deg_to_rad(double degrees) {
    return degrees * (3.14159265358979323846 / 180.0);
}

inline float deg_to_rad(float degrees) {
    return static_cast<float>(deg_to_rad(static_cast<double>(degrees)));
}

inline double rad_to_deg(double radians) {
    return radians * (180.0 / 3.14159265358979323846);
}

inline float rad_to_deg(float radians) {
    return static_cast<float>(rad_to_deg(static_cast<double>(radians)));
}

} // namespace godot::Math
