#include <doctest/doctest.h>

#include <cmath>

#include "core/calibration/fit/worksheet.h"
#include "support/motion_samples.h"

using namespace spidar;
using namespace spidar::test;

namespace {

// A device whose every string is wrong: 4 % of winding, 0.5 % of its own, 5 mm at home.
DeviceModel wrong_device(Draw &draw) {
    DeviceModel truth = paper_device();
    for (std::size_t i = 0; i < kStringCount; ++i) {
        truth.strings.scale_m_per_count[i] *= 1.04 * (1.0 + 0.005 * draw.normal());
        truth.strings.offset_m[i] += 0.005 * draw.normal();
    }
    return truth;
}

GripPose home() {
    return rest_pose(GripGeometry{});
}

} // namespace

TEST_CASE("worksheet: a device with wrong offsets and scales is brought right") {
    Draw draw(7);
    const DeviceModel truth = wrong_device(draw);
    CalibrationWorksheet sheet;
    sheet.begin(paper_device(), MotorCalibration{});
    for (int k = 0; k < 5; ++k) {
        REQUIRE(sheet.add_zero(counts_at(truth, home(), 1e-4, draw)).empty());
    }
    while (sheet.poses().size() < 400) {
        sheet.add_pose(
            counts_at(truth, random_pose(draw, truth.grip, 0.18, 40.0, 35.0), 1e-4, draw));
    }
    const SelfCalibrationResult found =
        self_calibrate(sheet.measured(), sheet.poses(), sheet.settings());
    REQUIRE(CalibrationWorksheet::refusal(found).empty());
    double square = 0.0;
    for (std::size_t i = 0; i < kStringCount; ++i) {
        const double relative =
            found.model.strings.scale_m_per_count[i] / truth.strings.scale_m_per_count[i] - 1.0;
        square += relative * relative / kStringCount;
    }
    CHECK(std::sqrt(square) <= 5.7e-4); // kinematics.md's figure for 300 poses
    const StringArray before = sheet.residuals(sheet.before());
    const StringArray after = sheet.residuals(found.model);
    double worst_before = 0.0;
    for (std::size_t i = 0; i < kStringCount; ++i) {
        worst_before = std::fmax(worst_before, before[i]);
        CHECK(after[i] < 2e-4);
    }
    CHECK(worst_before > 1e-3);
    CHECK(sheet.coverage().travel_m.x > 0.3);
    CHECK(sheet.coverage().turn_rad > 0.6);
    CHECK(sheet.coverage().grasp_rad > 1.0);
}

TEST_CASE("worksheet: poses that stand still count once") {
    CalibrationWorksheet sheet;
    sheet.begin(paper_device(), MotorCalibration{});
    CHECK(sheet.add_pose(CountArray{}));
    CHECK_FALSE(sheet.add_pose(CountArray{}));
    CountArray moved{};
    moved[3] = 119; // 2.99 mm
    CHECK_FALSE(sheet.add_pose(moved));
    moved[3] = 120;
    CHECK(sheet.add_pose(moved));
    CHECK(sheet.poses().size() == 2);
    sheet.clear_poses();
    CHECK(sheet.poses().empty());
    CHECK(sheet.coverage().poses == 0);
}

TEST_CASE(
    "worksheet: the ruler gives scale, sign of winding and spread, and refuses what cannot be") {
    CalibrationWorksheet sheet;
    sheet.begin(paper_device(), MotorCalibration{});
    const double scale = -1.03 * kPaperMetresPerCount; // wound the other way
    const auto count = [&](double length_m) {
        return static_cast<std::int32_t>(std::lround((length_m - 0.39) / scale));
    };
    CHECK(sheet.add_length(2, count(0.30), 0.30).empty());
    CHECK(sheet.length_fit(2).status == Status::too_few_samples);
    // Repeats of one length, a count apart, are a spread and no scale.
    CHECK(sheet.add_length(2, count(0.30) + 2, 0.30).empty());
    CHECK(sheet.length_fit(2).status == Status::too_few_samples);
    CHECK(sheet.add_length(2, count(0.45), 0.45).empty());
    CHECK(sheet.add_length(2, count(0.45) - 2, 0.45).empty());
    const StringScaleFit fit = sheet.length_fit(2);
    CHECK(fit.scale_m_per_count == doctest::Approx(scale).epsilon(1e-3));
    CHECK(fit.repeated_points == 2);
    CHECK(fit.repeat_spread_m > 2e-5);
    CHECK(fit.repeat_spread_m < 1e-4);
    CHECK(sheet.measured().strings.scale_m_per_count[2] == fit.scale_m_per_count);
    CHECK(sheet.measured().strings.scale_m_per_count[1] == kPaperMetresPerCount);

    const std::string refused = sheet.add_length(2, count(0.45), 0.90);
    CHECK(refused.find("string 3") != std::string::npos);
    CHECK(sheet.lengths(2).size() == 4); // left out
    CHECK(sheet.add_length(2, 0, NAN).find("length_m is nan m") == 0);
    CHECK(sheet.add_length(2, 0, -0.1).find("length_m") == 0);
    CHECK(sheet.lengths(2).size() == 4);
}

