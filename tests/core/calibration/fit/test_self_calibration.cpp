#include <doctest/doctest.h>

#include <cmath>
#include <vector>

#include <glm/geometric.hpp>

#include "core/calibration/fit/self_calibration.h"
#include "core/calibration/home_zero.h"
#include "core/kinematics/forward_kinematics.h"
#include "support/motion_samples.h"

using namespace spidar;
using namespace spidar::test;

namespace {

constexpr double kNoise_m = 1e-4;

std::vector<CountArray> free_motion(const DeviceModel &device, Draw &draw, int poses,
                                    double noise_m) {
    std::vector<CountArray> samples;
    for (int k = 0; k < poses; ++k) {
        samples.push_back(
            counts_at(device, random_pose(draw, device.grip, 0.2, 45.0, 40.0), noise_m, draw));
    }
    return samples;
}

double offset_error(const DeviceModel &found, const DeviceModel &truth) {
    double square = 0.0;
    for (std::size_t i = 0; i < kStringCount; ++i) {
        const double error = found.strings.offset_m[i] - truth.strings.offset_m[i];
        square += error * error / kStringCount;
    }
    return std::sqrt(square);
}

// rms distance of the grip centre found from the true one, from exact lengths of other poses.
double grip_error(const DeviceModel &found, const DeviceModel &truth, Draw &draw) {
    ForwardKinematics kinematics;
    REQUIRE(usable(kinematics.configure(found.frame, found.grip)));
    double square = 0.0;
    int solved = 0;
    for (int k = 0; k < 400; ++k) {
        const GripPose pose = random_pose(draw, truth.grip, 0.15, 30.0, 30.0);
        const CountArray counts = counts_at(truth, pose, 0.0, draw);
        kinematics.set_last_pose(pose);
        const KinematicsResult result =
            kinematics.update(wound_lengths(found.strings, found.corrections, counts));
        if (usable(result.status) && result.conditioning > 1e-2) {
            const double error = glm::distance(result.pose.position_m, pose.position_m);
            square += error * error;
            ++solved;
        }
    }
    CHECK(solved > 300);
    return std::sqrt(square / solved);
}

// Zeroed in a stand that is 3 mm and 3 degrees off, at nominal scale.
DeviceModel start_at_home(const DeviceModel &truth, Draw &draw) {
    DeviceModel start = paper_device();
    const GripPose off =
        pose_at(truth.grip, Vec3(0.0017, -0.0017, 0.0017),
                Vec3(1.7 * kDegrees, 1.7 * kDegrees, -1.7 * kDegrees), 1.0 * kDegrees);
    const std::vector<CountArray> repeats(5, counts_at(truth, off, 0.0, draw));
    const HomeZero zero = zero_at_pose(start.frame, start.grip, rest_pose(start.grip), repeats,
                                       start.strings.scale_m_per_count, start.corrections);
    REQUIRE(zero.status == Status::ok);
    start.strings = zero.strings;
    return start;
}

// Offsets of 5 mm, blind start. Returns the rms over the seeds of the offset error.
double blind_offsets(int poses, int seeds, double &expected) {
    double square = 0.0;
    expected = 0.0;
    for (int seed = 1; seed <= seeds; ++seed) {
        Draw draw(static_cast<std::uint64_t>(seed));
        DeviceModel truth = paper_device();
        for (double &offset : truth.strings.offset_m) {
            offset += 0.005 * draw.normal();
        }
        const SelfCalibrationResult found = self_calibrate(
            paper_device(), free_motion(truth, draw, poses, kNoise_m), SelfCalibrationSettings{});
        CAPTURE(seed);
        CHECK(found.status == Status::ok);
        CHECK(found.used > poses / 2);
        const double error = offset_error(found.model, truth);
        CHECK(error <= 3.0 * found.offset_error_rms_m); // the covariance means something
        square += error * error / seeds;
        expected += found.offset_error_rms_m / seeds;
    }
    return std::sqrt(square);
}

} // namespace

TEST_CASE("self-calibration: 5 mm offsets, 0.1 mm noise, quantised, blind") {
    double expected = 0.0;
    const double at_100 = blind_offsets(100, 12, expected);
    CHECK(at_100 <= 0.06e-3);
    CHECK(at_100 == doctest::Approx(expected).epsilon(0.4));
    const double at_1000 = blind_offsets(1000, 4, expected);
    CHECK(at_1000 <= 0.02e-3);
}

TEST_CASE("self-calibration: gains from a home start") {
    constexpr int kSeeds = 8;
    double square = 0.0;
    for (int seed = 1; seed <= kSeeds; ++seed) {
        Draw draw(100U + static_cast<std::uint64_t>(seed));
        DeviceModel truth = paper_device();
        for (double &scale : truth.strings.scale_m_per_count) {
            scale *= 1.043 * (1.0 + 0.005 * draw.normal());
        }
        const DeviceModel start = start_at_home(truth, draw);
        SelfCalibrationSettings settings;
        settings.fit_gains = true;
        const SelfCalibrationResult found =
            self_calibrate(start, free_motion(truth, draw, 300, kNoise_m), settings);
        CAPTURE(seed);
        REQUIRE(usable(found.status));
        const double before = grip_error(start, truth, draw);
        const double after = grip_error(found.model, truth, draw);
        CHECK(before > 3e-3);
        CHECK(after <= 2.0 * found.grip_error_rms_m);
        square += after * after / kSeeds;
    }
    CHECK(std::sqrt(square) <= 0.07e-3);
}

