#include "core/kinematics/search/pose_starts.h"

#include <cmath>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

namespace spidar {

namespace {

constexpr double kCos45 = 0.70710678118654752;

// Least-squares position of a point at distances l_i from the motors: |Q_i - P|^2 = l_i^2 minus its
// mean is linear in P.
Vec3 trilaterate(const LengthProblem &problem) noexcept {
    Vec3 mean_motor{0.0};
    double mean_offset = 0.0; // mean of |Q|^2 - l^2
    for (std::size_t i = 0; i < kStringCount; ++i) {
        const Vec3 &q = problem.frame.motors_m[i];
        mean_motor += q * (1.0 / kStringCount);
        mean_offset +=
            (glm::dot(q, q) - problem.lengths_m[i] * problem.lengths_m[i]) / kStringCount;
    }
    Mat3 normal{0.0};
    Vec3 right{0.0};
    for (std::size_t i = 0; i < kStringCount; ++i) {
        const Vec3 &q = problem.frame.motors_m[i];
        const Vec3 arm = q - mean_motor;
        const double offset =
            glm::dot(q, q) - problem.lengths_m[i] * problem.lengths_m[i] - mean_offset;
        normal += glm::outerProduct(arm, arm);
        right += (0.5 * offset) * arm;
    }
    const Vec3 position = glm::inverse(normal) * right;
    const bool finite = std::isfinite(glm::dot(position, position));
    return finite ? position : mean_motor; // motors in a plane
}

Mat3 tilt(int start) noexcept {
    if (start == 0) {
        return Mat3(1.0);
    }
    const int axis = (start - 1) / 2;
    const double s = (start - 1) % 2 == 0 ? kCos45 : -kCos45;
    const int i = (axis + 1) % 3;
    const int j = (axis + 2) % 3;
    Mat3 rotation(1.0);
    rotation[i][i] = kCos45;
    rotation[j][j] = kCos45;
    rotation[i][j] = s;
    rotation[j][i] = -s;
    return rotation;
}

} // namespace

GripPose start_pose(const LengthProblem &problem, int start) noexcept {
    return make_pose(problem.grip, trilaterate(problem), tilt(start), 0.0);
}

} // namespace spidar
