#include "bench/methods/dense_gauss_newton.h"

#include <cmath>

#include <glm/geometric.hpp>

#include "core/geometry/pose_tangents.h"

namespace spidar::bench {

namespace {

constexpr std::size_t kUnknowns = kDofCount;
using Square = std::array<std::array<double, kUnknowns>, kUnknowns>;

PoseStep cholesky_solve(Square a, PoseStep x) {
    for (std::size_t j = 0; j < kUnknowns; ++j) {
        for (std::size_t k = 0; k < j; ++k) {
            for (std::size_t i = j; i < kUnknowns; ++i) {
                a[i][j] -= a[i][k] * a[j][k];
            }
        }
        const double root = std::sqrt(a[j][j]);
        for (std::size_t i = j; i < kUnknowns; ++i) {
            a[i][j] /= root;
        }
    }
    for (std::size_t i = 0; i < kUnknowns; ++i) {
        for (std::size_t k = 0; k < i; ++k) {
            x[i] -= a[i][k] * x[k];
        }
        x[i] /= a[i][i];
    }
    for (std::size_t i = kUnknowns; i-- > 0;) {
        for (std::size_t k = i + 1; k < kUnknowns; ++k) {
            x[i] -= a[k][i] * x[k];
        }
        x[i] /= a[i][i];
    }
    return x;
}

} // namespace

void DenseGaussNewton::update(const StringArray &lengths_m) {
    for (int step = 0; step < steps; ++step) {
        const PoseTangents tangents = tangents_of(pose);
        std::array<PoseStep, kStringCount> jacobian{};
        StringArray residual{};
        for (std::size_t i = 0; i < kStringCount; ++i) {
            const Attachment &tie = grip.attachments[i];
            const auto pole = static_cast<std::size_t>(tie.pole);
            const Vec3 string =
                attachment_point(grip, pose, static_cast<int>(i)) - frame.motors_m[i];
            const double length = glm::length(string);
            const Vec3 e = string / length;
            residual[i] = lengths_m[i] - length;
            jacobian[i] = {e.x, e.y, e.z};
            jacobian[i][3 + 2 * pole] = tie.sign * glm::dot(e, tangents.poles[pole].u);
            jacobian[i][4 + 2 * pole] = tie.sign * glm::dot(e, tangents.poles[pole].v);
        }
        Square normal{};
        PoseStep right{};
        for (std::size_t a = 0; a < kUnknowns; ++a) {
            for (std::size_t b = 0; b < kUnknowns; ++b) {
                for (std::size_t i = 0; i < kStringCount; ++i) {
                    normal[a][b] += jacobian[i][a] * jacobian[i][b];
                }
            }
            normal[a][a] += damping;
            for (std::size_t i = 0; i < kStringCount; ++i) {
                right[a] += jacobian[i][a] * residual[i];
            }
        }
        move_pose(pose, tangents, cholesky_solve(normal, right), grip.pole_half_length_m);
    }
}

} // namespace spidar::bench
