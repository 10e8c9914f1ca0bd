// Path of a string from the frame to the grip: from an eyelet (a point), or around a swiveling
// pulley. Used by kinematics, statics and calibration. No allocation.
#pragma once

#include "core/base/types.h"
#include "core/geometry/frame_geometry.h"

namespace spidar {

// The string from its inlet on the frame to its tie point on the grip.
struct StringPath {
    double length_m = 0.0; // along the string, from the inlet
    // Unit vector of the free part, toward the grip. Zero where both ends meet.
    Vec3 direction{0.0};
    bool on_pulley = false;
};

// radius_m = 0: an eyelet at inlet_m, from which the string runs straight. Otherwise the string
// reaches inlet_m along `axis` (unit vector), outwards from the frame's center. It runs over the
// outer side of a pulley that swivels about `axis` toward the attachment, and leaves along the
// tangent. The derivative of the length with respect to the attachment is exactly `direction`. An
// attachment within the pulley has no tangent: the straight line is returned.
[[nodiscard]] StringPath string_path(const Vec3 &inlet_m, double radius_m, const Vec3 &axis,
                                     const Vec3 &attachment_m) noexcept;

// Returns the path of one string (0-7) of a frame.
[[nodiscard]] StringPath string_path(const FrameGeometry &frame, std::size_t string,
                                     const Vec3 &attachment_m) noexcept;

} // namespace spidar
