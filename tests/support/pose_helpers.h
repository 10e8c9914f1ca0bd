// What the kinematics tests share: angles, random poses, distances between poses.
#pragma once

#include <cmath>
#include <cstdint>
#include <random>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "core/geometry/frame_geometry.h"
#include "core/geometry/grip_geometry.h"
#include "core/kinematics/search/closed_form.h"

namespace spidar::test {

inline constexpr double kDeg = 0.017453292519943295; // radians

// Rz Ry Rx, angles in radians.
inline Mat3 rotation_zyx(double x, double y, double z) {
    return glm::mat3_cast(glm::angleAxis(z, Vec3(0, 0, 1)) * glm::angleAxis(y, Vec3(0, 1, 0)) *
                          glm::angleAxis(x, Vec3(1, 0, 0)));
}

class Random {
public:
    explicit Random(std::uint64_t seed) : engine_(seed) {}
    double between(double low, double high) {
        return low + (high - low) * (static_cast<double>(engine_() >> 11) * 0x1p-53);
    }
    // Position in +-cube_m, each rotation and the grasp angle in +-angle_rad.
    GripPose pose(const GripGeometry &grip, double cube_m, double angle_rad) {
        const Vec3 position(between(-cube_m, cube_m), between(-cube_m, cube_m),
                            between(-cube_m, cube_m));
        const Mat3 rotation =
            rotation_zyx(between(-angle_rad, angle_rad), between(-angle_rad, angle_rad),
                         between(-angle_rad, angle_rad));
        return make_pose(grip, position, rotation, between(-angle_rad, angle_rad));
    }

private:
    std::mt19937_64 engine_;
};

// Largest distance between the two grip centres or pole ends (unit: m).
inline double distance(const GripPose &a, const GripPose &b) {
    return std::fmax(glm::distance(a.position_m, b.position_m),
                     std::fmax(glm::distance(a.r1_m, b.r1_m), glm::distance(a.r2_m, b.r2_m)));
}

// Largest difference of two matrices' entries.
inline double distance(const Mat3 &a, const Mat3 &b) {
    double largest = 0.0;
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
            largest = std::fmax(largest, std::fabs(a[i][j] - b[i][j]));
        }
    }
    return largest;
}

// The pose of one root pair of the closed form.
inline GripPose closed_form_pose(const Vec3 &half_extents_m, double pole_half_length_m,
                                 const StringArray &lengths_m, int pair) {
    return pose_of(
        root_pair_pose(solve_closed_form(half_extents_m, pole_half_length_m, lengths_m), pair)
            .pose);
}

inline FrameGeometry paper_frame() {
    return make_box_frame(Vec3(kPaperHalfExtent_m));
}

} // namespace spidar::test
