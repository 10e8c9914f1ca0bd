#include "core/geometry/string_exit.h"

#include <cmath>

#include <glm/geometric.hpp>

namespace spidar {

namespace {

constexpr double kPi = 3.141592653589793;

StringPath straight(const Vec3 &line) noexcept {
    StringPath path;
    path.length_m = glm::length(line);
    if (path.length_m > 0.0) {
        path.direction = line * (1.0 / path.length_m);
    }
    return path;
}

} // namespace

StringPath string_path(const Vec3 &inlet_m, double radius_m, const Vec3 &axis,
                       const Vec3 &attachment_m) noexcept {
    const Vec3 line = attachment_m - inlet_m;
    if (!(radius_m > 0.0)) {
        return straight(line);
    }
    // The pulley's plane is spanned by the axis, outwards from the frame, and the direction across
    // towards the attachment.
    const Vec3 outwards = glm::dot(inlet_m, axis) < 0.0 ? -axis : axis;
    const double along = glm::dot(line, outwards);
    const Vec3 aside = line - along * outwards;
    const double reach = glm::length(aside);
    const double across = reach - radius_m; // from the pulley's center
    const double distance = std::hypot(along, across);
    if (!(distance > radius_m) || !(reach > 0.0)) {
        return straight(line);
    }
    // The string follows the rim from the inlet to the point where the tangent to the attachment
    // leaves.
    const double bearing = std::atan2(along, across);
    const double corner = std::acos(radius_m / distance);
    const double leaves = bearing + corner; // angle of the tangent point, seen from the center
    StringPath path;
    path.length_m =
        radius_m * (kPi - leaves) + std::sqrt((distance - radius_m) * (distance + radius_m));
    path.direction = (std::sin(leaves) * (1.0 / reach)) * aside - std::cos(leaves) * outwards;
    path.on_pulley = true;
    return path;
}

StringPath string_path(const FrameGeometry &frame, std::size_t string,
                       const Vec3 &attachment_m) noexcept {
    return string_path(frame.motors_m[string], frame.pulley_radius_m, frame.pulley_axis,
                       attachment_m);
}

} // namespace spidar
