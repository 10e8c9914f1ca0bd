#include "device/contact/shapes/edge_distance.h"

#include "device/contact/shapes/gjk.h"

namespace spidar {

namespace {

constexpr double kTouch_m = 1e-8; // below this a normal would be rounding
constexpr double kEnd_m = 1e-9;   // distance to an end of the edge that counts as the end

// Distance from the point from + t * along of an edge to a disc with axis y, in the disc's frame.
struct EdgeOverDisc {
    Vec3 from;
    Vec3 along;
    double radius;

    // Half of the derivative of the squared distance with respect to t.
    [[nodiscard]] double slope(double t) const noexcept {
        const Vec3 x = from + t * along;
        double slope = x.y * along.y;
        const double across2 = x.x * x.x + x.z * x.z;
        if (across2 > radius * radius) {
            const double across = std::sqrt(across2);
            slope += (across - radius) * (x.x * along.x + x.z * along.z) / across;
        }
        return slope;
    }

    // The squared distance is convex in t: its slope has one root.
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
        // Regula falsi by the Illinois rule, with a bisection after each step that did not halve
        // the interval: at the rim the slope may be a thousand times steeper on one side. 10 steps
        // are usual.
        constexpr int kMaxSteps = 80;
        constexpr double kTolerance = 1e-12; // relative to the edge
        const double small = kTolerance * glm::dot(along, along);
        double t = 0.5;
        int side = 0;
        bool bisect = false;
        for (int step = 0; step < kMaxSteps && high - low > kTolerance; ++step) {
            const double width = high - low;
            t = bisect ? 0.5 * (low + high)
                       : (low * high_slope - high * low_slope) / (high_slope - low_slope);
            const double here = slope(t);
            if (std::abs(here) <= small) {
                break;
            }
            if (here > 0.0) {
                high = t;
                high_slope = here;
                low_slope *= side == 1 ? 0.5 : 1.0;
                side = 1;
            } else {
                low = t;
                low_slope = here;
                high_slope *= side == -1 ? 0.5 : 1.0;
                side = -1;
            }
            bisect = !bisect && high - low > 0.5 * width;
        }
        return t;
    }
};

// The parameter t of the point on the edge is known.
EdgeDistance finish(const Vec3 &from, const Vec3 &to, double t, const Vec3 &on_core,
                    double limit_m) noexcept {
    EdgeDistance found;
    found.end = t <= 0.0 ? EdgeDistance::from : t >= 1.0 ? EdgeDistance::to : EdgeDistance::inner;
    found.on_edge = from + t * (to - from);
    found.on_core = on_core;
    const Vec3 apart = found.on_core - found.on_edge;
    const double distance = glm::length(apart);
    found.overlap = distance < kTouch_m;
    found.beyond = distance > limit_m;
    found.normal = apart / distance;
    return found;
}

EdgeDistance from_point(const Vec3 &point, const Vec3 &from, const Vec3 &to,
                        double limit_m) noexcept {
    const Vec3 along = to - from;
    const double t = glm::dot(point - from, along) / glm::dot(along, along);
    return finish(from, to, std::fmin(std::fmax(t, 0.0), 1.0), point, limit_m);
}

EdgeDistance from_disc(const CoreView &disc, const Placement &at, const Vec3 &from, const Vec3 &to,
                       double limit_m) noexcept {
    const Mat3 back = glm::transpose(at.rotation);
    const EdgeOverDisc edge{back * (from - at.origin_m), back * (to - from), disc.radius_m};
    const double t = edge.nearest();
    Vec3 point = edge.from + t * edge.along;
    point.y = 0.0;
    const double across = glm::length(point);
    if (across > disc.radius_m) {
        point *= disc.radius_m / across;
    }
    return finish(from, to, t, at.origin_m + at.rotation * point, limit_m);
}

EdgeDistance from_core(const CoreView &core, const Placement &at, const Vec3 &from, const Vec3 &to,
                       double limit_m) noexcept {
    const std::array<Vec3, 2> ends{from, to};
    CoreView edge;
    edge.kind = CoreKind::points;
    edge.points = ends;
    // GJK starts best from the middle of the edge.
    Vec3 axis = at.origin_m - 0.5 * (from + to);
    const CoreDistance apart = core_distance(core, at, edge, limit_m, axis);
    EdgeDistance found;
    found.beyond = apart.beyond;
    found.overlap = apart.overlap;
    if (found.beyond || found.overlap) {
        return found;
    }
    found.on_core = apart.on_tool_m;
    found.on_edge = apart.on_shape_m;
    found.normal = apart.normal;
    found.end = glm::length(found.on_edge - from) < kEnd_m ? EdgeDistance::from
                : glm::length(found.on_edge - to) < kEnd_m ? EdgeDistance::to
                                                           : EdgeDistance::inner;
    return found;
}

} // namespace

EdgeDistance edge_distance(const CoreView &core, const Placement &core_at, const Vec3 &from,
                           const Vec3 &to, double limit_m) noexcept {
    switch (core.kind) {
    case CoreKind::point:
        return from_point(core_at.origin_m, from, to, limit_m);
    case CoreKind::disc:
        return from_disc(core, core_at, from, to, limit_m);
    default:
        return from_core(core, core_at, from, to, limit_m);
    }
}

} // namespace spidar
