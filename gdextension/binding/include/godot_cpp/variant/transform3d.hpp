#pragma once

#include <godot_cpp/variant/basis.hpp>

namespace godot {

struct Transform3D {
    Basis basis;
    Vector3 origin;

    Transform3D() {}
    Transform3D(const Basis &p_basis, const Vector3 &p_origin = Vector3())
        : basis(p_basis), origin(p_origin) {}

    Vector3 xform(const Vector3 &v) const { return basis.xform(v) + origin; }
    // This and inverse() are right for a rotated basis only. For a scaled or sheared basis use
    // affine_inverse().
    Vector3 xform_inv(const Vector3 &v) const { return basis.xform_inv(v - origin); }
    Transform3D operator*(const Transform3D &o) const { return {basis * o.basis, xform(o.origin)}; }
    Transform3D inverse() const {
        const Basis back = basis.transposed();
        return {back, -back.xform(origin)};
    }
    Transform3D affine_inverse() const {
        const Basis back = basis.inverse();
        return {back, -back.xform(origin)};
    }
    Transform3D orthonormalized() const { return {basis.orthonormalized(), origin}; }

    Basis get_basis() const { return basis; }
    void set_basis(const Basis &value) { basis = value; }
    Vector3 get_origin() const { return origin; }
    void set_origin(const Vector3 &value) { origin = value; }

    bool operator==(const Transform3D &o) const { return basis == o.basis && origin == o.origin; }
    bool operator!=(const Transform3D &o) const { return !(*this == o); }
    bool is_equal_approx(const Transform3D &o) const {
        return basis.is_equal_approx(o.basis) && origin.is_equal_approx(o.origin);
    }
    bool is_finite() const { return basis.is_finite() && origin.is_finite(); }
};

} // namespace godot
