// All measurements of one calibration session and what follows from them: wiring, zero at home,
// lengths by the ruler, free motion, weights. Measurements that cannot be true are refused with the
// reason. Allocates: not for the servo loop.
#pragma once

#include <string>
#include <vector>

#include "core/calibration/fit/self_calibration.h"
#include "core/calibration/fit/string_scale_fit.h"
#include "core/calibration/home_zero.h"
#include "core/calibration/motor_calibration.h"

namespace spidar {

// A pose is kept when some string's length differs by this much from the last kept pose.
inline constexpr double kPoseStep_m = 0.003;
// Largest number of poses kept, which bounds the time of a fit.
inline constexpr std::size_t kMostPoses = 3000;
// Largest rms contradiction of the eight lengths that is accepted after a fit. Noise and stretch of
// a sound device stay below 0.2 mm; a slipping string, a wrong frame or a wrong preset gives
// millimeters.
inline constexpr double kMostParity_m = 0.0005;
// Largest expected error of the grip center after a fit: ten times that of 300 varied poses.
inline constexpr double kMostGripError_m = 0.0005;
// Largest relative difference of a ruler scale from the nominal one. The paper's winding explains
// 4.3 %; a larger difference than this limit is a misread ruler or another string.
inline constexpr double kMostScaleError = 0.2;
// Smallest range of lengths for a scale: half a millimeter of reading error is 1 % of it.
inline constexpr double kLeastLengthRange_m = 0.05;
// Largest relative difference between a weight and the commanded tension that balances it.
inline constexpr double kMostGainError = 0.5;
// Largest standard deviation of readings at the home pose; above it the grip was not in one place.
inline constexpr double kMostHomeSpread_m = 0.005;

struct WeightReading {
    double weight_n = 0.0;
    // Commanded tension at which the weight rose.
    double rise_n = 0.0;
    // Commanded tension at which the weight sank.
    double fall_n = 0.0;
};

struct WeightFit {
    double gain = 1.0;   // real tension over tension commanded by the present motor calibration
    double spread = 0.0; // standard deviation of the repeats' gains; 0 for one repeat
    // Mean of half the difference between rise_n and fall_n.
    double friction_n = 0.0;
    int repeats = 0;
};

// How much of the workspace the kept poses cover.
struct Coverage {
    int poses = 0; // kept poses that could be solved
    Vec3 travel_m{0.0};
    double turn_rad = 0.0; // largest rotation from upright
    double grasp_rad = 0.0;
};

class CalibrationWorksheet {
public:
    // Discards all measurements. start: nominal frame and grip, and the present string calibration.
    void begin(const DeviceModel &start, const MotorCalibration &motors);

    // reversed: true if the encoder of this string (0-7) counts the wrong way.
    void set_reversed(std::size_t string, bool reversed) { reversed_[string] = reversed; }
    [[nodiscard]] bool reversed(std::size_t string) const { return reversed_[string]; }

    // add_zero(), add_length() and add_weight() return an empty string, or the sentence that
    // refuses the measurement. counts: read with the grip at home.
    std::string add_zero(const CountArray &counts);
    // length_m: ruler length from exit to grip at this count.
    std::string add_length(std::size_t string, std::int32_t count, double length_m);
    // Refuses a weight that differs by more than kMostGainError from the mean of rise_n and fall_n.
    std::string add_weight(std::size_t string, const WeightReading &reading);
    // Returns true when the pose was kept: some length differs by kPoseStep_m from the last kept
    // pose, and fewer than kMostPoses were kept.
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
    // String calibration from the home readings. too_few_samples before the first add_zero().
    [[nodiscard]] HomeZero zero() const;
    // Returns too_few_samples until two lengths lie kLeastLengthRange_m apart.
    [[nodiscard]] StringScaleFit length_fit(std::size_t string) const;
    [[nodiscard]] WeightFit weight_fit(std::size_t string) const;
    [[nodiscard]] const Coverage &coverage() const { return coverage_; }

    // The model as begin() received it.
    [[nodiscard]] const DeviceModel &before() const { return start_; }
    // The model after wiring, ruler and zero, from which self-calibration starts.
    [[nodiscard]] DeviceModel measured() const;
    // Returns settings that fit offsets and gains. If all eight strings have a scale by the ruler,
    // the gains have a prior of 0.2 % and no size is taken as true.
    [[nodiscard]] SelfCalibrationSettings settings() const;
    // Returns why a fit result must not be used, or an empty string.
    [[nodiscard]] static std::string refusal(const SelfCalibrationResult &result);
    // Returns the motor calibration with the gains of the weights and the winding radii that match
    // the string scales of `found`.
    [[nodiscard]] MotorCalibration motors(const DeviceModel &found) const;
    // Returns, per string, the rms difference between measured lengths and those of the best pose,
    // over at most 599 of the kept poses (unit: m). NaN if no pose could be solved.
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
