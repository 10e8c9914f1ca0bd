#include "core/calibration/exit_pulley.h"

#include <glm/geometric.hpp>

#include "core/geometry/string_exit.h"

namespace spidar {

StringArray exit_excess(const FrameGeometry &frame, const GripGeometry &grip,
                        const LengthCorrections &corrections, const GripPose &pose) noexcept {
    StringArray excess{};
    if (!(corrections.pulley_radius_m > 0.0)) {
        return excess;
    }
    for (std::size_t i = 0; i < kStringCount; ++i) {
        const Vec3 end = attachment_point(grip, pose, static_cast<int>(i));
        const StringPath path = string_path(frame.motors_m[i], corrections.pulley_radius_m,
                                            corrections.swivel_axis, end);
        if (path.on_pulley) {
            excess[i] = path.length_m - glm::distance(end, frame.motors_m[i]);
        }
    }
    return excess;
}

} // namespace spidar
