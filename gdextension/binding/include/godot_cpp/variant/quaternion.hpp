#pragma once

#include <godot_cpp/variant/vector3.hpp>

#include <algorithm>

namespace godot {

struct Quaternion {
    real_t x = 0;
    real_t y = 0;
    real_t z = 0;
    real_t w = 1;

    Quaternion() {}
    Quaternion(real_t p_x, real_t p_y, real_t p_z, real_t p_w) : x(p_x), y(p_y), z(p_z), w(p_w) {}
    // axis: of any length above 0. angle: in rad.
    Quaternion(const Vector3 &axis, real_t angle) {
        const Vector3 v = axis.normalized() * std::sin(angle / 2);
        *this = Quaternion(v.x, v.y, v.z, std::cos(angle / 2));
    }

    // Hamilton product: the rotation of the right factor is applied first.
    Quaternion operator*(const Quaternion &o) const {
        return {w * o.x + x * o.w + y * o.z - z * o.y, w * o.y + y * o.w + z * o.x - x * o.z,
                w * o.z + z * o.w + x * o.y - y * o.x, w * o.w - x * o.x - y * o.y - z * o.z};
    }
    Quaternion operator+(const Quaternion &o) const { return {x + o.x, y + o.y, z + o.z, w + o.w}; }
    Quaternion operator-(const Quaternion &o) const { return {x - o.x, y - o.y, z - o.z, w - o.w}; }
    Quaternion operator-() const { return {-x, -y, -z, -w}; }
    Quaternion operator*(real_t s) const { return {x * s, y * s, z * s, w * s}; }
    Quaternion operator/(real_t s) const { return {x / s, y / s, z / s, w / s}; }
    bool operator==(const Quaternion &o) const {
        return x == o.x && y == o.y && z == o.z && w == o.w;
    }
    bool operator!=(const Quaternion &o) const { return !(*this == o); }

    real_t dot(const Quaternion &o) const { return x * o.x + y * o.y + z * o.z + w * o.w; }
    real_t length_squared() const { return dot(*this); }
    real_t length() const { return std::sqrt(length_squared()); }
    Quaternion normalized() const { return *this / length(); }
    // Requires a unit quaternion.
    Quaternion inverse() const { return {-x, -y, -z, w}; }
    Vector3 xform(const Vector3 &v) const {
        const Vector3 u(x, y, z);
        const Vector3 uv = u.cross(v);
        return v + (uv * w + u.cross(uv)) * real_t(2);
    }
    real_t get_angle() const { return 2 * std::acos(std::clamp(w, real_t(-1), real_t(1))); }
    // Requires two unit quaternions. Returns an angle from 0 to pi (unit: rad).
    real_t angle_to(const Quaternion &o) const {
        const real_t cosine = dot(o);
        return std::acos(std::clamp(2 * cosine * cosine - 1, real_t(-1), real_t(1)));
    }
    bool is_equal_approx(const Quaternion &o) const {
        return Math::is_equal_approx(x, o.x) && Math::is_equal_approx(y, o.y) &&
               Math::is_equal_approx(z, o.z) && Math::is_equal_approx(w, o.w);
    }
    bool is_finite() const {
        return Math::is_finite(x) && Math::is_finite(y) && Math::is_finite(z) && Math::is_finite(w);
    }
};

} // namespace godot
