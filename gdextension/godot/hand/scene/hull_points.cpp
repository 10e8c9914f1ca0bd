#include "godot/hand/scene/hull_points.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

namespace spidar {

namespace {

constexpr int kAround = 32; // chords of a 32-gon are 0.5 % inside their circle
constexpr int kRings = 8;   // from pole to equator
constexpr int kDirections = 1024;

struct OnPlane {
    double u = 0.0;
    double v = 0.0;
    std::uint32_t index = 0;
};

double left_turn(const OnPlane &a, const OnPlane &b, const OnPlane &c) noexcept {
    return (b.u - a.u) * (c.v - a.v) - (b.v - a.v) * (c.u - a.u);
}

// Returns the corners of the hull, counter-clockwise, by Andrew's monotone chain.
std::vector<std::uint32_t> outline(std::vector<OnPlane> points) {
    std::sort(points.begin(), points.end(), [](const OnPlane &a, const OnPlane &b) {
        return a.u != b.u ? a.u < b.u : a.v < b.v;
    });
    std::vector<OnPlane> chain;
    const auto extend = [&chain](const OnPlane &point, std::size_t least) {
        while (chain.size() >= least + 2 &&
               left_turn(chain[chain.size() - 2], chain.back(), point) <= 0.0) {
            chain.pop_back();
        }
        chain.push_back(point);
    };
    for (const OnPlane &point : points) {
        extend(point, 0);
    }
    const std::size_t lower = chain.size() - 1;
    for (auto point = points.rbegin() + 1; point != points.rend(); ++point) {
        extend(*point, lower);
    }
    chain.pop_back(); // the first one again
    std::vector<std::uint32_t> corners;
    for (const OnPlane &point : chain) {
        corners.push_back(point.index);
    }
    return corners;
}

} // namespace

std::vector<Vec3> round_points(double radius, double half_height) {
    std::vector<Vec3> points{{0.0, half_height + radius, 0.0}, {0.0, -half_height - radius, 0.0}};
    for (int ring = 1; ring <= kRings; ++ring) {
        const double from_pole = 0.5 * std::numbers::pi * ring / kRings;
        const double y = half_height + radius * std::cos(from_pole);
        for (const Vec3 &point : rim_points(radius * std::sin(from_pole), y)) {
            points.push_back(point);
        }
    }
    return points;
}

std::vector<Vec3> rim_points(double radius, double half_height) {
    std::vector<Vec3> points;
    for (int i = 0; i < kAround; ++i) {
        const double angle = 2.0 * std::numbers::pi * i / kAround;
        const Vec3 out(radius * std::cos(angle), 0.0, radius * std::sin(angle));
        points.push_back(out + Vec3(0.0, half_height, 0.0));
        points.push_back(out - Vec3(0.0, half_height, 0.0));
    }
    return points;
}

std::vector<Vec3> outermost_points(const std::vector<Vec3> &points_m) {
    std::vector<bool> taken(points_m.size());
    std::vector<Vec3> found;
    for (int i = 0; i < kDirections; ++i) {
        // A golden-angle spiral from pole to pole.
        const double y = 1.0 - (2.0 * i + 1.0) / kDirections;
        const double angle = 2.0 * std::numbers::pi * i / std::numbers::phi;
        const double across = std::sqrt(1.0 - y * y);
        const Vec3 way(across * std::cos(angle), y, across * std::sin(angle));
        const auto farthest = std::max_element(
            points_m.begin(), points_m.end(),
            [&way](const Vec3 &a, const Vec3 &b) { return glm::dot(a, way) < glm::dot(b, way); });
        const auto index = static_cast<std::size_t>(farthest - points_m.begin());
        if (index < points_m.size() && !taken[index]) {
            taken[index] = true;
            found.push_back(*farthest);
        }
    }
    return found;
}

ShapeDescription flat_mesh(const std::vector<Vec3> &points_m) {
    ShapeDescription mesh;
    mesh.kind = ShapeKind::mesh;
    mesh.two_sided = true;
    mesh.points_m = points_m;
    if (points_m.size() < 3) {
        return mesh;
    }
    const Vec3 first = points_m.front();
    Vec3 along(0.0);
    for (const Vec3 &point : points_m) {
        along = glm::length(point - first) > glm::length(along) ? point - first : along;
    }
    Vec3 across(0.0); // the largest part at right angles to it
    for (const Vec3 &point : points_m) {
        const Vec3 way = point - first;
        const Vec3 part = way - (glm::dot(way, along) / glm::dot(along, along)) * along;
        across = glm::length(part) > glm::length(across) ? part : across;
    }
    if (!(glm::length(across) > 0.0)) {
        return mesh;
    }
    std::vector<OnPlane> flat;
    for (std::size_t i = 0; i < points_m.size(); ++i) {
        const Vec3 way = points_m[i] - first;
        flat.push_back({glm::dot(way, along) / glm::length(along),
                        glm::dot(way, across) / glm::length(across),
                        static_cast<std::uint32_t>(i)});
    }
    const std::vector<std::uint32_t> corners = outline(std::move(flat));
    for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
        mesh.indices.insert(mesh.indices.end(), {corners[0], corners[i], corners[i + 1]});
    }
    return mesh;
}

} // namespace spidar
