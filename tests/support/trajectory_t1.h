// Trajectory T1: a hand that moves everywhere in the middle of the frame, at up to 0.7 m/s and 2.5 rad/s, with a wrench
// that changes in all seven DOF. 60 s at 1 kHz by custom.
#pragma once

#include <array>
#include <cmath>

#include "core/base/types.h"
#include "core/geometry/grip_geometry.h"

namespace spidar::test {

inline constexpr std::array<double, 7> kT1Rates_rad_s = {3.1, 2.3, 2.9, 4.1, 3.7, 3.3, 2.1};

inline GripPose t1_pose(const GripGeometry &grip, double t) {
    const auto &w = kT1Rates_rad_s;
    const double ex = 0.6 * std::sin(w[3] * t);
    const double ey = 0.6 * std::sin(w[4] * t + 1.0);
    const double ez = 0.5 * std::sin(w[5] * t + 2.0);
    const Mat3 rx(1, 0, 0, 0, std::cos(ex), std::sin(ex), 0, -std::sin(ex), std::cos(ex));
    const Mat3 ry(std::cos(ey), 0, -std::sin(ey), 0, 1, 0, std::sin(ey), 0, std::cos(ey));
    const Mat3 rz(std::cos(ez), std::sin(ez), 0, -std::sin(ez), std::cos(ez), 0, 0, 0, 1);
    // grasp_angle = pi/2 - psi, psi = pi/2 + 0.5 sin(w7 t).
    return make_pose(grip,
                     Vec3(0.15 * std::sin(w[0] * t), 0.15 * std::sin(w[1] * t + 1.0),
                          0.12 * std::sin(w[2] * t + 2.0)),
                     rz * ry * rx, -0.5 * std::sin(w[6] * t));
}

// Without the zeros. The paper's q: fx fy fz mx my mz g.
inline PaperWrench t1_wrench(double t) {
    const auto &w = kT1Rates_rad_s;
    PaperWrench wrench{};
    for (std::size_t i = 0; i < wrench.size(); ++i) {
        const double phase = static_cast<double>(i);
        wrench[i] = i < 3 ? 3.0 * std::sin(1.7 * w[(i + 2) % 7] * t + phase)
                          : 0.08 * std::sin(1.9 * w[(i + 3) % 7] * t + phase);
    }
    return wrench;
}

} // namespace spidar::test
