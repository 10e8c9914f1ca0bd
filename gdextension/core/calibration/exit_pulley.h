// Extra string length at exit pulleys. A string that leaves the frame over a swiveling pulley
// leaves from a point that moves along the pulley. At a radius of 4 mm this costs millimeters of
// grip position unless it is corrected. Servo-safe: no allocation, noexcept.
#pragma once

#include "core/calibration/length_corrections.h"
#include "core/geometry/frame_geometry.h"
#include "core/geometry/grip_geometry.h"

namespace spidar {

// Returns, per string, the path from the inlet motors_m[i] around the pulley to the attachment less
// the straight line (unit: m). Pulley radius and swivel axis come from `corrections`. Zero for an
// eyelet (radius 0) and for an attachment within the pulley.
//
// Use: lengths for the kinematics = measured lengths - exit_excess(last pose). From one tick to the
// next the excess changes by about 1 % of the grip's movement, so that the last pose is good
// enough. Without a last pose, solve the pose and compute the excess in turn, two or three times.
[[nodiscard]] StringArray exit_excess(const FrameGeometry &frame, const GripGeometry &grip,
                                      const LengthCorrections &corrections,
                                      const GripPose &pose) noexcept;

} // namespace spidar
