// The paper's matrix A, 7 x 8: wrench on the grip = A * tensions. Column i is w_i = [c_i; r_i x
// c_i; delta_i n.(r_i x c_i)], where
//   c_i = unit vector from the attachment to the motor,
//   n = unit(r1 x r2), delta = +1 for pole 1 (strings 0-3) and -1 for pole 2 (strings 4-7).
// The cross product in the grasp element corrects a misprint of the paper. The seventh row belongs
// to the paper's g = 2 grasp_torque, conjugate to -psi/2.
#pragma once

#include "core/base/types.h"
#include "core/geometry/frame_geometry.h"
#include "core/geometry/grip_geometry.h"

namespace spidar {

struct WrenchMatrix {
    // columns[i][k]: DOF k of string i.
    std::array<PaperWrench, kStringCount> columns{};
    // True when row seven is zero: n is undefined at parallel poles, or the grip is rigid.
    bool grasp_row_vanishes = false;
};

[[nodiscard]] WrenchMatrix wrench_matrix(const FrameGeometry &frame, const GripGeometry &grip,
                                         const GripPose &pose) noexcept;

// Same as wrench_matrix(), in place: saves a copy of 450 bytes.
void set_wrench_matrix(WrenchMatrix &matrix, const FrameGeometry &frame, const GripGeometry &grip,
                       const GripPose &pose) noexcept;

// Returns A * tensions, in the paper's order (g, not grasp_torque).
[[nodiscard]] PaperWrench apply(const WrenchMatrix &matrix, const StringArray &tensions_n) noexcept;

// Returns A^T * rates: the rates at which the strings shorten (unit: m/s).
[[nodiscard]] StringArray apply_transposed(const WrenchMatrix &matrix,
                                           const PaperTwist &rates) noexcept;

} // namespace spidar
