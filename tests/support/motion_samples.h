// Devices that are wrong in a known way, and the counts they give: for the tests of calibration.
#pragma once

#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "core/calibration/fit/self_calibration.h"

namespace spidar::test {

inline constexpr double kDegrees = 0.017453292519943295;

// The same numbers with every library: no std distribution.
class Draw {
public:
    explicit Draw(std::uint64_t seed) : engine_(seed * 0x9e3779b97f4a7c15ULL + 1) {}
    double between(double low, double high) {
        return low + (high - low) * (static_cast<double>(engine_() >> 11) * 0x1p-53);
    }
    double normal() {
        const double radius = std::sqrt(-2.0 * std::log(1.0 - between(0.0, 1.0)));
        return radius * std::cos(between(0.0, 2.0 * 3.141592653589793));
    }
    int below(int count) { return static_cast<int>(between(0.0, count)); }

private:
    std::mt19937_64 engine_;
};

inline GripPose pose_at(const GripGeometry &grip, const Vec3 &position, const Vec3 &angles,
                        double grasp_rad) {
    const glm::dquat rotation = glm::angleAxis(angles.z, Vec3(0, 0, 1)) *
                                glm::angleAxis(angles.y, Vec3(0, 1, 0)) *
                                glm::angleAxis(angles.x, Vec3(1, 0, 0));
    return make_pose(grip, position, glm::mat3_cast(rotation), grasp_rad);
}

inline GripPose random_pose(Draw &draw, const GripGeometry &grip, double cube_m, double angle_deg,
                            double grasp_deg) {
    const auto three = [&](double size) {
        const double x = draw.between(-size, size);
        const double y = draw.between(-size, size);
        return Vec3(x, y, draw.between(-size, size));
    };
    const Vec3 position = three(cube_m);
    const Vec3 angles = three(angle_deg * kDegrees);
    return pose_at(grip, position, angles, draw.between(-grasp_deg, grasp_deg) * kDegrees);
}

// Trajectory T1: 7 incommensurate sines, to 0.7 m/s and 2.5 rad/s.
inline GripPose t1_pose(const GripGeometry &grip, double t) {
    const Vec3 position(0.15 * std::sin(3.1 * t), 0.15 * std::sin(2.3 * t + 1.0),
                        0.12 * std::sin(2.9 * t + 2.0));
    const Vec3 angles(0.6 * std::sin(4.1 * t), 0.6 * std::sin(3.7 * t + 1.0),
                      0.5 * std::sin(3.3 * t + 2.0));
    return pose_at(grip, position, angles, -0.5 * std::sin(2.1 * t));
}

inline DeviceModel paper_device() {
    DeviceModel device;
    device.frame = make_box_frame(Vec3(kPaperHalfExtent_m));
    device.strings =
        calibrate_at_home(string_lengths(device.frame, device.grip, rest_pose(device.grip)),
                          CountArray{}, kPaperMetresPerCount);
    return device;
}

// Counts that a device whose true calibration is `device` gives for true lengths with noise.
inline CountArray counts_of(const DeviceModel &device, const StringArray &lengths_m, double noise_m,
                            Draw &draw) {
    CountArray counts{};
    for (std::size_t i = 0; i < kStringCount; ++i) {
        const double wound = lengths_m[i] + noise_m * draw.normal() - device.strings.offset_m[i];
        const double c = device.corrections.winding_curvature_1_m[i];
        const double paid_out = 2.0 * wound / (1.0 + std::sqrt(1.0 + 4.0 * c * wound));
        counts[i] =
            device.strings.zero_count[i] +
            static_cast<std::int32_t>(std::lround(paid_out / device.strings.scale_m_per_count[i]));
    }
    return counts;
}

inline CountArray counts_at(const DeviceModel &device, const GripPose &pose, double noise_m,
                            Draw &draw) {
    return counts_of(device, string_lengths(device.frame, device.grip, pose), noise_m, draw);
}

} // namespace spidar::test