TEST_CASE("self-calibration: frame and pole sizes, with the true x size given") {
    Draw draw(41);
    DeviceModel truth = paper_device();
    truth.frame = make_box_frame(Vec3(0.24, 0.241, 0.2392));
    truth.grip.pole_half_length_m = 0.0404;
    truth.strings.offset_m = string_lengths(truth.frame, truth.grip, rest_pose(truth.grip));
    for (double &scale : truth.strings.scale_m_per_count) {
        scale *= 1.043 * (1.0 + 0.005 * draw.normal());
    }
    SelfCalibrationSettings settings;
    settings.fit_gains = true;
    settings.fit_sizes = true;
    const SelfCalibrationResult found = self_calibrate(
        start_at_home(truth, draw), free_motion(truth, draw, 1000, kNoise_m), settings);
    REQUIRE(usable(found.status));
    const double y = found.model.frame.motors_m[0].y;
    const double z = found.model.frame.motors_m[0].z;
    CHECK(found.model.frame.motors_m[0].x == 0.24);
    CHECK(std::fabs(y - 0.241) < 4.0 * 0.24 * found.expected_error[kSizeUnknowns + 1]);
    CHECK(std::fabs(z - 0.2392) < 4.0 * 0.24 * found.expected_error[kSizeUnknowns + 2]);
    CHECK(std::fabs(y - 0.241) < 2e-4);
    CHECK(std::fabs(z - 0.2392) < 2e-4);
    CHECK(grip_error(found.model, truth, draw) < 0.1e-3);
}

TEST_CASE("self-calibration: outliers are left out") {
    Draw draw(43);
    DeviceModel truth = paper_device();
    truth.strings.offset_m[5] += 0.004;
    std::vector<CountArray> samples = free_motion(truth, draw, 300, kNoise_m);
    for (std::size_t k = 0; k < samples.size(); k += 10) {
        samples[k][k % kStringCount] += 400; // 10 mm
    }
    const SelfCalibrationResult found =
        self_calibrate(paper_device(), samples, SelfCalibrationSettings{});
    REQUIRE(found.status == Status::ok);
    CHECK(found.rejected_outliers + found.rejected_unsolved >= 20);
    CHECK(offset_error(found.model, truth) <= 0.06e-3);
}

TEST_CASE("self-calibration: says what the motion cannot tell") {
    Draw draw(44);
    const DeviceModel truth = paper_device();
    const auto condition = [&](double cube_m, double angle_deg, double grasp_deg) {
        std::vector<CountArray> samples;
        for (int k = 0; k < 1000; ++k) {
            samples.push_back(counts_at(
                truth, random_pose(draw, truth.grip, cube_m, angle_deg, grasp_deg), 1e-5, draw));
        }
        const SelfCalibrationResult found =
            self_calibrate(truth, samples, SelfCalibrationSettings{});
        REQUIRE(usable(found.status));
        return found.singular.front() / found.singular.back();
    };
    // Research: cond 5.6 for +-15 cm, 30/30 deg; 50 for translation only.
    CHECK(condition(0.15, 30.0, 30.0) == doctest::Approx(5.6).epsilon(0.25));
    CHECK(condition(0.15, 0.0, 0.0) > 30.0);

    // Standing still: everything is open but one combination, and the offsets stay where they were.
    const std::vector<CountArray> still(50, CountArray{});
    const SelfCalibrationResult open = self_calibrate(truth, still, SelfCalibrationSettings{});
    CHECK(open.status == Status::weakly_observed);
    CHECK(open.weak.size() == 7);
    CHECK(describe(open.weak.back()).find("offset of string") != std::string::npos);
    CHECK(offset_error(open.model, truth) < 1e-4);
}

TEST_CASE("self-calibration: bad input leaves the start as it was") {
    const DeviceModel start = paper_device();
    const std::vector<CountArray> few(5, CountArray{});
    SelfCalibrationResult found = self_calibrate(start, few, SelfCalibrationSettings{});
    CHECK(found.status == Status::too_few_samples);
    CHECK(found.model.strings.offset_m == start.strings.offset_m);
    CHECK(self_calibrate(start, {}, SelfCalibrationSettings{}).status == Status::too_few_samples);
    SelfCalibrationSettings settings;
    settings.offset_prior_m = 0.0;
    CHECK(validate(settings).find("offset_prior_m is 0 m") == 0);
    CHECK(self_calibrate(start, few, settings).status == Status::invalid_settings);
    settings = {};
    settings.fit_sizes = true;
    CHECK(validate(settings).find("fit_gains") == 0);
    DeviceModel flat = start;
    flat.grip.pole_half_length_m = 0.0;
    CHECK(self_calibrate(flat, few, SelfCalibrationSettings{}).status == Status::invalid_geometry);
    DeviceModel unscaled = start;
    unscaled.strings.scale_m_per_count.fill(0.0);
    CHECK(self_calibrate(unscaled, few, SelfCalibrationSettings{}).status ==
          Status::invalid_calibration);
}
