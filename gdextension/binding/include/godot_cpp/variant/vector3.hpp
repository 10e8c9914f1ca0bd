#pragma once

#include <godot_cpp/core/math.hpp>

namespace godot {

struct Vector3 {
    real_t x = 0;
    real_t y = 0;
    real_t z = 0;

    Vector3() {}
    Vector3(real_t p_x, real_t p_y, real_t p_z) : x(p_x), y(p_y), z(p_z) {}

    // axis: 0, 1 or 2.
    real_t &operator[](int axis) { return axis == 0 ? x : (axis == 1 ? y : z); }
    const real_t &operator[](int axis) const { return axis == 0 ? x : (axis == 1 ? y : z); }

    Vector3 operator+(const Vector3 &o) const { return {x + o.x, y + o.y, z + o.z}; }
    Vector3 operator-(const Vector3 &o) const { return {x - o.x, y - o.y, z - o.z}; }
    Vector3 operator*(const Vector3 &o) const { return {x * o.x, y * o.y, z * o.z}; }
    Vector3 operator/(const Vector3 &o) const { return {x / o.x, y / o.y, z / o.z}; }
    Vector3 operator*(real_t s) const { return {x * s, y * s, z * s}; }
    Vector3 operator/(real_t s) const { return {x / s, y / s, z / s}; }
    Vector3 operator-() const { return {-x, -y, -z}; }
    Vector3 &operator+=(const Vector3 &o) { return *this = *this + o; }
    Vector3 &operator-=(const Vector3 &o) { return *this = *this - o; }
    Vector3 &operator*=(real_t s) { return *this = *this * s; }
    Vector3 &operator/=(real_t s) { return *this = *this / s; }
    bool operator==(const Vector3 &o) const { return x == o.x && y == o.y && z == o.z; }
    bool operator!=(const Vector3 &o) const { return !(*this == o); }

    real_t dot(const Vector3 &o) const { return x * o.x + y * o.y + z * o.z; }
    Vector3 cross(const Vector3 &o) const {
        return {y * o.z - z * o.y, z * o.x - x * o.z, x * o.y - y * o.x};
    }
    real_t length_squared() const { return dot(*this); }
    real_t length() const { return std::sqrt(length_squared()); }
    real_t distance_to(const Vector3 &o) const { return (o - *this).length(); }

    // Returns the zero vector for the zero vector.
    Vector3 normalized() const {
        const real_t norm = length();
        return norm == 0 ? Vector3() : *this / norm;
    }
    void normalize() { *this = normalized(); }
    Vector3 abs() const { return {std::abs(x), std::abs(y), std::abs(z)}; }
    Vector3 lerp(const Vector3 &to, real_t weight) const { return *this + (to - *this) * weight; }

    bool is_equal_approx(const Vector3 &o) const {
        return Math::is_equal_approx(x, o.x) && Math::is_equal_approx(y, o.y) &&
               Math::is_equal_approx(z, o.z);
    }
    bool is_zero_approx() const { return is_equal_approx(Vector3()); }
    bool is_finite() const {
        return Math::is_finite(x) && Math::is_finite(y) && Math::is_finite(z);
    }
};

inline Vector3 operator*(real_t s, const Vector3 &v) {
    return v * s;
}

} // namespace godot
