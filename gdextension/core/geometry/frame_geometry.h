// The frame that carries the motors: where each string leaves.
#pragma once

#include <optional>
#include <string>

#include "core/base/types.h"

namespace spidar {

// Half the paper's 48 cm frame (section VI.1): a = b = c.
inline constexpr double kPaperHalfExtent_m = 0.24;
// Furthest motor from the centre, along an axis, that validate() accepts; catches millimetres typed as metres.
inline constexpr double kMaxFrameExtent_m = 10.0;

struct FrameGeometry {
    // String exit points Q1..Q8, device frame (unit: m). Eyelets: the string leaves from the point.
    StringVectors motors_m{};
    // Above 0: the strings leave over swivelling pulleys of this radius (unit: m), which they reach at motors_m
    // along pulley_axis (unit vector). See string_exit.h.
    double pulley_radius_m = 0.0;
    Vec3 pulley_axis{0.0, 0.0, 1.0};
};

// Corners of a box of half sizes (a, b, c), in the paper's order:
// (+++)(-++)(+-+)(--+)(++-)(-+-)(+--)(---).
[[nodiscard]] FrameGeometry make_box_frame(const Vec3 &half_extents_m) noexcept;

// The smallest box around all motors, edges along the axes (unit: m).
struct MotorBox {
    Vec3 low_m{0.0};
    Vec3 high_m{0.0};
};
[[nodiscard]] MotorBox box_around_motors(const FrameGeometry &frame) noexcept;

// (a, b, c) when the motors are the corners of such a box (to 0.25 um), else nothing. The
// closed-form kinematics exist for boxes only; Gauss-Newton serves every frame.
[[nodiscard]] std::optional<Vec3> box_half_extents(const FrameGeometry &frame) noexcept;

// The same judgement as validate() without its sentence: no allocation, for the servo side.
[[nodiscard]] bool is_usable(const FrameGeometry &frame) noexcept;

// Empty when usable; else one sentence naming the field, the value, the unit and the remedy.
// Allocates: not for the servo loop.
[[nodiscard]] std::string validate(const FrameGeometry &frame);

} // namespace spidar
