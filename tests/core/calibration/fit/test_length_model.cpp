// Corrections of the lengths, and the Jacobian that calibration and fault evidence stand on.
#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "core/calibration/exit_pulley.h"
#include "core/calibration/fit/length_jacobian.h"
#include "core/geometry/wrench_matrix.h"
#include "support/length_error_model.h"

using namespace spidar;
using namespace spidar::test;

TEST_CASE(
    "length jacobian: its null vector is that of the statics, and motions leave parity alone") {
    const DeviceModel device = paper_device();
    Draw draw(11);
    for (int k = 0; k < 200; ++k) {
        const GripPose pose = random_pose(draw, device.grip, 0.15, 40.0, 30.0);
        const LengthJacobian jacobian(device.frame, device.grip, pose);
        const StringArray &nu = jacobian.null_vector();
        double square = 0.0;
        for (const double x : nu) {
            square += x * x;
        }
        CHECK(square == doctest::Approx(1.0).epsilon(1e-14));
        // A nu = 0: strings pulled by nu give no wrench (moments in units of the pole).
        const PaperWrench wrench =
            spidar::apply(wrench_matrix(device.frame, device.grip, pose), nu);
        for (std::size_t row = 0; row < kDofCount; ++row) {
            CHECK(std::fabs(wrench[row]) < 1e-14);
        }
        // The pose 10 um away: parity changes only in second order, and motion() finds the
        // movement.
        GripPose moved = pose;
        moved.position_m += Vec3(1e-5, -2e-5, 1.5e-5);
        const StringArray lengths = string_lengths(device.frame, device.grip, moved);
        CHECK(std::fabs(jacobian.parity_m(lengths)) < 5e-9);
        StringArray change{};
        for (std::size_t i = 0; i < kStringCount; ++i) {
            change[i] = lengths[i] - jacobian.lengths_m()[i];
        }
        const PoseStep motion = jacobian.motion(change);
        const double sigma = jacobian.smallest_singular();
        CHECK(sigma > 0.0);
        CHECK(std::fabs(motion[0] - 1e-5) < 1e-8 / sigma);
        CHECK(std::fabs(motion[1] + 2e-5) < 1e-8 / sigma);
        CHECK(std::fabs(motion[2] - 1.5e-5) < 1e-8 / sigma);
    }
}

TEST_CASE("length jacobian: singular where research says") {
    const DeviceModel device = paper_device();
    const auto sigma_at = [&](const Vec3 &position, double turn_deg) {
        const GripPose pose =
            pose_at(device.grip, position, Vec3(0.0, 0.0, turn_deg * kDegrees), 0.0);
        return LengthJacobian(device.frame, device.grip, pose).smallest_singular();
    };
    // R = I along z: .81 at the centre, .50 at 10 cm, .144 at 20 cm; Rz 90 deg: rank 6.
    CHECK(sigma_at(Vec3(0.0), 0.0) == doctest::Approx(0.81).epsilon(0.03));
    CHECK(sigma_at(Vec3(0.0, 0.0, 0.1), 0.0) == doctest::Approx(0.50).epsilon(0.03));
    CHECK(sigma_at(Vec3(0.0, 0.0, 0.2), 0.0) == doctest::Approx(0.144).epsilon(0.03));
    CHECK(sigma_at(Vec3(0.03, 0.02, 0.01), 90.0) < 1e-9);
}

