// Local coordinates of a grip pose on R3 x S2 x S2: the displacement of P0, then two tangent
// displacements of each pole's end, all in meters.
#pragma once

#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "core/base/types.h"
#include "core/geometry/grip_geometry.h"

namespace spidar {

using PoseStep = std::array<double, kDofCount>; // x y z, u1 v1, u2 v2 (unit: m)

// Two unit tangents of a pole, orthogonal to it and to each other.
struct Tangents {
    Vec3 u;
    Vec3 v;
};

// Returns two tangents of a pole r, which must not be zero.
[[nodiscard]] inline Tangents tangents_of(const Vec3 &r) noexcept {
    const Vec3 size = glm::abs(r);
    Vec3 axis(0.0, 0.0, 1.0); // the axis with the smallest component of r
    if (size.x <= size.y && size.x <= size.z) {
        axis = Vec3(1.0, 0.0, 0.0);
    } else if (size.y <= size.z) {
        axis = Vec3(0.0, 1.0, 0.0);
    }
    const Vec3 u = glm::normalize(glm::cross(r, axis));
    return {u, glm::normalize(glm::cross(r, u))};
}

struct PoseTangents {
    std::array<Tangents, 2> poles;
};

// Returns r + displacement, scaled back onto the sphere of radius d.
[[nodiscard]] inline Vec3 retract(const Vec3 &r, const Vec3 &displacement, double d) noexcept {
    const Vec3 moved = r + displacement;
    return moved * (d / glm::length(moved));
}

// Applies a step to a pose; the poles stay on their spheres of radius d.
inline void move_pose(GripPose &pose, const PoseTangents &tangents, const PoseStep &step,
                      double d) noexcept {
    pose.position_m += Vec3(step[0], step[1], step[2]);
    pose.r1_m =
        retract(pose.r1_m, step[3] * tangents.poles[0].u + step[4] * tangents.poles[0].v, d);
    pose.r2_m =
        retract(pose.r2_m, step[5] * tangents.poles[1].u + step[6] * tangents.poles[1].v, d);
}

template <std::size_t Size>
[[nodiscard]] double norm(const std::array<double, Size> &v) noexcept {
    double sum = 0.0;
    for (const double x : v) {
        sum += x * x;
    }
    return std::sqrt(sum);
}

[[nodiscard]] inline PoseTangents tangents_of(const GripPose &pose) noexcept {
    return {{tangents_of(pose.r1_m), tangents_of(pose.r2_m)}};
}

} // namespace spidar
