// Strings that leave the frame over a swivelling pulley instead of through an eyelet: the point
// where they leave moves along the pulley, which at 4 mm of radius costs millimetres of grip
// position unless it is taken into account. Servo-safe: no allocation, noexcept.
#pragma once

#include "core/calibration/length_corrections.h"
#include "core/geometry/frame_geometry.h"
#include "core/geometry/grip_geometry.h"

namespace spidar {

// Path of each string, from its inlet motors_m[i] around the pulley to the attachment, less the
// straight line (unit: m). The string comes in along swivel_axis, from outside; the pulley swivels
// about it towards the attachment. Zero for an eyelet (radius 0) and where the attachment lies
// within the pulley.
//
// Use: lengths as the kinematics want them = measured - exit_excess() at the last pose. In one tick
// the excess changes by about 1 % of the movement; where the pose is not known yet, solve two or
// three times in turn.
[[nodiscard]] StringArray exit_excess(const FrameGeometry &frame, const GripGeometry &grip,
                                      const LengthCorrections &corrections,
                                      const GripPose &pose) noexcept;

} // namespace spidar
