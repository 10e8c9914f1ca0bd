// The paper's device (section VI: 48 cm frame, 4 cm poles) and small things that every section needs.
#pragma once

#include <cstdint>
#include <random>

#include <glm/gtc/quaternion.hpp>

#include "core/geometry/frame_geometry.h"
#include "core/geometry/grip_geometry.h"
#include "core/kinematics/grasp_detector.h"

namespace spidar::paper {

// Half the edge of the cube that the paper works in (section VI.2).
inline constexpr double kCubeHalf_m = 0.20;
inline constexpr double kMaxTensions_n[] = {5.0, 10.0, 20.0}; // the paper does not state its own

struct PaperDevice {
    FrameGeometry frame = make_box_frame(Vec3(kPaperHalfExtent_m));
    GripGeometry grip;
};

inline Vec3 axis_vector(int axis) {
    Vec3 unit(0.0);
    unit[axis] = 1.0;
    return unit;
}

inline Mat3 rotation_about(int axis, double angle_rad) {
    return glm::mat3_cast(glm::angleAxis(angle_rad, axis_vector(axis)));
}

// Rz Ry Rx.
inline Mat3 rotation_zyx(const Vec3 &angles_rad) {
    return rotation_about(2, angles_rad.z) * rotation_about(1, angles_rad.y) *
           rotation_about(0, angles_rad.x);
}

// std::uniform_real_distribution differs between libraries; these figures must not.
class Random {
public:
    explicit Random(std::uint64_t seed) : engine_(seed) {}
    double between(double low, double high) {
        return low + (high - low) * (static_cast<double>(engine_() >> 11U) * 0x1p-53);
    }
    bool heads() { return (engine_() >> 63U) != 0U; }
    Vec3 in_cube(double half) {
        const double x = between(-half, half);
        const double y = between(-half, half);
        return {x, y, between(-half, half)};
    }
    // Position in +-cube_m, rotations Rz Ry Rx each in +-tilt_rad, grasp angle in +-grasp_rad.
    GripPose pose(const GripGeometry &grip, double cube_m, double tilt_rad, double grasp_rad) {
        const Vec3 position = in_cube(cube_m);
        const Mat3 rotation = rotation_zyx(in_cube(tilt_rad));
        return make_pose(grip, position, rotation, between(-grasp_rad, grasp_rad));
    }

private:
    std::mt19937_64 engine_;
};

// The value in the middle of a grid: count points from -half to +half.
inline double grid_value(int index, int count, double half) {
    return half * (2.0 * index - (count - 1)) / (count - 1);
}

} // namespace spidar::paper
