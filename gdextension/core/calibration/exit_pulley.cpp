#include "core/calibration/exit_pulley.h"

#include <cmath>

#include <glm/geometric.hpp>

namespace spidar {

StringArray exit_excess(const FrameGeometry &frame, const GripGeometry &grip,
                        const LengthCorrections &corrections, const GripPose &pose) noexcept {
    constexpr double kPi = 3.141592653589793;
    StringArray excess{};
    const double radius = corrections.pulley_radius_m;
    if (!(radius > 0.0)) {
        return excess;
    }
    for (std::size_t i = 0; i < kStringCount; ++i) {
        const Vec3 line = attachment_point(grip, pose, static_cast<int>(i)) - frame.motors_m[i];
        const double inlet_side = glm::dot(frame.motors_m[i], corrections.swivel_axis);
        // Plane of the pulley: along the axis, outwards from the frame, and across, towards the
        // attachment.
        const double along =
            glm::dot(line, corrections.swivel_axis) * (inlet_side < 0.0 ? -1.0 : 1.0);
        const double across_square = glm::dot(line, line) - along * along;
        const double across = std::sqrt(std::fmax(across_square, 0.0)) - radius; // from its centre
        const double distance = std::hypot(along, across);
        // Around the rim from the inlet to where the tangent to the attachment leaves.
        const double wrapped = kPi - (std::atan2(along, across) + std::acos(radius / distance));
        const double path = radius * wrapped + std::sqrt((distance - radius) * (distance + radius));
        const double more = path - glm::length(line);
        excess[i] = std::isfinite(more) ? more : 0.0;
    }
    return excess;
}

} // namespace spidar
