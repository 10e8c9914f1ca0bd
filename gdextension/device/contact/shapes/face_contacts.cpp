#include "device/contact/shapes/face_contacts.h"

#include <algorithm>
#include <numbers>

namespace spidar {

namespace {

constexpr int kRimCorners = 8;
// Tilt (sine) above which a rim is turned to its lowest point; a flatter one lies as its core does.
constexpr double kFlat = 1e-6;
// Cosine of the slant below which a disc or cap counts as an edge, and above which a round side
// does not.
constexpr double kEdgeOn = 0.1;
constexpr double kSideOn = 0.5;
// Cosine above which two edges count as parallel and touch along a line.
constexpr double kParallel = 0.995;
// Largest sideways offset of two points that face each other, relative to their distance.
constexpr double kMostAside = 0.1;
constexpr double kMinFacing = 0.2; // between a face and the normal (cosine)

CoreFace rim(const CoreView &core, const Vec3 &way, double y) noexcept {
    const double across = std::hypot(way.x, way.z);
    constexpr double kHalf = 0.5 * std::numbers::sqrt2;
    const double cosine = across > kFlat ? way.x / across : kHalf;
    const double sine = across > kFlat ? way.z / across : kHalf;
    constexpr std::array<std::array<double, 2>, kRimCorners> kTurns{{{1.0, 0.0},
                                                                     {kHalf, kHalf},
                                                                     {0.0, 1.0},
                                                                     {-kHalf, kHalf},
                                                                     {-1.0, 0.0},
                                                                     {-kHalf, -kHalf},
                                                                     {0.0, -1.0},
                                                                     {kHalf, -kHalf}}};
    CoreFace face;
    for (const auto &[c, s] : kTurns) {
        face.add(
            {core.radius_m * (c * cosine - s * sine), y, core.radius_m * (c * sine + s * cosine)});
    }
    return face;
}

CoreFace box_face(const CoreView &core, const Vec3 &way) noexcept {
    int axis = 0;
    for (int i = 1; i < 3; ++i) {
        if (std::abs(way[i]) > std::abs(way[axis])) {
            axis = i;
        }
    }
    const int second = (axis + 1) % 3;
    const int third = (axis + 2) % 3;
    constexpr std::array<std::array<double, 2>, 4> kSigns{{{1, 1}, {-1, 1}, {-1, -1}, {1, -1}}};
    CoreFace face;
    for (const auto &signs : kSigns) {
        Vec3 corner(0.0);
        corner[axis] = std::copysign(core.half_m[axis], way[axis]);
        corner[second] = signs[0] * core.half_m[second];
        corner[third] = signs[1] * core.half_m[third];
        face.add(corner);
    }
    face.number = static_cast<std::uint32_t>(2 * axis + (way[axis] < 0.0 ? 1 : 0));
    return face;
}

CoreFace hull_face(const CoreView &core, const Vec3 &way) noexcept {
    CoreFace face;
    std::size_t best = 0;
    for (std::size_t i = 1; i < core.faces.size(); ++i) {
        if (glm::dot(core.faces[i].normal, way) > glm::dot(core.faces[best].normal, way)) {
            best = i;
        }
    }
    const HullFace &found = core.faces[best];
    const std::uint32_t stride = (found.count + kMaxFaceCorners - 1) / kMaxFaceCorners;
    for (std::uint32_t i = 0; i < found.count; i += std::max(1U, stride)) {
        face.add(core.face_points[found.first + i]);
    }
    face.number = static_cast<std::uint32_t>(best);
    return face;
}

// A convex polygon, clipped in place.
struct Polygon { // NOLINT(cppcoreguidelines-pro-type-member-init)
    std::array<Vec3, kMaxFacePairs> corners;
    int count = 0;

