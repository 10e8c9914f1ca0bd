// Settings of serial motor boards in a SpidarGConfig.
#include <cmath>

#include "core/calibration/motor_calibration.h"
#include "godot/settings/spidar_g_config.h"

namespace {

constexpr int kNumbersPerMotor = 4; // board, motor, sign of the counts, sign of the current
constexpr int kMostBoard = 7;
constexpr int kMostMotor = 7;
constexpr int kMostUnits = 4095; // limit of every board model

} // namespace

std::string SpidarGConfig::serial_problem() const {
    const auto told = [](const std::string &field, const std::string &remedy) {
        return "SpidarGConfig." + field + ": " + remedy;
    };
    if (!(serial_units_per_ampere_ >= 0.0 && std::isfinite(serial_units_per_ampere_))) {
        return told(
            "serial_units_per_ampere = " + std::to_string(serial_units_per_ampere_) + " units/A",
            "give how many units of the board make one ampere, or 0 for the value of the preset.");
    }
    if (serial_most_units_ < 1 || serial_most_units_ > kMostUnits) {
        return told("serial_most_units = " + std::to_string(serial_most_units_) + " units",
                    "choose 1 to 4095; 1024 is the maximum of a B5M.");
    }
    const std::int64_t numbers = serial_motors_.size();
    if (numbers == 0) {
        return {};
    }
    if (numbers != std::int64_t{kNumbersPerMotor} * spidar::kStringCount) {
        return told(
            "serial_motors has " + std::to_string(numbers) + " numbers",
            "give 4 for each of the 8 strings (board, motor, sign of the counts, sign of the "
            "current), or none.");
    }
    for (std::int64_t i = 0; i < numbers; i += kNumbersPerMotor) {
        const auto is_sign = [](int value) { return value == 1 || value == -1; };
        if (serial_motors_[i] < 0 || serial_motors_[i] > kMostBoard || serial_motors_[i + 1] < 0 ||
            serial_motors_[i + 1] > kMostMotor || !is_sign(serial_motors_[i + 2]) ||
            !is_sign(serial_motors_[i + 3])) {
            return told("serial_motors of string " + std::to_string(i / kNumbersPerMotor + 1),
                        "choose a board from 0 to 7, a motor from 0 to 7, and signs of 1 or -1.");
        }
    }
    return {};
}

std::string SpidarGConfig::told_of(const std::string &problem) {
    return (problem.starts_with("serial_port") ? "SpidarGConfig." : "") + problem;
}

spidar::SerialTransportSettings SpidarGConfig::serial_settings() const {
    spidar::SerialTransportSettings settings;
    settings.port = serial_port_.utf8().get_data();
    const spidar::BoardWiring wiring =
        preset_ == kPresetCustom ? spidar::BoardWiring() : preset_device().boards;
    if (serial_units_per_ampere_ > 0.0) {
        settings.units_per_a = serial_units_per_ampere_;
    } else if (wiring.units_per_newton > 0.0) {
        const spidar::MotorScale motors = spidar::motor_scale(spidar::MotorCalibration());
        settings.units_per_a = wiring.units_per_newton * motors.tension_per_ampere_n_a[0];
    }
    settings.most_units = serial_most_units_;
    settings.motors_in_order = serial_motors_.size() == 0;
    for (std::size_t i = 0; i < settings.motors.size(); ++i) {
        settings.motors[i].count_sign = wiring.count_signs[i];
        settings.motors[i].current_sign = wiring.current_signs[i];
    }
    for (std::size_t i = 0; i < settings.motors.size() && !settings.motors_in_order; ++i) {
        const auto at = static_cast<std::int64_t>(i) * kNumbersPerMotor;
        settings.motors[i] = {serial_motors_[at], serial_motors_[at + 1], serial_motors_[at + 2],
                              serial_motors_[at + 3]};
    }
    return settings;
}
