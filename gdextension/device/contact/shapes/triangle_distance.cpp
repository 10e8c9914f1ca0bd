#include "device/contact/shapes/triangle_distance.h"

#include <cmath>
#include <limits>

#include <glm/geometric.hpp>

namespace spidar {

namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr double kTouch_m = 1e-8; // nearer than this, a normal would be rounding
// A foot on the edge of two triangles must be inside one of them: this much outside counts as inside (m).
constexpr double kEdge_m = 1e-9;

TriangleDistance finish(TriangleDistance found) noexcept {
    const Vec3 apart = found.on_core - found.on_triangle;
    found.distance_m = glm::length(apart);
    found.overlap = found.distance_m < kTouch_m;
    if (!found.overlap) {
        found.normal = apart / found.distance_m;
    }
    return found;
}

// The distance of a point x + t * along of an edge to a disc, in the disc's frame: squared, and its derivative by t.
struct EdgeOverDisc {
    Vec3 from; // axis in y
    Vec3 along;
    double radius = 0.0;

    [[nodiscard]] Vec3 at(double t) const noexcept { return from + t * along; }
    [[nodiscard]] double slope(double t) const noexcept {
        const Vec3 x = at(t);
        double slope = x.y * along.y;
        const double across2 = x.x * x.x + x.z * x.z;
        if (across2 > radius * radius) {
            const double across = std::sqrt(across2);
            slope += (across - radius) * (x.x * along.x + x.z * along.z) / across;
        }
        return slope;
    }
    // The squared distance is convex in t: its slope has one zero.
    [[nodiscard]] double nearest() const noexcept {
        double low = 0.0;
        double low_slope = slope(0.0);
        if (low_slope >= 0.0) {
            return 0.0;
        }
        double high = 1.0;
        double high_slope = slope(1.0);
        if (high_slope <= 0.0) {
            return 1.0;
        }
        // Regula falsi by the Illinois rule, to 1e-12 of the edge.
        constexpr int kMaxSteps = 40;
        double t = 0.5;
        int side = 0;
        for (int step = 0; step < kMaxSteps && high - low > 1e-12; ++step) {
            t = (low * high_slope - high * low_slope) / (high_slope - low_slope);
            const double here = slope(t);
            if (std::abs(here) <= 1e-12 * glm::dot(along, along)) {
                break;
            }
            if (here > 0.0) {
                high = t;
                high_slope = here;
                if (side == 1) {
                    low_slope *= 0.5;
                }
                side = 1;
            } else {
                low = t;
                low_slope = here;
                if (side == -1) {
                    high_slope *= 0.5;
                }
                side = -1;
            }
        }
        return t;
    }
};

Vec3 nearest_on_disc(const Vec3 &x, const Vec3 &centre, const Vec3 &axis, double radius) noexcept {
    const Vec3 from = x - centre;
    const Vec3 across = from - glm::dot(from, axis) * axis;
    const double length = glm::length(across);
    return centre + (length > radius ? (radius / length) * across : across);
}

// Where a disc crosses a plane: the middle of the chord, and half of it.
bool chord_meets(const Vec3 &centre, const Vec3 &axis, double radius, const Corners &triangle,
                 const Vec3 &face, double height, double slant) noexcept {
    const Vec3 down = -(face - glm::dot(face, axis) * axis) / slant; // in the disc, unit
    const double to_chord = height / slant;
    const Vec3 middle = centre + to_chord * down;
    const Vec3 along = glm::cross(axis, down);
    const double half = std::sqrt(std::max(0.0, radius * radius - to_chord * to_chord));
    return over_triangle(middle, triangle) || over_triangle(middle + half * along, triangle) ||
           over_triangle(middle - half * along, triangle);
}

} // namespace

TriangleDistance point_to_triangle(const Vec3 &point, const Corners &triangle) noexcept {
    const auto &[a, b, c] = triangle;
    const Vec3 ab = b - a;
    const Vec3 ac = c - a;
    const Vec3 ap = point - a;
    const Vec3 bp = point - b;
    const Vec3 cp = point - c;
    const double d1 = glm::dot(ab, ap);
    const double d2 = glm::dot(ac, ap);
    const double d3 = glm::dot(ab, bp);
    const double d4 = glm::dot(ac, bp);
    const double d5 = glm::dot(ab, cp);
    const double d6 = glm::dot(ac, cp);
    TriangleDistance found;
    found.on_core = point;
    const auto on = [&found](const Vec3 &where, TrianglePart::Kind kind, int number) {
        found.on_triangle = where;
        found.part = {kind, static_cast<std::uint8_t>(number)};
        return finish(found);
    };
    if (d1 <= 0.0 && d2 <= 0.0) {
        return on(a, TrianglePart::corner, 0);
    }
    if (d3 >= 0.0 && d4 <= d3) {
        return on(b, TrianglePart::corner, 1);
    }
    if (d6 >= 0.0 && d5 <= d6) {
        return on(c, TrianglePart::corner, 2);
    }
    const double vc = d1 * d4 - d3 * d2;
    if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) {
        return on(a + (d1 / (d1 - d3)) * ab, TrianglePart::edge, 0);
    }
    const double va = d3 * d6 - d5 * d4;
    if (va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0) {
        return on(b + ((d4 - d3) / ((d4 - d3) + (d5 - d6))) * (c - b), TrianglePart::edge, 1);
    }
    const double vb = d5 * d2 - d1 * d6;
    if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) {
        return on(a + (d2 / (d2 - d6)) * ac, TrianglePart::edge, 2);
    }
    const Vec3 area = glm::cross(ab, ac);
    return on(point - (glm::dot(ap, area) / glm::dot(area, area)) * area, TrianglePart::inside, 0);
}

