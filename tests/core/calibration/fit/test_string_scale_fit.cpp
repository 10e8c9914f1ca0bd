#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "core/calibration/fit/string_scale_fit.h"
#include "core/calibration/home_zero.h"
#include "support/motion_samples.h"

using namespace spidar;
using namespace spidar::test;

TEST_CASE("string scale fit: exact pairs give the line, errors and spread zero") {
    std::vector<CountLengthPair> pairs;
    for (std::int32_t count = -4000; count <= 20000; count += 3000) {
        pairs.push_back({count, 0.005 + 2.6282e-5 * count});
    }
    const StringScaleFit fit = fit_string_scale(pairs);
    REQUIRE(fit.status == Status::ok);
    CHECK(fit.scale_m_per_count == doctest::Approx(2.6282e-5).epsilon(1e-13));
    CHECK(fit.offset_m == doctest::Approx(0.005).epsilon(1e-12));
    CHECK(fit.residual_max_m < 1e-15);
    CHECK(fit.repeated_points == 0);
    CHECK(fit.repeat_spread_m == 0.0);
}

TEST_CASE("string scale fit: the paper's Table 1") {
    // Counts of method 1 (length / 0.0251327 mm); research found 4.8200 mm + 2.62225e-5 m a count,
    // rms 0.75 mm.
    constexpr double kMeasured_m[] = {0.0915, 0.1868, 0.2820, 0.3789, 0.4759, 0.5708, 0.6654};
    std::vector<CountLengthPair> pairs;
    double real = 0.1;
    for (const double measured : kMeasured_m) {
        pairs.push_back({static_cast<std::int32_t>(std::lround(measured / 2.51327e-5)), real});
        real += 0.1;
    }
    const StringScaleFit fit = fit_string_scale(pairs);
    REQUIRE(fit.status == Status::ok);
    CHECK(fit.offset_m == doctest::Approx(0.0048200).epsilon(2e-3));
    CHECK(fit.scale_m_per_count == doctest::Approx(2.62225e-5).epsilon(1e-4));
    CHECK(fit.residual_rms_m == doctest::Approx(0.00075).epsilon(0.02));
    CHECK(fit.residual_max_m == doctest::Approx(0.00136).epsilon(0.02));
}

TEST_CASE("string scale fit: repeated trials give their spread, and errors that hold") {
    Draw draw(3);
    constexpr double kScale = 2.5e-5;
    double square = 0.0;
    double expected = 0.0;
    constexpr int kRuns = 200;
    for (int run = 0; run < kRuns; ++run) {
        std::vector<CountLengthPair> pairs;
        for (int point = 1; point <= 7; ++point) {
            for (int trial = 0; trial < 5; ++trial) {
                const double length = 0.1 * point;
                pairs.push_back({static_cast<std::int32_t>(
                                     std::lround((length + 5e-4 * draw.normal()) / kScale)),
                                 length});
            }
        }
        const StringScaleFit fit = fit_string_scale(pairs);
        CHECK(fit.repeated_points == 7);
        CHECK(fit.repeat_spread_m == doctest::Approx(5e-4).epsilon(0.5));
        square += std::pow(fit.scale_m_per_count - kScale, 2.0) / kRuns;
        expected += fit.scale_error_m_per_count / kRuns;
    }
    CHECK(std::sqrt(square) == doctest::Approx(expected).epsilon(0.2));
}

TEST_CASE("string scale fit: bad input has a status") {
    CHECK(fit_string_scale({}).status == Status::too_few_samples);
    CHECK(fit_string_scale({{5, 0.1}, {5, 0.2}}).status == Status::too_few_samples);
    const std::vector<CountLengthPair> bad{{1, std::numeric_limits<double>::quiet_NaN()}, {2, 0.1}};
    CHECK(fit_string_scale(bad).status == Status::not_finite);
}

TEST_CASE("home zero: the median of the repeats reads the home pose") {
    const DeviceModel device = paper_device();
    const GripPose home = pose_at(device.grip, Vec3(0.01, -0.02, 0.0), Vec3(0.1, 0.0, 0.0), 0.0);
    std::vector<CountArray> repeats(5);
    for (std::size_t k = 0; k < repeats.size(); ++k) {
        repeats[k].fill(100 + static_cast<std::int32_t>(k)); // 100..104: spread sqrt(2.5)
    }
    repeats[4].fill(104);
    const StringArray &scale = device.strings.scale_m_per_count;
    const HomeZero zero =
        zero_at_pose(device.frame, device.grip, home, repeats, scale, LengthCorrections{});
    REQUIRE(zero.status == Status::ok);
    CountArray counts{};
    counts.fill(102);
    const StringArray lengths = lengths_from_counts(zero.strings, counts);
    const StringArray wanted = string_lengths(device.frame, device.grip, home);
    for (std::size_t i = 0; i < kStringCount; ++i) {
        CHECK(lengths[i] == wanted[i]);
        CHECK(zero.spread_m[i] == doctest::Approx(std::sqrt(2.5) * scale[i]));
    }
    CHECK(zero_at_pose(device.frame, device.grip, home, {}, scale, LengthCorrections{}).status ==
          Status::too_few_samples);
    CHECK(zero_at_pose(device.frame, device.grip, home, repeats, StringArray{}, LengthCorrections{})
              .status == Status::invalid_calibration);
    CHECK(zero_at_pose(FrameGeometry{}, device.grip, home, repeats, scale, LengthCorrections{})
              .status == Status::invalid_geometry);
}