    void add(const Vec3 &corner) noexcept {
        if (count < kMaxFacePairs) {
            corners[static_cast<std::size_t>(count++)] = corner;
        }
    }
};

// Keeps the part with outward . x <= offset.
void clip(Polygon &polygon, const Vec3 &outward, double offset) noexcept {
    Polygon kept;
    const int edges = polygon.count == 2 ? 1 : polygon.count;
    for (int i = 0; i < polygon.count; ++i) {
        const Vec3 &from = polygon.corners[static_cast<std::size_t>(i)];
        const Vec3 &to =
            polygon.corners[static_cast<std::size_t>(i + 1 < polygon.count ? i + 1 : 0)];
        const double a = glm::dot(outward, from) - offset;
        const double b = glm::dot(outward, to) - offset;
        if (a <= 0.0) {
            kept.add(from);
        }
        if (i < edges && ((a < 0.0 && b > 0.0) || (a > 0.0 && b < 0.0))) {
            kept.add(from + (a / (a - b)) * (to - from));
        }
    }
    polygon = kept;
}

Vec3 middle_of(const CoreFace &face) noexcept {
    Vec3 sum(0.0);
    for (int i = 0; i < face.count; ++i) {
        sum += face.corners[static_cast<std::size_t>(i)];
    }
    return sum / static_cast<double>(face.count);
}

// Clips by the sides of a face or the ends of an edge, as seen along the normal.
void clip_by(Polygon &polygon, const CoreFace &face, const Vec3 &normal) noexcept {
    if (face.count == 2) {
        const Vec3 along = face.corners[1] - face.corners[0];
        clip(polygon, along, glm::dot(along, face.corners[1]));
        clip(polygon, -along, -glm::dot(along, face.corners[0]));
        return;
    }
    const Vec3 middle = middle_of(face);
    for (int i = 0; i < face.count; ++i) {
        const Vec3 &from = face.corners[static_cast<std::size_t>(i)];
        const Vec3 &to = face.corners[static_cast<std::size_t>(i + 1 < face.count ? i + 1 : 0)];
        Vec3 outward = glm::cross(to - from, normal);
        if (glm::dot(outward, middle - from) > 0.0) {
            outward = -outward;
        }
        clip(polygon, outward, glm::dot(outward, from));
    }
}

Polygon polygon_of(const CoreFace &face) noexcept {
    Polygon polygon;
    for (int i = 0; i < face.count; ++i) {
        polygon.add(face.corners[static_cast<std::size_t>(i)]);
    }
    return polygon;
}

// Returns the unit normal of a face of three or more corners; zero when it has no area.
Vec3 plane_of(const CoreFace &face) noexcept {
    Vec3 area(0.0);
    const auto count = static_cast<std::size_t>(face.count);
    for (std::size_t i = 1; i + 1 < count; ++i) {
        area +=
            glm::cross(face.corners[i] - face.corners[0], face.corners[i + 1] - face.corners[0]);
    }
    const double length = glm::length(area);
    return length > 0.0 ? area / length : Vec3(0.0);
}

} // namespace

CoreFace face_towards(const CoreView &core, const Vec3 &way) noexcept {
    CoreFace face;
    switch (core.kind) {
    case CoreKind::point:
        face.add(Vec3(0.0));
        return face;
    case CoreKind::segment:
        face.add({0.0, -core.half_height_m, 0.0});
        face.add({0.0, core.half_height_m, 0.0});
        return face;
    case CoreKind::box:
        return box_face(core, way);
    case CoreKind::disc:
        if (std::abs(way.y) < kEdgeOn) {
            face.add(support(core, way));
            return face;
        }
        return rim(core, way, 0.0);
    case CoreKind::cylinder: {
        if (std::abs(way.y) < kSideOn) {
            Vec3 foot = support(core, way);
            face.add({foot.x, -core.half_height_m, foot.z});
            face.add({foot.x, core.half_height_m, foot.z});
            face.number = 2;
            return face;
        }
        face = rim(core, way, std::copysign(core.half_height_m, way.y));
        face.number = way.y < 0.0 ? 1 : 0;
        return face;
    }
    case CoreKind::points:
        break;
    }
    return hull_face(core, way);
}

CoreFace face_towards(const CoreView &core, const Placement &at, const Vec3 &way) noexcept {
    CoreFace face = face_towards(core, glm::transpose(at.rotation) * way);
    for (int i = 0; i < face.count; ++i) {
        Vec3 &corner = face.corners[static_cast<std::size_t>(i)];
        corner = at.origin_m + at.rotation * corner;
    }
    return face;
}

FacePairs overlap_of(const CoreFace &tool, const CoreFace &shape, const Vec3 &normal) noexcept {
    FacePairs found;
    if (tool.count < 2 || shape.count < 2) {
        return found;
    }
    const bool line_on_face = shape.count == 2 && tool.count > 2;
    const CoreFace &clipped = line_on_face ? shape : tool;
    const CoreFace &other = line_on_face ? tool : shape;
    Polygon polygon = polygon_of(clipped);
    Vec3 plane(0.0);
    Vec3 along(0.0);
    if (other.count == 2) {
        along = glm::normalize(other.corners[1] - other.corners[0]);
        const Vec3 mine = glm::normalize(clipped.corners[1] - clipped.corners[0]);
        if (!(std::abs(glm::dot(along, mine)) > kParallel)) {
            return found;
        }
    } else {
        plane = plane_of(other);
        if (!(std::abs(glm::dot(plane, normal)) > kMinFacing)) {
            return found;
        }
    }
    clip_by(polygon, other, normal);
    for (int i = 0; i < polygon.count && found.count < kMaxFacePairs; ++i) {
        const Vec3 &mine = polygon.corners[static_cast<std::size_t>(i)];
        const Vec3 from = mine - other.corners[0];
        const Vec3 facing = other.count == 2
                                ? other.corners[0] + glm::dot(from, along) * along
                                : mine - (glm::dot(from, plane) / glm::dot(plane, normal)) * normal;
        // Two edges that are not quite parallel face each other only where they cross.
        const Vec3 apart = mine - facing;
        const Vec3 aside = apart - glm::dot(apart, normal) * normal;
        if (glm::dot(aside, aside) > kMostAside * kMostAside * glm::dot(apart, apart)) {
            continue;
        }
        found.pairs[static_cast<std::size_t>(found.count++)] =
            line_on_face ? FacePair{facing, mine} : FacePair{mine, facing};
    }
    return found;
}

} // namespace spidar
