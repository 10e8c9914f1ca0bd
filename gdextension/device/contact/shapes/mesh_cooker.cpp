#include "device/contact/shapes/mesh_cooker.h"

#include <algorithm>
#include <numeric>
#include <tuple>

#include <glm/geometric.hpp>

#include "device/contact/shapes/triangle_source.h"

namespace spidar {

namespace {

// Smallest height of a triangle relative to its longest side: a flatter one has no reliable
// direction.
constexpr double kFlatTriangle = 1e-7;

bool has_area(const Vec3 &a, const Vec3 &b, const Vec3 &c) {
    const double longest2 =
        std::max({glm::dot(b - a, b - a), glm::dot(c - b, c - b), glm::dot(a - c, a - c)});
    return glm::length(glm::cross(b - a, c - a)) > kFlatTriangle * longest2;
}

} // namespace

int weld(ShapeDescription &mesh) {
    const std::vector<Vec3> &points = mesh.points_m;
    std::vector<std::uint32_t> order(points.size());
    std::iota(order.begin(), order.end(), 0U);
    std::sort(order.begin(), order.end(), [&points](std::uint32_t a, std::uint32_t b) {
        return std::tie(points[a].x, points[a].y, points[a].z, a) <
               std::tie(points[b].x, points[b].y, points[b].z, b);
    });
    std::vector<std::uint32_t> place(points.size());
    std::vector<Vec3> kept;
    for (std::size_t i = 0; i < order.size(); ++i) {
        if (i == 0 || points[order[i]] != points[order[i - 1]]) {
            kept.push_back(points[order[i]]);
        }
        place[order[i]] = static_cast<std::uint32_t>(kept.size() - 1);
    }
    std::vector<std::uint32_t> indices;
    indices.reserve(mesh.indices.size());
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
        const std::array<std::uint32_t, 3> corners{
            place[mesh.indices[i]], place[mesh.indices[i + 1]], place[mesh.indices[i + 2]]};
        if (has_area(kept[corners[0]], kept[corners[1]], kept[corners[2]])) {
            indices.insert(indices.end(), corners.begin(), corners.end());
        }
    }
    const auto dropped = static_cast<int>((mesh.indices.size() - indices.size()) / 3);
    mesh.points_m = std::move(kept);
    mesh.indices = std::move(indices);
    return dropped;
}

std::vector<std::array<std::uint32_t, 3>> find_neighbours(std::span<const std::uint32_t> indices) {
    struct Side {
        std::uint32_t low;
        std::uint32_t high;
        std::uint32_t place; // 3 * triangle + edge
        bool operator<(const Side &other) const {
            return std::tie(low, high, place) < std::tie(other.low, other.high, other.place);
        }
    };
    std::vector<Side> sides;
    sides.reserve(indices.size());
    for (std::size_t i = 0; i < indices.size(); ++i) {
        const std::uint32_t from = indices[i];
        const std::uint32_t to = indices[i % 3 == 2 ? i - 2 : i + 1];
        sides.push_back({std::min(from, to), std::max(from, to), static_cast<std::uint32_t>(i)});
    }
    std::sort(sides.begin(), sides.end());
    std::vector<std::array<std::uint32_t, 3>> found(indices.size() / 3, {kNone, kNone, kNone});
    for (std::size_t first = 0; first < sides.size();) {
        std::size_t last = first + 1;
        while (last < sides.size() && sides[last].low == sides[first].low &&
               sides[last].high == sides[first].high) {
            ++last;
        }
        if (last - first == 2) {
            const std::uint32_t a = sides[first].place;
            const std::uint32_t b = sides[first + 1].place;
            found[a / 3][a % 3] = b / 3;
            found[b / 3][b % 3] = a / 3;
        }
        first = last;
    }
    return found;
}

std::vector<std::uint8_t> find_sharp_edges(const TriangleSource &mesh) {
    std::vector<std::uint8_t> found;
    found.reserve(mesh.mesh_triangles());
    for (std::size_t i = 0; i < mesh.mesh_triangles(); ++i) {
        found.push_back(mesh.measure_edges(static_cast<std::uint32_t>(i)));
    }
    return found;
}

} // namespace spidar