bool over_triangle(const Vec3 &point, const Corners &triangle) noexcept {
    const Vec3 area = glm::cross(triangle[1] - triangle[0], triangle[2] - triangle[0]);
    const double slack = kEdge_m * glm::length(area);
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec3 edge = triangle[(i + 1) % 3] - triangle[i];
        const double length = std::abs(edge.x) + std::abs(edge.y) + std::abs(edge.z); // at least
        if (glm::dot(glm::cross(edge, point - triangle[i]), area) < -slack * length) {
            return false;
        }
    }
    return true;
}

TriangleDistance disc_to_triangle(const Vec3 &centre, const Vec3 &axis, double radius_m,
                                  const Corners &triangle, const Vec3 &face,
                                  std::uint8_t sharp_edges) noexcept {
    TriangleDistance best;
    best.distance_m = kInfinite;
    const double height = glm::dot(centre - triangle[0], face);
    const Vec3 across = face - glm::dot(face, axis) * axis;
    const double slant = glm::length(across); // sine of the angle between the planes
    const double lowest = height - radius_m * slant;
    if (lowest >= 0.0) {
        // The lowest point of the rim; of a disc that lies flat, its middle.
        const Vec3 point = slant > 1e-9 ? centre - (radius_m / slant) * across : centre;
        if (over_triangle(point, triangle)) {
            best.on_core = point;
            best.on_triangle = point - glm::dot(point - triangle[0], face) * face;
            return finish(best);
        }
    } else if (slant > 1e-9 && chord_meets(centre, axis, radius_m, triangle, face, height, slant)) {
        best.overlap = true;
        return best;
    }
    // The disc's frame: its axis is y.
    const Vec3 helper = std::abs(axis.x) < 0.6 ? Vec3(1.0, 0.0, 0.0) : Vec3(0.0, 1.0, 0.0);
    const Vec3 x_axis = glm::normalize(glm::cross(axis, helper));
    const Vec3 z_axis = glm::cross(x_axis, axis);
    for (std::size_t i = 0; i < 3; ++i) {
        if ((sharp_edges & (1U << i)) == 0) {
            continue;
        }
        const Vec3 from = triangle[i] - centre;
        const Vec3 along = triangle[(i + 1) % 3] - triangle[i];
        const EdgeOverDisc edge{
            {glm::dot(from, x_axis), glm::dot(from, axis), glm::dot(from, z_axis)},
            {glm::dot(along, x_axis), glm::dot(along, axis), glm::dot(along, z_axis)},
            radius_m};
        const double t = edge.nearest();
        TriangleDistance found;
        found.on_triangle = triangle[i] + t * along;
        found.on_core = nearest_on_disc(found.on_triangle, centre, axis, radius_m);
        const bool inner = t > 0.0 && t < 1.0;
        found.part = {inner ? TrianglePart::edge : TrianglePart::corner,
                      static_cast<std::uint8_t>(inner || t <= 0.0 ? i : (i + 1) % 3)};
        found = finish(found);
        if (found.overlap) {
            return found;
        }
        if (found.distance_m < best.distance_m) {
            best = found;
        }
    }
    return best;
}

TrianglePart part_of(const Vec3 &point, const Corners &triangle) noexcept {
    for (std::uint8_t i = 0; i < 3; ++i) {
        if (glm::length(point - triangle[i]) < kTouch_m) {
            return {TrianglePart::corner, i};
        }
    }
    for (std::uint8_t i = 0; i < 3; ++i) {
        const Vec3 edge = glm::normalize(triangle[(i + 1U) % 3] - triangle[i]);
        if (glm::length(glm::cross(edge, point - triangle[i])) < kTouch_m) {
            return {TrianglePart::edge, i};
        }
    }
    return {TrianglePart::inside, 0};
}

} // namespace spidar
