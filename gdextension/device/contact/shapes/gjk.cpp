#include "device/contact/shapes/gjk.h"

#include <array>
#include <limits>

namespace spidar {

namespace {

constexpr int kMaxSteps = 64; // 5 to 20 are usual
// Largest error of the distance (unit: m). On a surface of 1 cm radius this gives normals within
// 1e-4 rad.
constexpr double kTolerance_m = 1e-11;
constexpr double kRelativeTolerance = 1e-13; // rounding of distant corners
// Distance below which cores meet (unit: m): the normal would be rounding.
constexpr double kTouch_m = 1e-8;

// A corner of the difference of both cores, with the points that form it.
struct Corner {
    Vec3 difference{0.0};
    Vec3 on_tool{0.0};
    Vec3 on_shape{0.0};
};

struct Simplex {
    std::array<Corner, 4> corners;
    std::array<double, 4> weights{};
    int count = 0;
};

// The point nearest to the origin on a few corners, with their indices and weights.
struct Nearest {
    std::array<int, 3> places{};
    std::array<double, 3> weights{};
    int count = 0;
    Vec3 point{0.0};
};

Nearest nearest_on_edge(const Simplex &s, int first, int second) noexcept {
    const Vec3 &a = s.corners[static_cast<std::size_t>(first)].difference;
    const Vec3 &b = s.corners[static_cast<std::size_t>(second)].difference;
    const Vec3 edge = b - a;
    const double along = -glm::dot(a, edge);
    const double length2 = glm::dot(edge, edge);
    if (!(along > 0.0)) {
        return {{first}, {1.0}, 1, a};
    }
    if (along >= length2) {
        return {{second}, {1.0}, 1, b};
    }
    const double t = along / length2;
    return {{first, second}, {1.0 - t, t}, 2, a + t * edge};
}

double length2_of(const Nearest &nearest) noexcept {
    return glm::dot(nearest.point, nearest.point);
}

void keep_nearer(Nearest &best, const Nearest &other) noexcept {
    if (length2_of(other) < length2_of(best)) {
        best = other;
    }
}

Nearest nearest_on_triangle(const Simplex &s, int first, int second, int third) noexcept {
    const Vec3 &a = s.corners[static_cast<std::size_t>(first)].difference;
    const Vec3 &b = s.corners[static_cast<std::size_t>(second)].difference;
    const Vec3 &c = s.corners[static_cast<std::size_t>(third)].difference;
    const Vec3 normal = glm::cross(b - a, c - a);
    const double area2 = glm::dot(normal, normal);
    // Weights of the origin's projection onto the plane.
    const double wa = glm::dot(glm::cross(b, c), normal);
    const double wb = glm::dot(glm::cross(c, a), normal);
    const double wc = glm::dot(glm::cross(a, b), normal);
    if (wa > 0.0 && wb > 0.0 && wc > 0.0 && area2 > 0.0) {
        const double sum = wa + wb + wc;
        // From the weights and not from the normal: for a sliver, weights and point then err
        // together.
        const Vec3 foot = (wa * a + wb * b + wc * c) / sum;
        return {{first, second, third}, {wa / sum, wb / sum, wc / sum}, 3, foot};
    }
    Nearest best = nearest_on_edge(s, first, second);
    keep_nearer(best, nearest_on_edge(s, second, third));
    keep_nearer(best, nearest_on_edge(s, third, first));
    return best;
}

// Returns false when the origin is inside.
bool nearest_on_tetrahedron(const Simplex &s, Nearest &best) noexcept {
    constexpr std::array<std::array<int, 4>, 4> kFaces{
        {{0, 1, 2, 3}, {0, 3, 1, 2}, {0, 2, 3, 1}, {1, 3, 2, 0}}}; // the fourth corner lies behind
    bool outside = false;
    for (const auto &face : kFaces) {
        const Vec3 &a = s.corners[static_cast<std::size_t>(face[0])].difference;
        const Vec3 normal = glm::cross(s.corners[static_cast<std::size_t>(face[1])].difference - a,
                                       s.corners[static_cast<std::size_t>(face[2])].difference - a);
        const double origin = -glm::dot(a, normal);
        const double behind =
            glm::dot(s.corners[static_cast<std::size_t>(face[3])].difference - a, normal);
        // A flat tetrahedron has no inside.
        const double flat = 1e-13 * glm::dot(normal, normal);
        if (origin * behind > 0.0 && behind * behind > flat * flat) {
            continue; // the origin is on the inner side
        }
        const Nearest found = nearest_on_triangle(s, face[0], face[1], face[2]);
        if (!outside || length2_of(found) < length2_of(best)) {
            best = found;
        }
        outside = true;
    }
    return outside;
}

bool find_nearest(const Simplex &s, Nearest &best) noexcept {
    switch (s.count) {
    case 1:
        best = {{0}, {1.0}, 1, s.corners[0].difference};
        return true;
    case 2:
        best = nearest_on_edge(s, 0, 1);
        return true;
    case 3:
        best = nearest_on_triangle(s, 0, 1, 2);
        return true;
    default:
        return nearest_on_tetrahedron(s, best);
    }
}

void reduce(Simplex &s, const Nearest &nearest) noexcept {
    Simplex kept;
    kept.count = nearest.count;
    for (int i = 0; i < nearest.count; ++i) {
        const auto place = static_cast<std::size_t>(i);
        kept.corners[place] = s.corners[static_cast<std::size_t>(nearest.places[place])];
        kept.weights[place] = nearest.weights[place];
    }
    s = kept;
}

bool holds(const Simplex &s, const Vec3 &difference) noexcept {
    for (int i = 0; i < s.count; ++i) {
        if (s.corners[static_cast<std::size_t>(i)].difference == difference) {
            return true;
        }
    }
    return false;
}

} // namespace

CoreDistance core_distance(const CoreView &tool, const Placement &tool_at, const CoreView &shape,
                           double limit_m, Vec3 &axis) noexcept {
    const Mat3 back = glm::transpose(tool_at.rotation);
    Vec3 v = glm::dot(axis, axis) > 0.0 ? axis : tool_at.origin_m;
    if (!(glm::dot(v, v) > 0.0)) {
        v = Vec3(0.0, 1.0, 0.0);
    }
    Simplex s;
    double v2 = std::numeric_limits<double>::infinity(); // v is no difference yet
    for (int step = 0; step < kMaxSteps; ++step) {
        Corner corner;
        corner.on_tool = tool_at.origin_m + tool_at.rotation * support(tool, back * -v);
        corner.on_shape = support(shape, v);
        corner.difference = corner.on_tool - corner.on_shape;
        const double length = glm::length(v);
        const double bound = glm::dot(corner.difference, v) / length; // lower bound of the distance
        if (bound > limit_m) {
            axis = v / length;
            return {.beyond = true};
        }
        if (s.count > 0) {
            const double tolerance =
                kTolerance_m + kRelativeTolerance * (length + glm::length(corner.difference));
            if (length - bound <= tolerance || holds(s, corner.difference)) {
                break;
            }
        }
        s.corners[static_cast<std::size_t>(s.count++)] = corner;
        Nearest nearest;
        if (!find_nearest(s, nearest) || length2_of(nearest) < kTouch_m * kTouch_m) {
            return {.overlap = true};
        }
        const double nearest2 = length2_of(nearest);
        if (nearest2 >= v2) { // rounding: no progress
            --s.count;
            break;
        }
        reduce(s, nearest);
        v = nearest.point;
        v2 = nearest2;
    }
    CoreDistance found;
    for (int i = 0; i < s.count; ++i) {
        const auto place = static_cast<std::size_t>(i);
        found.on_tool_m += s.weights[place] * s.corners[place].on_tool;
        found.on_shape_m += s.weights[place] * s.corners[place].on_shape;
    }
    found.distance_m = glm::length(v);
    found.beyond = found.distance_m > limit_m;
    found.normal = v / found.distance_m;
    axis = found.normal;
    return found;
}

} // namespace spidar
