#include "device/contact/shapes/hull_builder.h"

#include <algorithm>
#include <climits>
#include <cmath>
#include <limits>

#include <Jolt/Jolt.h>

#include <Jolt/Geometry/ConvexHullBuilder.h>

namespace spidar {

namespace {

// Size at which hulls are built: Jolt ignores triangles of less than 1e-6.
constexpr double kBuildSize = 100.0;
// Distance to the hull, relative to its size, at which a point lies on it: some roundings of single
// precision.
constexpr double kHullTolerance = 2e-6;

Vec3 middle_of(std::span<const Vec3> points) {
    Vec3 lower(std::numeric_limits<double>::infinity());
    Vec3 upper(-std::numeric_limits<double>::infinity());
    for (const Vec3 &point : points) {
        lower = glm::min(lower, point);
        upper = glm::max(upper, point);
    }
    return 0.5 * (lower + upper);
}

// Returns the mean plane of a polygon (Newell's method).
HullFace face_of(std::span<const Vec3> corners) {
    HullFace face;
    Vec3 area(0.0);
    Vec3 middle(0.0);
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const Vec3 &next = corners[(i + 1) % corners.size()];
        area += glm::cross(corners[i] - corners[0], next - corners[0]);
        middle += corners[i];
    }
    face.normal = glm::normalize(area);
    face.offset_m = glm::dot(face.normal, middle / static_cast<double>(corners.size()));
    return face;
}

} // namespace

bool build_hull(std::span<const Vec3> points, ConvexCore &core) {
    if (points.size() < 4) {
        return false;
    }
    const Vec3 middle = middle_of(points);
    double size = 0.0;
    for (const Vec3 &point : points) {
        size = std::max(size, glm::length(point - middle));
    }
    if (!(size > 0.0) || !std::isfinite(size)) {
        return false;
    }
    const double scale = kBuildSize / size;
    JPH::ConvexHullBuilder::Positions positions;
    positions.reserve(points.size());
    for (const Vec3 &point : points) {
        const Vec3 scaled = scale * (point - middle);
        positions.push_back(JPH::Vec3(static_cast<float>(scaled.x), static_cast<float>(scaled.y),
                                      static_cast<float>(scaled.z)));
    }
    JPH::ConvexHullBuilder builder(positions);
    const char *error = nullptr;
    const auto result =
        builder.Initialize(INT_MAX, static_cast<float>(kHullTolerance * kBuildSize), error);
    if (result != JPH::ConvexHullBuilder::EResult::Success) {
        return false;
    }
    core.kind = CoreKind::points;
    core.points.clear();
    core.faces.clear();
    core.face_points.clear();
    std::vector<bool> used(points.size());
    for (const JPH::ConvexHullBuilder::Face *face : builder.GetFaces()) {
        const auto first = core.face_points.size();
        const JPH::ConvexHullBuilder::Edge *edge = face->mFirstEdge;
        do {
            const auto index = static_cast<std::size_t>(edge->mStartIdx);
            core.face_points.push_back(points[index]);
            if (!used[index]) {
                used[index] = true;
                core.points.push_back(points[index]);
            }
            edge = edge->mNextEdge;
        } while (edge != face->mFirstEdge);
        HullFace made = face_of(std::span(core.face_points).subspan(first));
        made.first = static_cast<std::uint32_t>(first);
        made.count = static_cast<std::uint32_t>(core.face_points.size() - first);
        core.faces.push_back(made);
    }
    return core.faces.size() >= 4; // Jolt gives a flat hull two faces
}

bool shrink_hull(const ConvexCore &hull, double &skin_m, ConvexCore &core) {
    Vec3 middle(0.0);
    for (const Vec3 &point : hull.points) {
        middle += point;
    }
    middle /= static_cast<double>(hull.points.size());
    double inside = std::numeric_limits<double>::infinity();
    for (const HullFace &face : hull.faces) {
        inside = std::min(inside, face.offset_m - glm::dot(face.normal, middle));
    }
    skin_m = std::min(skin_m, 0.5 * inside);
    // The dual: a plane n . x = d becomes the point n / d, and the faces of the dual's hull become
    // the corners.
    std::vector<Vec3> planes;
    planes.reserve(hull.faces.size());
    for (const HullFace &face : hull.faces) {
        const double offset = face.offset_m - glm::dot(face.normal, middle) - skin_m;
        if (!(offset > 0.0)) {
            return false;
        }
        planes.push_back(face.normal / offset);
    }
    ConvexCore dual;
    if (!build_hull(planes, dual)) {
        return false;
    }
    std::vector<Vec3> corners;
    corners.reserve(dual.faces.size());
    for (const HullFace &face : dual.faces) {
        if (!(face.offset_m > 0.0)) {
            return false;
        }
        corners.push_back(middle + face.normal / face.offset_m);
    }
    return build_hull(corners, core);
}

} // namespace spidar
