// Derivative of the eight straight-line lengths with respect to the seven motions of a crossed grip
// at one pose: J = dl/dpose, 8 x 7, by Householder QR. The left null vector nu of J gives the one
// redundant equation of eight strings on seven DOF: nu . (length errors) = 0, whatever the grip did
// (paper, section III: the null vector of A). Servo-safe: no allocation, fixed work.
#pragma once

#include "core/base/types.h"
#include "core/geometry/frame_geometry.h"
#include "core/geometry/grip_geometry.h"
#include "core/geometry/pose_tangents.h"

namespace spidar {

class LengthJacobian {
public:
    LengthJacobian() = default;
    LengthJacobian(const FrameGeometry &frame, const GripGeometry &grip,
                   const GripPose &pose) noexcept;

    // nu: unit vector orthogonal to all length changes of motions. Its sign has no meaning.
    [[nodiscard]] const StringArray &null_vector() const noexcept { return null_; }
    // Unit vectors from motor to attachment: d(length)/d(attachment).
    [[nodiscard]] const StringVectors &directions() const noexcept { return directions_; }
    [[nodiscard]] const StringArray &lengths_m() const noexcept { return lengths_m_; }
    // Smallest singular value of J, with motions in meters at the grip center and at the pole ends.
    // Found by inverse iteration to within a few percent. 0 when J is singular or not finite.
    [[nodiscard]] double smallest_singular() const noexcept { return smallest_; }
    // Returns the parity error with a sign: nu . (measured - computed lengths) (unit: m).
    [[nodiscard]] double parity_m(const StringArray &measured_m) const noexcept;
    // Returns the motion whose length changes are nearest to these in the least-squares sense: x y
    // z of the grip center, then two tangent displacements of each pole's end (unit: m). Zero where
    // J is singular.
    [[nodiscard]] PoseStep motion(const StringArray &length_change_m) const noexcept;

private:
    void factorise(std::array<StringArray, kDofCount> columns) noexcept;

    StringVectors directions_{};
    StringArray lengths_m_{};
    StringArray null_{};
    std::array<StringArray, kDofCount> q_{}; // orthonormal columns
    std::array<PoseStep, kDofCount> r_{};    // r_[row][column], upper triangle
    double smallest_ = 0.0;
};

} // namespace spidar