TEST_CASE(
    "worksheet: readings at home that differ are refused, and a reversed encoder turns the scale") {
    CalibrationWorksheet sheet;
    sheet.begin(paper_device(), MotorCalibration{});
    CHECK(sheet.zero().status == Status::too_few_samples);
    CHECK(sheet.add_zero(CountArray{}).empty());
    CountArray far{};
    far[6] = 2000; // 50 mm
    const std::string refused = sheet.add_zero(far);
    CHECK(refused.find("String 7") == 0);
    CHECK(sheet.zero_repeats() == 1);
    CHECK(sheet.zero().spread_m[6] == 0.0);
    sheet.set_reversed(6, true);
    CHECK(sheet.measured().strings.scale_m_per_count[6] == -kPaperMetresPerCount);
    CHECK(sheet.measured().strings.scale_m_per_count[5] == kPaperMetresPerCount);
}

TEST_CASE("worksheet: weights give the motor gain, friction cancels, the current that held stays") {
    Draw draw(3);
    const MotorCalibration motors;
    CalibrationWorksheet sheet;
    sheet.begin(paper_device(), motors);
    // True gain 0.9: 2 N are held by 2 / 0.9 N commanded, 0.1 N of friction either way.
    const double held = 2.0 / 0.9;
    CHECK(sheet.add_weight(4, {2.0, held + 0.1, held - 0.1}).empty());
    CHECK(sheet.add_weight(4, {2.0, held + 0.12, held - 0.08}).empty());
    const WeightFit fit = sheet.weight_fit(4);
    CHECK(fit.repeats == 2);
    CHECK(fit.gain == doctest::Approx(0.9).epsilon(0.01));
    CHECK(fit.friction_n == doctest::Approx(0.1));
    CHECK(fit.spread > 0.0);
    // With a thicker winding found: the current of the 2 N commanded before is that of the same real tension.
    DeviceModel found = paper_device();
    found.strings.scale_m_per_count[4] *= 1.05;
    const MotorCalibration after = sheet.motors(found);
    StringArray commanded{};
    commanded[4] = 2.0 / fit.gain;
    const double current = currents_from_tensions(motors, commanded)[4];
    CHECK(current * motor_scale(after).tension_per_ampere_n_a[4] == doctest::Approx(2.0));
    CHECK(after.effective_radius_m[4] == doctest::Approx(1.05 * 0.008));
    CHECK(after.tension_gain[3] == 1.0);

    CHECK(sheet.add_weight(4, {2.0, 5.0, 4.8}).find("weight_n 2 N") == 0);
    CHECK(sheet.add_weight(4, {2.0, 0.0, 0.0}).find("weight_n 2 N") == 0);
    CHECK(sheet.add_weight(4, {NAN, 2.0, 2.0}).find("weight_n nan N") == 0);
    CHECK(sheet.weight_fit(4).repeats == 2);
}

TEST_CASE("worksheet: a wrong frame is refused with the contradiction") {
    Draw draw(11);
    DeviceModel truth = paper_device();
    truth.frame = make_box_frame(Vec3(0.24, 0.25, 0.22));
    truth.strings.offset_m = string_lengths(truth.frame, truth.grip, home());
    CalibrationWorksheet sheet;
    sheet.begin(paper_device(), MotorCalibration{});
    REQUIRE(sheet.add_zero(counts_at(truth, home(), 0.0, draw)).empty());
    for (int k = 0; k < 300; ++k) {
        sheet.add_pose(
            counts_at(truth, random_pose(draw, truth.grip, 0.15, 30.0, 30.0), 0.0, draw));
    }
    const SelfCalibrationResult found =
        self_calibrate(sheet.measured(), sheet.poses(), sheet.settings());
    CAPTURE(found.parity_rms_m);
    CHECK_FALSE(CalibrationWorksheet::refusal(found).empty());
    SelfCalibrationResult few;
    CHECK(CalibrationWorksheet::refusal(few) == describe(Status::too_few_samples));
}

TEST_CASE("worksheet: a motion that is too small is refused, however well it fits") {
    Draw draw(13);
    const DeviceModel truth = wrong_device(draw);
    CalibrationWorksheet sheet;
    sheet.begin(paper_device(), MotorCalibration{});
    REQUIRE(sheet.add_zero(counts_at(truth, home(), 0.0, draw)).empty());
    for (int k = 0; k < 400; ++k) {
        sheet.add_pose(counts_at(truth, random_pose(draw, truth.grip, 0.02, 0.0, 0.0), 1e-4, draw));
    }
    const SelfCalibrationResult found =
        self_calibrate(sheet.measured(), sheet.poses(), sheet.settings());
    CAPTURE(found.grip_error_rms_m);
    REQUIRE(usable(found.status));
    CHECK(found.parity_rms_m < kMostParity_m);
    CHECK(CalibrationWorksheet::refusal(found).find("Move the grip through more") !=
          std::string::npos);
}
