// Where a string leaves the frame: an eyelet (a point), or a swivelling pulley around which it is wound before it runs
// to the grip. Length and direction of either, for kinematics, statics and calibration alike. No allocation.
#pragma once

#include "core/base/types.h"
#include "core/geometry/frame_geometry.h"

namespace spidar {

// From the fixed point of a string to where it is tied.
struct StringPath {
    double length_m = 0.0; // along the string
    Vec3 direction{0.0};   // unit, of the free part, towards the grip; zero where the ends meet
    bool on_pulley = false;
};

// `inlet_m`: where the string comes in. radius 0: an eyelet, from where it leaves straight. Else it runs there along
// `axis` (unit vector), outwards from the frame's centre, over the outer side of a pulley that swivels about the axis
// towards the attachment, and leaves along the tangent. The length counts from the inlet. A taut string lies as short as it
// can, so that the length grows by exactly direction . (movement of the attachment). An attachment within
// the pulley has no tangent: the straight line is used there.
[[nodiscard]] StringPath string_path(const Vec3 &inlet_m, double radius_m, const Vec3 &axis,
                                     const Vec3 &attachment_m) noexcept;

// The same for string i of a frame.
[[nodiscard]] StringPath string_path(const FrameGeometry &frame, std::size_t string,
                                     const Vec3 &attachment_m) noexcept;

} // namespace spidar
