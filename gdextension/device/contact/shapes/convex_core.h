// Convex shape for closest-point searches: a core with a skin around it. Used in this folder only.
#pragma once

#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/geometric.hpp>

#include "core/base/types.h"

namespace spidar {

enum class CoreKind : std::uint8_t { point, segment, disc, box, cylinder, points };

// A face of a hull: a range of ConvexCore::face_points, counter-clockwise seen from outside.
struct HullFace {
    std::uint32_t first = 0;
    std::uint32_t count = 0;
    Vec3 normal{0.0}; // unit vector, outward
    double offset_m = 0.0;
};

// The core about its own origin. Segment, disc and cylinder have their axis along Y.
struct ConvexCore {
    CoreKind kind = CoreKind::point;
    Vec3 half_m{0.0};           // box
    double radius_m = 0.0;      // disc and cylinder
    double half_height_m = 0.0; // segment and cylinder
    std::vector<Vec3> points;   // hull
    std::vector<HullFace> faces;
    std::vector<Vec3> face_points; // corners of all faces in order
};

// A ConvexCore whose lists belong to another object. Also used for a single triangle.
struct CoreView {
    CoreKind kind = CoreKind::point;
    Vec3 half_m{0.0};
    double radius_m = 0.0;
    double half_height_m = 0.0;
    std::span<const Vec3> points;
    std::span<const HullFace> faces;
    std::span<const Vec3> face_points;
};

[[nodiscard]] inline CoreView view_of(const ConvexCore &core) noexcept {
    return {core.kind,   core.half_m, core.radius_m,   core.half_height_m,
            core.points, core.faces,  core.face_points};
}

// Returns the point of the core that is farthest along `way`, which may have any length, even zero.
[[nodiscard]] inline Vec3 support(const CoreView &core, const Vec3 &way) noexcept {
    switch (core.kind) {
    case CoreKind::point:
        return Vec3(0.0);
    case CoreKind::segment:
        return {0.0, std::copysign(core.half_height_m, way.y), 0.0};
    case CoreKind::box:
        return {std::copysign(core.half_m.x, way.x), std::copysign(core.half_m.y, way.y),
                std::copysign(core.half_m.z, way.z)};
    case CoreKind::disc:
    case CoreKind::cylinder: {
        const double across = std::sqrt(way.x * way.x + way.z * way.z);
        const double y =
            core.kind == CoreKind::disc ? 0.0 : std::copysign(core.half_height_m, way.y);
        if (!(across > 0.0)) {
            return {0.0, y, 0.0};
        }
        const double scale = core.radius_m / across;
        return {scale * way.x, y, scale * way.z};
    }
    case CoreKind::points:
        break;
    }
    const Vec3 *best = core.points.data();
    double farthest = glm::dot(*best, way);
    for (const Vec3 &point : core.points.subspan(1)) {
        const double distance = glm::dot(point, way);
        if (distance > farthest) {
            farthest = distance;
            best = &point;
        }
    }
    return *best;
}

// Computes the bounding box of a rotated core, relative to the core's origin.
inline void bounds_of(const CoreView &core, const Mat3 &rotation, Vec3 &lower_m,
                      Vec3 &upper_m) noexcept {
    const Mat3 back = glm::transpose(rotation);
    for (int axis = 0; axis < 3; ++axis) {
        const Vec3 way = back[axis]; // the axis in the core's frame
        upper_m[axis] = glm::dot(way, support(core, way));
        lower_m[axis] = glm::dot(way, support(core, -way));
    }
}

// Lower bound of the distance from a point in the core's frame to the core (m); 0 for a hull.
[[nodiscard]] inline double distance_to_core(const CoreView &core, const Vec3 &point) noexcept {
    const double above = std::fmax(std::abs(point.y) - core.half_height_m, 0.0);
    switch (core.kind) {
    case CoreKind::point:
        return glm::length(point);
    case CoreKind::segment:
        return glm::length(Vec3(point.x, above, point.z));
    case CoreKind::box:
        return glm::length(glm::max(glm::abs(point) - core.half_m, Vec3(0.0)));
    case CoreKind::disc:
    case CoreKind::cylinder: {
        const double across = std::sqrt(point.x * point.x + point.z * point.z) - core.radius_m;
        return across > 0.0 ? std::sqrt(across * across + above * above) : above;
    }
    case CoreKind::points:
        break;
    }
    return 0.0; // hulls are tested by their bounding box elsewhere
}

// Returns the radius of the smallest ball about the core's origin that contains the core.
[[nodiscard]] inline double reach_of(const CoreView &core) noexcept {
    switch (core.kind) {
    case CoreKind::point:
        return 0.0;
    case CoreKind::segment:
        return core.half_height_m;
    case CoreKind::box:
        return glm::length(core.half_m);
    case CoreKind::disc:
        return core.radius_m;
    case CoreKind::cylinder:
        return std::hypot(core.radius_m, core.half_height_m);
    case CoreKind::points:
        break;
    }
    double reach = 0.0;
    for (const Vec3 &point : core.points) {
        reach = std::max(reach, glm::length(point));
    }
    return reach;
}

} // namespace spidar
