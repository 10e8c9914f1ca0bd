#include "core/kinematics/steps/rigid_step.h"

#include <cmath>

#include <glm/geometric.hpp>

namespace spidar {

namespace {

constexpr std::size_t kSize = kRigidDofCount;

} // namespace

void move_rigid(GripPose &pose, const RigidStep &step, double pole_half_length_m) noexcept {
    const double d = pole_half_length_m;
    pose.position_m += Vec3(step[0], step[1], step[2]);
    const Vec3 turn = Vec3(step[3], step[4], step[5]) * (1.0 / d);
    const double angle = glm::length(turn);
    // Rodrigues: sin(angle) / angle and (1 - cos(angle)) / angle^2, defined at 0 too.
    const double half = 0.5 * angle;
    const double sinc_half = half > 0.0 ? std::sin(half) / half : 1.0;
    const double first = sinc_half * std::cos(half);
    const double second = 0.5 * sinc_half * sinc_half;
    const auto turned = [&](const Vec3 &v) {
        const Vec3 c = glm::cross(turn, v);
        return v + first * c + second * glm::cross(turn, c);
    };
    const Vec3 r2 = glm::normalize(turned(pose.r2_m));
    const Vec3 r1 = turned(pose.r1_m);
    pose.r2_m = d * r2;
    pose.r1_m = d * glm::normalize(r1 - r2 * glm::dot(r1, r2));
}

RigidSolution solve_rigid(const LengthProblem &problem, const LengthErrors &errors,
                          const GripPose &pose, const ExpectedPose &expected) noexcept {
    RigidSolution solution;
    const double per_d = 1.0 / problem.grip.pole_half_length_m;
    std::array<RigidStep, kSize> normal{};
    RigidStep right{};
    for (std::size_t i = 0; i < kStringCount; ++i) {
        const Vec3 &e = errors.direction[i];
        const Vec3 turn = per_d * glm::cross(attachment_lever(problem.grip, pose, i), e);
        const RigidStep slope{e.x, e.y, e.z, turn.x, turn.y, turn.z};
        for (std::size_t a = 0; a < kSize; ++a) {
            right[a] += slope[a] * errors.residual_m[i];
            for (std::size_t b = 0; b <= a; ++b) {
                normal[a][b] += slope[a] * slope[b];
            }
        }
    }
    if (expected.weight > 0.0) {
        // Both poles turn by cross(turn, pole) / d.
        const double weight = expected.weight;
        const Vec3 off = expected.pose.position_m - pose.position_m;
        const Vec3 pull = per_d * (glm::cross(pose.r1_m, expected.pose.r1_m) +
                                   glm::cross(pose.r2_m, expected.pose.r2_m));
        const Vec3 n1 = per_d * pose.r1_m;
        const Vec3 n2 = per_d * pose.r2_m;
        for (int a = 0; a < 3; ++a) {
            const auto row = static_cast<std::size_t>(a);
            normal[row][row] += weight;
            normal[3 + row][3 + row] += 2.0 * weight;
            right[row] += weight * off[a];
            right[3 + row] += weight * pull[a];
            for (int b = 0; b <= a; ++b) {
                normal[3 + row][3 + static_cast<std::size_t>(b)] -=
                    weight * (n1[a] * n1[b] + n2[a] * n2[b]);
            }
        }
    }
    // L D L' with the pivots over their diagonals.
    std::array<RigidStep, kSize> l{};
    RigidStep pivots{};
    double smallest = 1.0;
    bool positive = true;
    for (std::size_t i = 0; i < kSize; ++i) {
        for (std::size_t j = 0; j <= i; ++j) {
            double sum = normal[i][j];
            for (std::size_t k = 0; k < j; ++k) {
                sum -= l[i][k] * l[j][k] * pivots[k];
            }
            if (i != j) {
                l[i][j] = sum / pivots[j];
            } else {
                pivots[i] = sum;
                const double scaled = sum / normal[i][i];
                positive = positive && scaled > 0.0;
                smallest = scaled < smallest ? scaled : smallest;
            }
        }
    }
    if (!positive) {
        return solution;
    }
    RigidStep x = right;
    for (std::size_t i = 0; i < kSize; ++i) {
        for (std::size_t k = 0; k < i; ++k) {
            x[i] -= l[i][k] * x[k];
        }
    }
    double size2 = 0.0;
    for (std::size_t i = kSize; i-- > 0;) {
        x[i] /= pivots[i];
        for (std::size_t k = i + 1; k < kSize; ++k) {
            x[i] -= l[k][i] * x[k];
        }
        size2 += x[i] * x[i];
    }
    solution.step = x;
    solution.min_pivot = smallest;
    solution.solvable = std::isfinite(size2);
    return solution;
}

} // namespace spidar
