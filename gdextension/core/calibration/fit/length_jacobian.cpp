#include "core/calibration/fit/length_jacobian.h"

#include <cmath>

#include <glm/geometric.hpp>

#include "core/geometry/pose_tangents.h"

namespace spidar {

namespace {

// Inverse iteration gains a factor (sigma6 / sigma7)^2 per step. Where both are close, the answer
// is close too.
constexpr int kInverseIterations = 4;
// Share of the largest pivot below which a pivot is rounding.
constexpr double kVanishingPivot = 1e-13;

double dot(const StringArray &a, const StringArray &b) noexcept {
    double sum = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        sum += a[i] * b[i];
    }
    return sum;
}

} // namespace

LengthJacobian::LengthJacobian(const FrameGeometry &frame, const GripGeometry &grip,
                               const GripPose &pose) noexcept {
    const PoseTangents tangents = tangents_of(pose);
    std::array<StringArray, kDofCount> columns{};
    for (std::size_t i = 0; i < kStringCount; ++i) {
        const Attachment &tie = grip.attachments[i];
        const Vec3 lever = tie.sign * (tie.pole == 0 ? pose.r1_m : pose.r2_m);
        const Vec3 line = (pose.position_m + lever) - frame.motors_m[i];
        lengths_m_[i] = glm::length(line);
        directions_[i] = lengths_m_[i] > 0.0 ? line / lengths_m_[i] : Vec3(0.0);
        const Vec3 &e = directions_[i];
        const auto pole = static_cast<std::size_t>(tie.pole);
        columns[0][i] = e.x;
        columns[1][i] = e.y;
        columns[2][i] = e.z;
        columns[3 + 2 * pole][i] = tie.sign * glm::dot(e, tangents.poles[pole].u);
        columns[4 + 2 * pole][i] = tie.sign * glm::dot(e, tangents.poles[pole].v);
    }
    factorise(columns);
}

void LengthJacobian::factorise(std::array<StringArray, kDofCount> columns) noexcept {
    // Reflectors: H_6 ... H_0 J = [R; 0]. Q's columns are H_0 ... H_6 e_k; its eighth is the null
    // vector.
    std::array<StringArray, kDofCount> reflectors{};
    double largest = 0.0;
    double smallest_pivot = HUGE_VAL;
    for (std::size_t k = 0; k < kDofCount; ++k) {
        double square = 0.0;
        for (std::size_t i = k; i < kStringCount; ++i) {
            square += columns[k][i] * columns[k][i];
        }
        const double norm = std::sqrt(square);
        const double alpha = columns[k][k] > 0.0 ? -norm : norm;
        StringArray &v = reflectors[k];
        for (std::size_t i = k; i < kStringCount; ++i) {
            v[i] = columns[k][i];
        }
        v[k] -= alpha;
        const double size = dot(v, v);
        const double scale = size > 0.0 ? std::sqrt(2.0 / size) : 0.0; // H = I - v v^T
        for (double &x : v) {
            x *= scale;
        }
        for (std::size_t j = k; j < kDofCount; ++j) {
            const double along = dot(v, columns[j]);
            for (std::size_t i = k; i < kStringCount; ++i) {
                columns[j][i] -= along * v[i];
            }
        }
        for (std::size_t j = k; j < kDofCount; ++j) {
            r_[k][j] = columns[j][k];
        }
        largest = std::fmax(largest, norm);
        smallest_pivot = norm < smallest_pivot ? norm : smallest_pivot;
    }
    const auto column_of_q = [&](std::size_t k) {
        StringArray q{};
        q[k] = 1.0;
        for (std::size_t j = kDofCount; j-- > 0;) {
            const double along = dot(reflectors[j], q);
            for (std::size_t i = 0; i < kStringCount; ++i) {
                q[i] -= along * reflectors[j][i];
            }
        }
        return q;
    };
    for (std::size_t k = 0; k < kDofCount; ++k) {
        q_[k] = column_of_q(k);
    }
    null_ = column_of_q(kDofCount);

    if (!(smallest_pivot > kVanishingPivot * largest)) {
        return; // singular, or not finite
    }
    // |R^-1| by power iteration on (R^T R)^-1.
    PoseStep x;
    x.fill(1.0 / std::sqrt(static_cast<double>(kDofCount)));
    double growth = 0.0;
    for (int step = 0; step < kInverseIterations; ++step) {
        for (std::size_t i = 0; i < kDofCount; ++i) { // R^T y = x
            for (std::size_t j = 0; j < i; ++j) {
                x[i] -= r_[j][i] * x[j];
            }
            x[i] /= r_[i][i];
        }
        for (std::size_t i = kDofCount; i-- > 0;) { // R z = y
            for (std::size_t j = i + 1; j < kDofCount; ++j) {
                x[i] -= r_[i][j] * x[j];
            }
            x[i] /= r_[i][i];
        }
        growth = norm(x);
        for (double &value : x) {
            value /= growth;
        }
    }
    const double sigma = 1.0 / std::sqrt(growth);
    smallest_ = std::isfinite(sigma) ? sigma : 0.0;
}

double LengthJacobian::parity_m(const StringArray &measured_m) const noexcept {
    double sum = 0.0;
    for (std::size_t i = 0; i < kStringCount; ++i) {
        sum += null_[i] * (measured_m[i] - lengths_m_[i]);
    }
    return sum;
}

PoseStep LengthJacobian::motion(const StringArray &length_change_m) const noexcept {
    PoseStep x{};
    if (!(smallest_ > 0.0)) {
        return x;
    }
    for (std::size_t i = kDofCount; i-- > 0;) {
        x[i] = dot(q_[i], length_change_m);
        for (std::size_t j = i + 1; j < kDofCount; ++j) {
            x[i] -= r_[i][j] * x[j];
        }
        x[i] /= r_[i][i];
    }
    return x;
}

} // namespace spidar
