// Value types shared by the whole core. SI units; device frame unless a name says otherwise.
//
// Device frame: origin at the center of the frame, the paper's axes X, Y, Z, right-handed.
// Strings, corners and motors are numbered 1-8 in the paper and 0-7 in code.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

namespace spidar {

using Vec3 = glm::dvec3;
using Mat3 = glm::dmat3; // column-major: Mat3(x_axis, y_axis, z_axis)

inline constexpr int kStringCount = 8;
// Largest number of sensors that a device may have besides its string encoders.
inline constexpr int kSensorCount = 8;
inline constexpr int kDofCount = 7;

// One real number per string, index 0-7.
using StringArray = std::array<double, kStringCount>;
// One encoder count per string.
using CountArray = std::array<std::int32_t, kStringCount>;
// One vector per string.
using StringVectors = std::array<Vec3, kStringCount>;

// One number per degree of freedom. `Meaning` is a tag: rows of different meanings are different
// types and do not convert into each other.
template <class Meaning>
struct SevenDof {
    std::array<double, kDofCount> values{};

    constexpr double &operator[](std::size_t dof) noexcept { return values[dof]; }
    constexpr const double &operator[](std::size_t dof) const noexcept { return values[dof]; }
    constexpr auto begin() noexcept { return values.begin(); }
    constexpr auto end() noexcept { return values.end(); }
    [[nodiscard]] constexpr auto begin() const noexcept { return values.begin(); }
    [[nodiscard]] constexpr auto end() const noexcept { return values.end(); }
    [[nodiscard]] static constexpr std::size_t size() noexcept { return kDofCount; }
    friend constexpr bool operator==(const SevenDof &, const SevenDof &) = default;
};

// The paper's wrench q: fx fy fz (N), mx my mz (N m) about P0, g (N m). g is conjugate to -psi/2,
// so that g = 2 grasp_torque.
using PaperWrench = SevenDof<struct PaperWrenchMeaning>;
// One weight per component of a PaperWrench: the diagonal of W.
using PaperWeights = SevenDof<struct PaperWeightsMeaning>;
// Conjugate of PaperWrench: velocity (m/s), angular velocity (rad/s), -dpsi/dt / 2 (rad/s). The sum
// of the products with a PaperWrench is the power (W).
using PaperTwist = SevenDof<struct PaperTwistMeaning>;

// The wrench that the device exerts on the hand; also the form in which a game requests one. The
// grip is two crossing poles; closing it turns them toward each other.
struct Wrench {
    Vec3 force_n{0.0};
    Vec3 moment_nm{0.0};          // about the grip center P0
    double grasp_torque_nm = 0.0; // conjugate to grasp_angle; positive closes the poles
};

// Rate of change of the grip pose. Power given to the hand = dot(wrench, twist) over all seven DOF.
struct Twist {
    Vec3 linear_m_s{0.0};
    Vec3 angular_rad_s{0.0};
    double grasp_rate_rad_s = 0.0; // d(grasp_angle)/dt
};

// Converts a game wrench to the paper's q: g = 2 grasp_torque.
[[nodiscard]] inline PaperWrench to_paper(const Wrench &wrench) noexcept {
    return {wrench.force_n.x,
            wrench.force_n.y,
            wrench.force_n.z,
            wrench.moment_nm.x,
            wrench.moment_nm.y,
            wrench.moment_nm.z,
            2.0 * wrench.grasp_torque_nm};
}

// Inverse of to_paper().
[[nodiscard]] inline Wrench from_paper(const PaperWrench &q) noexcept {
    return {Vec3(q[0], q[1], q[2]), Vec3(q[3], q[4], q[5]), 0.5 * q[6]};
}

} // namespace spidar
