#include "device/contact/shapes/shape_outline.h"

#include <cmath>
#include <cstdint>
#include <numbers>
#include <span>

#include <glm/geometric.hpp>

#include "device/contact/shapes/triangle_source.h"

namespace spidar {

namespace {

constexpr int kSectors = 32; // per circle
constexpr int kGridCells = 8;

// Counts the lines of one shape.
class Lines {
public:
    explicit Lines(std::vector<Vec3> &all) : all_(all), most_(all.size() + 2 * kMostOutlineLines) {}
    void add(const Vec3 &from, const Vec3 &to) {
        if (all_.size() < most_) {
            all_.push_back(from);
            all_.push_back(to);
        }
    }
    // Starts at the angle 0, at `middle + across`.
    void arc(const Vec3 &middle, const Vec3 &across, const Vec3 &up, double angle_rad) {
        const int count =
            static_cast<int>(std::ceil(kSectors * angle_rad / (2.0 * std::numbers::pi)));
        for (int i = 0; i < count; ++i) {
            const auto at = [&](int k) {
                const double angle = angle_rad * k / count;
                return middle + std::cos(angle) * across + std::sin(angle) * up;
            };
            add(at(i), at(i + 1));
        }
    }
    void circle(const Vec3 &middle, const Vec3 &across, const Vec3 &up) {
        arc(middle, across, up, 2.0 * std::numbers::pi);
    }

private:
    std::vector<Vec3> &all_;
    std::size_t most_;
};

struct Ball {
    Vec3 middle{0.0};
    double radius = 0.0;
    // Returns whether the box around the corners meets the ball.
    [[nodiscard]] bool meets(std::span<const Vec3> corners) const {
        Vec3 lower = corners.front();
        Vec3 upper = corners.front();
        for (const Vec3 &corner : corners) {
            lower = glm::min(lower, corner);
            upper = glm::max(upper, corner);
        }
        const Vec3 off = middle - glm::clamp(middle, lower, upper);
        return glm::dot(off, off) <= radius * radius;
    }
};

void add_round(const ShapeDescription &shape, Lines &lines) {
    const double r = shape.radius_m;
    const Vec3 x(r, 0.0, 0.0);
    const Vec3 y(0.0, r, 0.0);
    const Vec3 z(0.0, 0.0, r);
    if (shape.kind == ShapeKind::sphere) {
        lines.circle(Vec3(0.0), x, y);
        lines.circle(Vec3(0.0), y, z);
        lines.circle(Vec3(0.0), z, x);
        return;
    }
    const Vec3 end(0.0, shape.half_height_m, 0.0);
    lines.circle(end, x, z);
    lines.circle(-end, x, z);
    for (const Vec3 &side : {x, z, -x, -z}) {
        lines.add(side - end, side + end);
        if (shape.kind == ShapeKind::capsule) {
            lines.arc(end, side, y, 0.5 * std::numbers::pi);
            lines.arc(-end, side, -y, 0.5 * std::numbers::pi);
        }
    }
}

void add_hull(const ConvexCore &core, const Ball &ball, Lines &lines) {
    const auto before = [](const Vec3 &a, const Vec3 &b) {
        return a.x != b.x ? a.x < b.x : a.y != b.y ? a.y < b.y : a.z < b.z;
    };
    for (const HullFace &face : core.faces) {
        const std::span<const Vec3> corners =
            std::span<const Vec3>(core.face_points).subspan(face.first, face.count);
        if (!ball.meets(corners)) {
            continue;
        }
        for (std::size_t i = 0; i < corners.size(); ++i) {
            const Vec3 &next = corners[(i + 1) % corners.size()];
            if (before(corners[i], next)) { // the neighboring face has the edge in reverse
                lines.add(corners[i], next);
            }
        }
    }
}

void add_triangles(const CookedShape::Data &data, const Ball &ball, Lines &lines) {
    const TriangleSource source(data);
    const auto is_near = [&](std::uint32_t triangle) {
        return ball.meets(source.corners(triangle));
    };
    source.visit_box(ball.middle - ball.radius, ball.middle + ball.radius,
                     [&](std::uint32_t triangle) {
                         if (!is_near(triangle)) {
                             return;
                         }
                         const Corners corners = source.corners(triangle);
                         for (std::size_t edge = 0; edge < corners.size(); ++edge) {
                             const std::uint32_t other = source.neighbour(triangle, edge);
                             if (other == kNone || triangle < other || !is_near(other)) {
                                 lines.add(corners[edge], corners[(edge + 1) % corners.size()]);
                             }
                         }
                     });
}

void add_grid(const ShapeDescription &plane, const Ball &ball, Lines &lines) {
    const double length = glm::length(plane.normal);
    const Vec3 normal = plane.normal / length;
    const double above = glm::dot(normal, ball.middle) - plane.offset_m / length;
    const Vec3 foot = ball.middle - above * normal;
    const Vec3 u = ball.radius * any_across(normal);
    const Vec3 v = glm::cross(normal, u);
    for (int i = 0; i <= kGridCells; ++i) {
        const double at = 2.0 * i / kGridCells - 1.0;
        lines.add(foot + at * u - v, foot + at * u + v);
        lines.add(foot + at * v - u, foot + at * v + u);
    }
}

} // namespace

void add_box_outline(const Vec3 &lower_m, const Vec3 &upper_m, std::vector<Vec3> &lines) {
    for (int axis = 0; axis < 3; ++axis) {
        const int next = (axis + 1) % 3;
        const int last = (axis + 2) % 3;
        for (int corner = 0; corner < 4; ++corner) {
            Vec3 from = lower_m;
            from[next] = (corner & 1) != 0 ? upper_m[next] : lower_m[next];
            from[last] = (corner & 2) != 0 ? upper_m[last] : lower_m[last];
            Vec3 to = from;
            to[axis] = upper_m[axis];
            lines.push_back(from);
            lines.push_back(to);
        }
    }
}

void add_outline(const CookedShape &shape, const Vec3 &ball_m, double ball_radius_m,
                 std::vector<Vec3> &lines) {
    const CookedShape::Data &data = shape.data();
    const Ball ball{ball_m, ball_radius_m};
    Lines counted(lines);
    switch (shape.kind()) {
    case ShapeKind::box:
        add_box_outline(data.lower_m, data.upper_m, lines);
        return;
    case ShapeKind::sphere:
    case ShapeKind::capsule:
    case ShapeKind::cylinder:
        add_round(data.description, counted);
        return;
    case ShapeKind::hull:
        add_hull(data.core, ball, counted);
        return;
    case ShapeKind::mesh:
    case ShapeKind::height_map:
        add_triangles(data, ball, counted);
        return;
    case ShapeKind::half_space:
        add_grid(data.description, ball, counted);
        return;
    case ShapeKind::relief: // has no outline
        return;
    }
}

} // namespace spidar
