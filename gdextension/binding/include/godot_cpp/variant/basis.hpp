#pragma once

#include <godot_cpp/variant/quaternion.hpp>

namespace godot {

// A 3x3 matrix, stored by rows as in the engine. Its columns are the images of the three axes.
struct Basis {
    Vector3 rows[3] = {Vector3(1, 0, 0), Vector3(0, 1, 0), Vector3(0, 0, 1)};

    Basis() {}
    // Takes the three columns.
    Basis(const Vector3 &x_axis, const Vector3 &y_axis, const Vector3 &z_axis)
        : rows{Vector3(x_axis.x, y_axis.x, z_axis.x), Vector3(x_axis.y, y_axis.y, z_axis.y),
               Vector3(x_axis.z, y_axis.z, z_axis.z)} {}
    // Makes the rotation matrix of q / |q|.
    Basis(const Quaternion &q) {
        const real_t s = 2 / q.length_squared();
        const real_t x = q.x * s;
        const real_t y = q.y * s;
        const real_t z = q.z * s;
        rows[0] = Vector3(1 - (q.y * y + q.z * z), q.x * y - q.w * z, q.x * z + q.w * y);
        rows[1] = Vector3(q.x * y + q.w * z, 1 - (q.x * x + q.z * z), q.y * z - q.w * x);
        rows[2] = Vector3(q.x * z - q.w * y, q.y * z + q.w * x, 1 - (q.x * x + q.y * y));
    }
    // axis: of any length above 0. angle: in rad.
    Basis(const Vector3 &axis, real_t angle) : Basis(Quaternion(axis, angle)) {}

    Vector3 &operator[](int row) { return rows[row]; }
    const Vector3 &operator[](int row) const { return rows[row]; }
    Vector3 get_column(int i) const { return {rows[0][i], rows[1][i], rows[2][i]}; }
    void set_column(int i, const Vector3 &value) {
        rows[0][i] = value.x;
        rows[1][i] = value.y;
        rows[2][i] = value.z;
    }

    Vector3 xform(const Vector3 &v) const {
        return {rows[0].dot(v), rows[1].dot(v), rows[2].dot(v)};
    }
    // Multiplies by the transpose, which is the inverse for a rotation matrix only.
    Vector3 xform_inv(const Vector3 &v) const {
        return rows[0] * v.x + rows[1] * v.y + rows[2] * v.z;
    }
    Basis transposed() const { return {rows[0], rows[1], rows[2]}; }
    Basis operator*(const Basis &o) const {
        return {xform(o.get_column(0)), xform(o.get_column(1)), xform(o.get_column(2))};
    }
    real_t determinant() const { return rows[0].dot(rows[1].cross(rows[2])); }
    // The result is not finite for a singular matrix.
    Basis inverse() const {
        const real_t s = 1 / determinant();
        return {rows[1].cross(rows[2]) * s, rows[2].cross(rows[0]) * s, rows[0].cross(rows[1]) * s};
    }
    // Gram-Schmidt on the columns, x first.
    Basis orthonormalized() const {
        const Vector3 x = get_column(0).normalized();
        const Vector3 b = get_column(1);
        const Vector3 y = (b - x * x.dot(b)).normalized();
        const Vector3 c = get_column(2);
        return {x, y, (c - x * x.dot(c) - y * y.dot(c)).normalized()};
    }
    void orthonormalize() { *this = orthonormalized(); }
    // Returns the lengths of the columns, all with the sign of the determinant.
    Vector3 get_scale() const {
        const real_t sign = determinant() < 0 ? real_t(-1) : real_t(1);
        return Vector3(get_column(0).length(), get_column(1).length(), get_column(2).length()) *
               sign;
    }
    // Requires a rotation matrix.
    Quaternion get_quaternion() const;
    // Returns the rotation without scale, shear and reflection.
    Quaternion get_rotation_quaternion() const {
        Basis m = orthonormalized();
        if (m.determinant() < 0) {
            m = Basis(-m.get_column(0), -m.get_column(1), -m.get_column(2));
        }
        return m.get_quaternion();
    }

    bool operator==(const Basis &o) const {
        return rows[0] == o.rows[0] && rows[1] == o.rows[1] && rows[2] == o.rows[2];
    }
    bool operator!=(const Basis &o) const { return !(*this == o); }
    bool is_equal_approx(const Basis &o) const {
        return rows[0].is_equal_approx(o.rows[0]) && rows[1].is_equal_approx(o.rows[1]) &&
               rows[2].is_equal_approx(o.rows[2]);
    }
    bool is_finite() const {
        return rows[0].is_finite() && rows[1].is_finite() && rows[2].is_finite();
    }
};

inline Quaternion Basis::get_quaternion() const {
    // Shepperd's method: in each branch one component is at least 1 before normalized(), so that
    // the division is safe.
    const real_t xx = rows[0][0];
    const real_t yy = rows[1][1];
    const real_t zz = rows[2][2];
    Quaternion q;
    if (xx + yy + zz > 0) {
        q = Quaternion(rows[2][1] - rows[1][2], rows[0][2] - rows[2][0], rows[1][0] - rows[0][1],
                       1 + xx + yy + zz);
    } else if (xx >= yy && xx >= zz) {
        q = Quaternion(1 + xx - yy - zz, rows[0][1] + rows[1][0], rows[0][2] + rows[2][0],
                       rows[2][1] - rows[1][2]);
    } else if (yy >= zz) {
        q = Quaternion(rows[0][1] + rows[1][0], 1 - xx + yy - zz, rows[1][2] + rows[2][1],
                       rows[0][2] - rows[2][0]);
    } else {
        q = Quaternion(rows[0][2] + rows[2][0], rows[1][2] + rows[2][1], 1 - xx - yy + zz,
                       rows[1][0] - rows[0][1]);
    }
    return q.normalized();
}

} // namespace godot
