#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <string>

#include "core/calibration/motor_calibration.h"

using namespace spidar;

namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

} // namespace

TEST_CASE("motor calibration: current is tension times radius over torque constant") {
    MotorCalibration calibration;
    calibration.effective_radius_m[2] = 0.00837; // what the paper's length fit finds
    calibration.tension_gain[3] = 0.8;           // pulls too little: needs more current
    StringArray tensions{};
    tensions.fill(5.0);
    const StringArray current_a = currents_from_tensions(calibration, tensions);
    CHECK(std::fabs(current_a[0] - 5.0 * 0.008 / 0.0438) < 1e-15);
    CHECK(std::fabs(current_a[2] - 5.0 * 0.00837 / 0.0438) < 1e-15);
    CHECK(std::fabs(current_a[3] - 5.0 * 0.008 / (0.0438 * 0.8)) < 1e-15);
    const StringArray per_ampere_n_a = motor_scale(calibration).tension_per_ampere_n_a;
    for (std::size_t i = 0; i < kStringCount; ++i) {
        CHECK(std::fabs(current_a[i] * per_ampere_n_a[i] - 5.0) < 1e-14);
    }
}

TEST_CASE("motor calibration: never NaN, negative or above the limit") {
    const MotorCalibration calibration;
    const StringArray tensions{kNan, kInfinity, -kInfinity, -1.0, 0.0, 1e300, 1e-300, 5.0};
    const StringArray current_a = currents_from_tensions(calibration, tensions);
    CHECK(current_a[0] == 0.0);
    CHECK(current_a[1] == 4.0);
    CHECK(current_a[2] == 0.0);
    CHECK(current_a[3] == 0.0);
    CHECK(current_a[4] == 0.0);
    CHECK(current_a[5] == 4.0);
    CHECK(std::fabs(max_tensions(calibration)[5] - 4.0 * 0.0438 / 0.008) < 1e-13);
}

TEST_CASE("motor calibration: a broken calibration gives no current at all") {
    StringArray tensions{};
    tensions.fill(5.0);
    for (const double bad : {kNan, 0.0, -0.008, kInfinity}) {
        MotorCalibration calibration;
        calibration.effective_radius_m[0] = bad;
        calibration.torque_constant_nm_a[1] = bad;
        calibration.tension_gain[2] = bad;
        calibration.max_current_a[3] = bad;
        const StringArray current_a = currents_from_tensions(calibration, tensions);
        CAPTURE(bad);
        for (std::size_t i = 0; i < 4; ++i) {
            CHECK(current_a[i] == 0.0);
        }
        CHECK(current_a[4] > 0.0);
        CHECK_FALSE(validate(calibration).empty());
    }
}

TEST_CASE("motor calibration: validate names field, value, unit and remedy") {
    CHECK(validate(MotorCalibration{}).empty());
    MotorCalibration bad;
    bad.torque_constant_nm_a[5] = -0.0438;
    CHECK(validate(bad).find("torque_constant_nm_a[5] (string 6) is -0.0438 N m/A; give") == 0);
    bad = MotorCalibration{};
    bad.effective_radius_m[1] = 8.0;
    CHECK(validate(bad).find("effective_radius_m[1] (string 2) is 8 m; give") == 0);
}
