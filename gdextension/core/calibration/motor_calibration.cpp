#include "core/calibration/motor_calibration.h"

#include <algorithm>
#include <cmath>

#include "core/base/describe_value.h"
#include "core/base/finite.h"

namespace spidar {

namespace {

// Ranges far wider than any motor for a hand-held device: they detect unit errors.
constexpr double kMaxRadius_m = 1.0;
constexpr double kMaxTorqueConstant_nm_a = 100.0;
constexpr double kMaxTensionGain = 100.0;
constexpr double kMaxCurrent_a = 1000.0;
constexpr double kSmallest = 1e-6;

// Returns newtons of real tension per ampere; 0 where the calibration is not a positive number.
double tension_per_ampere(const MotorCalibration &calibration, std::size_t i) noexcept {
    const double radius = calibration.effective_radius_m[i];
    const double torque_constant = calibration.torque_constant_nm_a[i];
    const double gain = calibration.tension_gain[i];
    const double ratio = gain * torque_constant / radius;
    return radius > 0.0 && positive_finite(ratio) ? ratio : 0.0;
}

double current_limit(const MotorCalibration &calibration, std::size_t i) noexcept {
    const double limit = calibration.max_current_a[i];
    return positive_finite(limit) ? limit : 0.0;
}

std::string range_message(const char *field, std::size_t i, double value, const char *unit,
                          double highest, const char *what) {
    return range_sentence(element_name(field, i), value, unit,
                          std::string("give ") + what + " between " + with_unit(kSmallest, unit) +
                              " and " + with_unit(highest, unit) + ".");
}

bool in_range(double value, double highest) {
    return value >= kSmallest && value <= highest;
}

} // namespace

StringArray currents_from_tensions(const MotorCalibration &calibration,
                                   const StringArray &tensions_n) noexcept {
    return currents_from_tensions(motor_scale(calibration), tensions_n);
}

MotorScale motor_scale(const MotorCalibration &calibration) noexcept {
    MotorScale scale;
    for (std::size_t i = 0; i < kStringCount; ++i) {
        scale.tension_per_ampere_n_a[i] = tension_per_ampere(calibration, i);
        scale.limit_a[i] = current_limit(calibration, i);
    }
    return scale;
}

StringArray currents_from_tensions(const MotorScale &scale,
                                   const StringArray &tensions_n) noexcept {
    StringArray currents_a{};
    StringArray wanted_a{};
    for (std::size_t i = 0; i < kStringCount; ++i) {
        wanted_a[i] = tensions_n[i] / scale.tension_per_ampere_n_a[i];
    }
    for (std::size_t i = 0; i < kStringCount; ++i) {
        // Without tension or calibration the current is 0 A, whatever the division gave.
        const bool pulls = tensions_n[i] >= 0.0 && scale.tension_per_ampere_n_a[i] > 0.0;
        const bool within = wanted_a[i] <= scale.limit_a[i];
        currents_a[i] = !pulls ? 0.0 : within ? wanted_a[i] : scale.limit_a[i];
    }
    return currents_a;
}

StringArray max_tensions(const MotorCalibration &calibration) noexcept {
    StringArray tensions{};
    for (std::size_t i = 0; i < kStringCount; ++i) {
        tensions[i] = current_limit(calibration, i) * tension_per_ampere(calibration, i);
    }
    return tensions;
}

std::string validate(const MotorCalibration &calibration) {
    for (std::size_t i = 0; i < kStringCount; ++i) {
        if (!in_range(calibration.effective_radius_m[i], kMaxRadius_m)) {
            return range_message("effective_radius_m", i, calibration.effective_radius_m[i], "m",
                                 kMaxRadius_m, "the winding radius in meters,");
        }
        if (!in_range(calibration.torque_constant_nm_a[i], kMaxTorqueConstant_nm_a)) {
            return range_message("torque_constant_nm_a", i, calibration.torque_constant_nm_a[i],
                                 "N m/A", kMaxTorqueConstant_nm_a,
                                 "the motor's data sheet value in N m/A,");
        }
        if (!in_range(calibration.tension_gain[i], kMaxTensionGain)) {
            return range_message("tension_gain", i, calibration.tension_gain[i], "N/N",
                                 kMaxTensionGain,
                                 "real over commanded tension (1 if not measured),");
        }
        if (!in_range(calibration.max_current_a[i], kMaxCurrent_a)) {
            return range_message("max_current_a", i, calibration.max_current_a[i], "A",
                                 kMaxCurrent_a, "the amplifier's limit in amperes,");
        }
    }
    return {};
}

} // namespace spidar
