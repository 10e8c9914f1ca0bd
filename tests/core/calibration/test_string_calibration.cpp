#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <string>

#include "core/calibration/string_calibration.h"

using namespace spidar;

namespace {

StringCalibration paper_calibration() {
    StringArray home{};
    home.fill(0.4);
    return calibrate_at_home(home, CountArray{1, 2, 3, 4, 5, 6, 7, 8}, kPaperMetresPerCount);
}

bool mentions(const std::string &text, const char *part) {
    return text.find(part) != std::string::npos;
}

} // namespace

TEST_CASE("string calibration: one turn of the paper's pulley is its circumference") {
    const double circumference_m = 2.0 * 3.1415926535897932 * 0.008;
    CHECK(std::fabs(2000.0 * kPaperMetresPerCount - circumference_m) < 1e-16);
}

TEST_CASE("string calibration: home counts read the home lengths, a turn adds its circumference") {
    StringCalibration calibration = paper_calibration();
    calibration.scale_m_per_count[3] = -kPaperMetresPerCount; // wound the other way
    CountArray counts = calibration.zero_count;
    for (const double length : lengths_from_counts(calibration, counts)) {
        CHECK(length == 0.4);
    }
    for (std::int32_t &count : counts) {
        count += 2000;
    }
    const StringArray lengths = lengths_from_counts(calibration, counts);
    CHECK(std::fabs(lengths[0] - (0.4 + 2.0 * 3.1415926535897932 * 0.008)) < 1e-15);
    CHECK(std::fabs(lengths[3] - (0.4 - 2.0 * 3.1415926535897932 * 0.008)) < 1e-15);
}

TEST_CASE("string calibration: counts wrap around int32 without a jump") {
    StringCalibration calibration = paper_calibration();
    constexpr std::int32_t kHighest = std::numeric_limits<std::int32_t>::max();
    constexpr std::int32_t kLowest = std::numeric_limits<std::int32_t>::min();
    calibration.zero_count.fill(kHighest);
    CountArray counts{};
    counts.fill(kLowest); // one count further up
    for (const double length : lengths_from_counts(calibration, counts)) {
        CHECK(length == 0.4 + kPaperMetresPerCount);
    }
    calibration.zero_count.fill(kLowest);
    counts.fill(kHighest);
    for (const double length : lengths_from_counts(calibration, counts)) {
        CHECK(length == 0.4 - kPaperMetresPerCount);
    }
}

TEST_CASE("string calibration: validate names field, value, unit and remedy") {
    CHECK(validate(paper_calibration()).empty());
    StringCalibration bad = paper_calibration();
    bad.scale_m_per_count[4] = 0.0;
    CHECK(mentions(validate(bad), "scale_m_per_count[4] (string 5) is 0 m/count; give"));
    bad = paper_calibration();
    bad.scale_m_per_count[4] = -kPaperMetresPerCount;
    CHECK(validate(bad).empty());
    bad.scale_m_per_count[4] = std::numeric_limits<double>::quiet_NaN();
    CHECK(mentions(validate(bad), "scale_m_per_count[4] (string 5) is nan m/count"));
    bad = paper_calibration();
    bad.offset_m[7] = std::numeric_limits<double>::infinity();
    CHECK(mentions(validate(bad), "offset_m[7] (string 8) is inf m; give"));
}

TEST_CASE("string calibration: a drum's circumference, counted") {
    CHECK(metres_per_count(2000, 0.008, 1.0) == doctest::Approx(2.51327412e-5).epsilon(1e-8));
    CHECK(metres_per_count(0, 0.008, 3e-5) == 3e-5); // the device does not say
}
