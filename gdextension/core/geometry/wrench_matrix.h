// A of the paper: wrench on the grip = A * tensions. 7 x 8; column i is
// w_i = [c_i; r_i x c_i; delta_i n.(r_i x c_i)] (the paper's third row printed without the lever arm's
// cross product is corrected), c_i = unit vector from the attachment to the motor,
// n = unit(r1 x r2), delta = +1 for pole 1 (strings 0-3), -1 for pole 2 (strings 4-7).
// The seventh row belongs to the paper's g, conjugate to -psi/2: g = 2 grasp_torque.
#pragma once

#include "core/base/types.h"
#include "core/geometry/frame_geometry.h"
#include "core/geometry/grip_geometry.h"

namespace spidar {

struct WrenchMatrix {
    // columns[i][k]: k-th DOF of string i.
    std::array<PaperWrench, kStringCount> columns{};
    // Poles parallel: n is undefined and the seventh row is zero. So it is for a rigid grip: 6 x 8.
    bool grasp_row_vanishes = false;
};

[[nodiscard]] WrenchMatrix wrench_matrix(const FrameGeometry &frame, const GripGeometry &grip,
                                         const GripPose &pose) noexcept;

// The same in place: no copy of 450 bytes.
void set_wrench_matrix(WrenchMatrix &matrix, const FrameGeometry &frame, const GripGeometry &grip,
                       const GripPose &pose) noexcept;

// A * tensions, in the paper's order (g, not grasp_torque).
[[nodiscard]] PaperWrench apply(const WrenchMatrix &matrix, const StringArray &tensions_n) noexcept;

// A^T * twist_like: string shortening rates (unit: m/s) for (v, omega, -psi_rate/2).
[[nodiscard]] StringArray apply_transposed(const WrenchMatrix &matrix,
                                           const PaperTwist &rates) noexcept;

} // namespace spidar
