// The frame that carries the motors: where each string leaves.
#pragma once

#include <optional>
#include <string>

#include "core/base/types.h"

namespace spidar {

// Half the paper's 48 cm frame (section VI.1): a = b = c.
inline constexpr double kPaperHalfExtent_m = 0.24;
// Largest motor coordinate that validate() accepts; catches millimeters typed as meters.
inline constexpr double kMaxFrameExtent_m = 10.0;

struct FrameGeometry {
    // String exit points Q1..Q8, device frame (unit: m). Eyelets stand at these points.
    StringVectors motors_m{};
    // Radius of swiveling exit pulleys (unit: m). 0: eyelets. See string_exit.h.
    double pulley_radius_m = 0.0;
    // Unit vector along which the strings reach the pulleys at motors_m.
    Vec3 pulley_axis{0.0, 0.0, 1.0};
};

// Returns the corners of a box with half sizes (a, b, c) in the paper's order:
// (+++)(-++)(+-+)(--+)(++-)(-+-)(+--)(---).
[[nodiscard]] FrameGeometry make_box_frame(const Vec3 &half_extents_m) noexcept;

// The smallest axis-aligned box around all motors (unit: m).
struct MotorBox {
    Vec3 low_m{0.0};
    Vec3 high_m{0.0};
};
[[nodiscard]] MotorBox box_around_motors(const FrameGeometry &frame) noexcept;

// Returns (a, b, c) when each motor lies within 0.25 um of its corner of make_box_frame(), else
// nothing. The closed-form kinematics need a box; Gauss-Newton serves every frame.
[[nodiscard]] std::optional<Vec3> box_half_extents(const FrameGeometry &frame) noexcept;

// True when validate() returns an empty string. No allocation: for the servo loop.
[[nodiscard]] bool is_usable(const FrameGeometry &frame) noexcept;

// Returns an empty string when usable, else one sentence with field, value, unit and remedy.
// Allocates: not for the servo loop.
[[nodiscard]] std::string validate(const FrameGeometry &frame);

} // namespace spidar
