// The paper's own ways from lengths to pose (section III), for comparison only. With z known, each pole's other two
// coordinates follow, and |r| = d makes one polynomial of degree six in z a pole.
//   division: both polynomials by Euclid's algorithm down to a line, whose root is the common z.
//   cubic: the first polynomial as a cubic in (z - c)^2; of its roots the one that suits the other pole best.
// With errors in the lengths there is no common root, and both lose accuracy.
#pragma once

#include "core/geometry/grip_geometry.h"

namespace spidar::bench {

// In a box of these half sizes with the paper's strings. Not finite where the method finds nothing.
[[nodiscard]] GripPose paper_division(const Vec3 &half_extents_m, double pole_half_length_m,
                                      const StringArray &lengths_m);
[[nodiscard]] GripPose paper_cubic(const Vec3 &half_extents_m, double pole_half_length_m,
                                   const StringArray &lengths_m);

} // namespace spidar::bench