TEST_CASE("length corrections: stretch of a known string") {
    LengthCorrections corrections;
    corrections.axial_stiffness_n.fill(3000.0);
    corrections.hidden_length_m.fill(0.08);
    corrections.calibration_tension_n.fill(0.5);
    StringArray lengths;
    lengths.fill(0.42);
    StringArray tensions;
    tensions.fill(5.5);
    StringArray longer = compensate_stretch(corrections, lengths, tensions);
    CHECK(longer[0] == doctest::Approx(0.42 + 0.5 * 5.0 / 3000.0).epsilon(1e-14));
    tensions.fill(0.5);
    CHECK(compensate_stretch(corrections, lengths, tensions)[3] == lengths[3]);
    tensions.fill(std::numeric_limits<double>::quiet_NaN());
    CHECK(compensate_stretch(corrections, lengths, tensions)[3] == lengths[3]);
    tensions.fill(1e9); // a wrong tension moves nothing by more than kMaxStrain
    CHECK(compensate_stretch(corrections, lengths, tensions)[3] ==
          doctest::Approx(0.42 + 0.5 * kMaxStrain));
    CHECK(compensate_stretch(LengthCorrections{}, lengths, tensions)[3] == lengths[3]);
}

TEST_CASE("length corrections: the winding adds its square") {
    DeviceModel device = paper_device();
    device.corrections.winding_curvature_1_m.fill(-0.03);
    CountArray counts;
    counts.fill(4000);
    const double m = 4000 * kPaperMetresPerCount;
    const StringArray lengths = wound_lengths(device.strings, device.corrections, counts);
    CHECK(lengths[2] ==
          doctest::Approx(device.strings.offset_m[2] + m - 0.03 * m * m).epsilon(1e-14));
}

TEST_CASE("length corrections: validate names field, value, unit and remedy") {
    LengthCorrections corrections;
    CHECK(validate(corrections).empty());
    corrections.axial_stiffness_n[2] = -1.0;
    CHECK(validate(corrections).find("axial_stiffness_n[2] (string 3) is -1 N") == 0);
    corrections = {};
    corrections.pulley_radius_m = 4.0;
    CHECK(validate(corrections).find("pulley_radius_m is 4 m") == 0);
    corrections = {};
    corrections.swivel_axis = Vec3(0.0);
    CHECK(validate(corrections).find("swivel_axis") == 0);
    corrections = {};
    corrections.winding_curvature_1_m[0] = std::numeric_limits<double>::quiet_NaN();
    CHECK(validate(corrections).find("winding_curvature_1_m[0] (string 1) is nan 1/m") == 0);
}

TEST_CASE("exit pulley: the string grows along itself, whatever the pulley") {
    // The defining property of a taut string: d(path)/d(attachment) is a unit vector, and it points
    // from the tangent point, which lies one radius from the pulley's centre.
    const DeviceModel device = paper_device();
    LengthCorrections corrections;
    corrections.pulley_radius_m = 0.004;
    Draw draw(5);
    for (int k = 0; k < 100; ++k) {
        const GripPose pose = random_pose(draw, device.grip, 0.2, 30.0, 30.0);
        const auto path = [&](const Vec3 &shift, std::size_t i) {
            GripPose moved = pose;
            moved.position_m += shift;
            return string_lengths(device.frame, device.grip, moved)[i] +
                   exit_excess(device.frame, device.grip, corrections, moved)[i];
        };
        for (std::size_t i = 0; i < kStringCount; ++i) {
            constexpr double h = 1e-6;
            const Vec3 slope((path(Vec3(h, 0, 0), i) - path(Vec3(-h, 0, 0), i)) / (2 * h),
                             (path(Vec3(0, h, 0), i) - path(Vec3(0, -h, 0), i)) / (2 * h),
                             (path(Vec3(0, 0, h), i) - path(Vec3(0, 0, -h), i)) / (2 * h));
            CHECK(glm::length(slope) == doctest::Approx(1.0).epsilon(1e-6));
            // It differs from the eyelet's direction by no more than the pulley's size allows.
            const Vec3 line =
                attachment_point(device.grip, pose, static_cast<int>(i)) - device.frame.motors_m[i];
            CHECK(glm::length(slope - glm::normalize(line)) <
                  2.5 * corrections.pulley_radius_m / glm::length(line));
        }
    }
    corrections.pulley_radius_m = 0.0;
    CHECK(exit_excess(device.frame, device.grip, corrections, rest_pose(device.grip))[0] == 0.0);
}
