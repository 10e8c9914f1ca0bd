#pragma once

#include <godot_cpp/variant/vector3.hpp>

namespace godot {

// A plane: all points x with normal.dot(x) == d.
struct Plane {
    Vector3 normal;
    real_t d = 0;

    Plane() {}
    Plane(const Vector3 &p_normal, real_t p_d) : normal(p_normal), d(p_d) {}

    bool operator==(const Plane &o) const { return normal == o.normal && d == o.d; }
    bool operator!=(const Plane &o) const { return !(*this == o); }
};

} // namespace godot
