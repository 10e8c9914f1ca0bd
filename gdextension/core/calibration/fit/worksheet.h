// Everything that is measured while one device is calibrated, and what follows from it: wiring, zero at home, lengths by
// the ruler, free motion, weights. Refuses what cannot be true, with the reason. Allocates: not for the servo loop.
#pragma once

#include <string>
#include <vector>

#include "core/calibration/fit/self_calibration.h"
#include "core/calibration/fit/string_scale_fit.h"
#include "core/calibration/home_zero.h"
#include "core/calibration/motor_calibration.h"

namespace spidar {

// Two poses of the free motion count as different when a string has changed by this much.
inline constexpr double kPoseStep_m = 0.003;
inline constexpr std::size_t kMostPoses = 3000;
// What the eight lengths may contradict each other by after a fit. Noise and stretch of a sound device stay below
// 0.2 mm; a slipping string, a wrong frame or a wrong preset is millimetres.
inline constexpr double kMostParity_m = 0.0005;
// Expected error of the grip above which a motion has told too little: ten times what 300 varied poses leave.
inline constexpr double kMostGripError_m = 0.0005;
// Ruler scales further than this from nominal are slips of the pen or another string (paper: 4.3 % by winding).
inline constexpr double kMostScaleError = 0.2;
// Lengths nearer together than this tell no scale: half a millimetre of reading error would be 1 % of it.
inline constexpr double kLeastLengthRange_m = 0.05;
// The same for a motor against its data sheet.
inline constexpr double kMostGainError = 0.5;
// Repeats of the home pose that differ by more are not the same pose.
inline constexpr double kMostHomeSpread_m = 0.005;

struct WeightReading {
    double weight_n = 0.0;
    double rise_n = 0.0; // commanded tension at which the weight rose, and at which it sank
    double fall_n = 0.0;
};

struct WeightFit {
    double gain = 1.0;   // real tension over tension commanded by the motor calibration in use
    double spread = 0.0; // standard deviation of the repeats' gains; 0 with one
    double friction_n = 0.0;
    int repeats = 0;
};

// How much of the workspace the poses cover: largest less smallest.
struct Coverage {
    int poses = 0;
    Vec3 travel_m{0.0};
    double turn_rad = 0.0; // largest turn from upright
    double grasp_rad = 0.0;
};

class CalibrationWorksheet {
public:
    // start: nominal frame and grip, strings as they are assumed now. Forgets everything.
    void begin(const DeviceModel &start, const MotorCalibration &motors);

    // Encoder of string i counts the wrong way.
    void set_reversed(std::size_t string, bool reversed) { reversed_[string] = reversed; }
    [[nodiscard]] bool reversed(std::size_t string) const { return reversed_[string]; }

    // Each adds a measurement; the sentence that refuses it, or empty.
    std::string add_zero(const CountArray &counts);
    std::string add_length(std::size_t string, std::int32_t count, double length_m);
    std::string add_weight(std::size_t string, const WeightReading &reading);
    // True: far enough from the last pose, and kept.
    bool add_pose(const CountArray &counts);

    void clear_zero() { zeros_.clear(); }
    void clear_lengths(std::size_t string) { lengths_[string].clear(); }
    void clear_weights(std::size_t string) { weights_[string].clear(); }
    void clear_poses();

    [[nodiscard]] const std::vector<CountArray> &poses() const { return poses_; }
    [[nodiscard]] std::size_t zero_repeats() const { return zeros_.size(); }
    [[nodiscard]] const std::vector<CountLengthPair> &lengths(std::size_t string) const {
        return lengths_[string];
    }
    [[nodiscard]] HomeZero zero() const;
    // too_few_samples: not yet two lengths kLeastLengthRange_m apart.
    [[nodiscard]] StringScaleFit length_fit(std::size_t string) const;
    [[nodiscard]] WeightFit weight_fit(std::size_t string) const;
    [[nodiscard]] const Coverage &coverage() const { return coverage_; }

    // As it was when begun, and after wiring, ruler and zero: where self-calibration starts.
    [[nodiscard]] const DeviceModel &before() const { return start_; }
    [[nodiscard]] DeviceModel measured() const;
    [[nodiscard]] SelfCalibrationSettings settings() const;
    // Why a result may not be used; empty: it may.
    [[nodiscard]] static std::string refusal(const SelfCalibrationResult &result);
    // Motor calibration with the weights' gains, and the winding radii that go with these string scales.
    [[nodiscard]] MotorCalibration motors(const DeviceModel &found) const;
    // Root mean square over the poses of what no pose explains, a string (unit: m). NaN: no pose fits its lengths.
    [[nodiscard]] StringArray residuals(const DeviceModel &model) const;

private:
    DeviceModel start_;
    MotorCalibration motors_;
    std::array<bool, kStringCount> reversed_{};
    std::vector<CountArray> zeros_;
    std::array<std::vector<CountLengthPair>, kStringCount> lengths_;
    std::array<std::vector<WeightReading>, kStringCount> weights_;
    std::vector<CountArray> poses_;
    Coverage coverage_;
    Vec3 low_m_{0.0};
    Vec3 high_m_{0.0};
    double least_grasp_rad_ = 0.0;
    double most_grasp_rad_ = 0.0;
};

} // namespace spidar
