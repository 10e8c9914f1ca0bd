// Closed-form kinematics of the paper's grip in a box frame, eq. (4)-(15) with the paper's misprints put
// right (docs/paper_notes.md). x, y, x1, y2 follow directly; y1 and x2 are each a root of a cubic,
//   (2b y1 - k1)(y1^2 - (d^2 - x1^2)) + (E1 - y y1)^2 = 0   (and likewise for x2),
// two of whose roots can lie on the pole's circle: pole upright or flipped. Four pairs in all.
#pragma once

#include <array>

#include "core/grip_geometry.h"
#include "core/types.h"

namespace spidar {

// Pair p: bit 0 set takes the flipped root of pole 1, bit 1 that of pole 2. Pair 0 is the upright one.
inline constexpr int kRootPairCount = 4;

// True when this grip ties its strings as the paper's does: what the closed form assumes.
[[nodiscard]] bool has_paper_attachments(const GripGeometry &grip) noexcept;

// The pose of root pair `pair` for lengths in a box of half sizes `half_extents_m`. Exact for exact lengths;
// with errors, a start for Gauss-Newton (roots that turned complex are replaced by the nearest real ones).
// Always finite for finite lengths, |r1| = |r2| = pole_half_length_m.
[[nodiscard]] GripPose closed_form_pose(const Vec3 &half_extents_m, double pole_half_length_m,
                                        const StringArray &lengths_m, int pair) noexcept;

} // namespace spidar
