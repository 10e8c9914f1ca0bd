#pragma once

#include <godot_cpp/core/math.hpp>

namespace godot {

struct Vector2 {
    real_t x = 0;
    real_t y = 0;

    Vector2() {}
    Vector2(real_t p_x, real_t p_y) : x(p_x), y(p_y) {}

    Vector2 operator+(const Vector2 &o) const { return {x + o.x, y + o.y}; }
    Vector2 operator-(const Vector2 &o) const { return {x - o.x, y - o.y}; }
    Vector2 operator*(real_t s) const { return {x * s, y * s}; }
    Vector2 operator/(real_t s) const { return {x / s, y / s}; }
    Vector2 operator-() const { return {-x, -y}; }
    bool operator==(const Vector2 &o) const { return x == o.x && y == o.y; }
    bool operator!=(const Vector2 &o) const { return !(*this == o); }

    real_t dot(const Vector2 &o) const { return x * o.x + y * o.y; }
    real_t length_squared() const { return dot(*this); }
    real_t length() const { return std::sqrt(length_squared()); }
    bool is_equal_approx(const Vector2 &o) const {
        return Math::is_equal_approx(x, o.x) && Math::is_equal_approx(y, o.y);
    }
    bool is_finite() const { return Math::is_finite(x) && Math::is_finite(y); }
};

inline Vector2 operator*(real_t s, const Vector2 &v) {
    return v * s;
}

} // namespace godot
