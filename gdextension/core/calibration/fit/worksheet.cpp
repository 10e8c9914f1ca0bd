#include "core/calibration/fit/worksheet.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/describe_value.h"
#include "core/kinematics/forward_kinematics.h"

namespace spidar {

namespace {

// Number of poses over which a residual is averaged: more change nothing in its second digit.
constexpr std::size_t kResidualPoses = 300;
// Accuracy of scales found by ruler (docs/why/calibration_mathematics.md), in place of the 5 % of a winding.
constexpr double kRulerGainPrior = 0.002;

std::string percent(double ratio) {
    return with_unit(std::round(1000.0 * ratio) / 10.0, "%");
}

double turn_of(const Mat3 &rotation) {
    const double trace = rotation[0][0] + rotation[1][1] + rotation[2][2];
    return std::acos(std::clamp(0.5 * (trace - 1.0), -1.0, 1.0));
}

} // namespace

void CalibrationWorksheet::begin(const DeviceModel &start, const MotorCalibration &motors) {
    *this = CalibrationWorksheet();
    start_ = start;
    motors_ = motors;
}

std::string CalibrationWorksheet::add_zero(const CountArray &counts) {
    zeros_.push_back(counts);
    const HomeZero found = zero();
    std::string problem;
    if (!usable(found.status)) {
        problem = describe(found.status);
    }
    for (std::size_t i = 0; i < kStringCount && problem.empty(); ++i) {
        if (!(found.spread_m[i] <= kMostHomeSpread_m)) {
            problem = "String " + std::to_string(i + 1) + " was " +
                      with_unit(found.spread_m[i], "m") +
                      " (standard deviation) away from its other readings at home; the limit is " +
                      with_unit(kMostHomeSpread_m, "m") +
                      ". Put the grip into its stand, keep the strings taut, and read again.";
        }
    }
    if (!problem.empty()) {
        zeros_.pop_back();
    }
    return problem;
}

std::string CalibrationWorksheet::add_length(std::size_t string, std::int32_t count,
                                             double length_m) {
    std::vector<CountLengthPair> &pairs = lengths_[string];
    const double nominal = std::fabs(start_.strings.scale_m_per_count[string]);
    // No string is longer than the frame's diagonal; twice that leaves room for guides.
    double longest = 0.0;
    for (const Vec3 &motor : start_.frame.motors_m) {
        longest = std::fmax(longest, 4.0 * std::sqrt(glm::dot(motor, motor)));
    }
    if (!(length_m > 0.0 && length_m <= longest)) {
        return range_sentence("length_m", length_m, "m",
                              "give the string's length from its exit to the grip, above 0 and up "
                              "to " +
                                  with_unit(longest, "m") + ".");
    }
    pairs.push_back({count, length_m});
    const StringScaleFit fit = length_fit(string);
    const double error = std::fabs(fit.scale_m_per_count) / nominal - 1.0;
    if (usable(fit.status) && !(std::fabs(error) <= kMostScaleError)) {
        pairs.pop_back();
        return "With length_m " + with_unit(length_m, "m") + " the scale of string " +
               std::to_string(string + 1) + " would be " + percent(error) +
               " off the nominal scale; the limit is " + percent(kMostScaleError) +
               ". Check the ruler's reading and that it is this string; the reading was ignored.";
    }
    return {};
}

StringScaleFit CalibrationWorksheet::length_fit(std::size_t string) const {
    const std::vector<CountLengthPair> &pairs = lengths_[string];
    const auto [least, most] = std::minmax_element(
        pairs.begin(), pairs.end(),
        [](const CountLengthPair &a, const CountLengthPair &b) { return a.length_m < b.length_m; });
    if (pairs.empty() || most->length_m - least->length_m < kLeastLengthRange_m) {
        return {};
    }
    return fit_string_scale(pairs);
}

std::string CalibrationWorksheet::add_weight(std::size_t string, const WeightReading &reading) {
    const double mean = 0.5 * (reading.rise_n + reading.fall_n);
    const double gain = reading.weight_n / mean;
    if (!(mean > 0.0) || !(std::fabs(gain - 1.0) <= kMostGainError)) {
        return "weight_n " + with_unit(reading.weight_n, "N") + " was balanced by a commanded " +
               with_unit(mean, "N") + ", and the two differ by more than " +
               percent(kMostGainError) +
               ". Check the weight (1 kg is 9.81 N) and that it hangs on this string.";
    }
    weights_[string].push_back(reading);
    return {};
}

bool CalibrationWorksheet::add_pose(const CountArray &counts) {
    if (poses_.size() >= kMostPoses) {
        return false;
    }
    if (!poses_.empty()) {
        double most = 0.0;
        for (std::size_t i = 0; i < kStringCount; ++i) {
            const double change = static_cast<double>(counts[i]) - poses_.back()[i];
            most = std::max(most, std::fabs(change * start_.strings.scale_m_per_count[i]));
        }
        if (!(most >= kPoseStep_m)) {
            return false;
        }
    }
    poses_.push_back(counts);
    const DeviceModel model = measured();
    ForwardKinematics kinematics;
    if (!usable(kinematics.configure(model.frame, model.grip))) {
        return true;
    }
    const KinematicsResult solved =
        kinematics.solve_cold(wound_lengths(model.strings, model.corrections, counts));
    if (!usable(solved.status)) {
        return true; // kept: the fit leaves it out if it stays unsolvable
    }
    const GripFrame frame = frame_of(solved.pose, Mat3(1.0));
    const bool first = coverage_.poses == 0;
    for (int axis = 0; axis < 3; ++axis) {
        const double at = solved.pose.position_m[axis];
        low_m_[axis] = first ? at : std::fmin(low_m_[axis], at);
        high_m_[axis] = first ? at : std::fmax(high_m_[axis], at);
    }
    const double grasp = frame.grasp_angle_rad;
    least_grasp_rad_ = first ? grasp : std::fmin(least_grasp_rad_, grasp);
    most_grasp_rad_ = first ? grasp : std::fmax(most_grasp_rad_, grasp);
    ++coverage_.poses;
    coverage_.travel_m = high_m_ - low_m_;
    coverage_.turn_rad = std::fmax(coverage_.turn_rad, turn_of(frame.rotation));
    coverage_.grasp_rad = most_grasp_rad_ - least_grasp_rad_;
    return true;
}

void CalibrationWorksheet::clear_poses() {
    poses_.clear();
    coverage_ = {};
}

HomeZero CalibrationWorksheet::zero() const {
    StringArray scale = start_.strings.scale_m_per_count;
    for (std::size_t i = 0; i < kStringCount; ++i) {
        scale[i] = reversed_[i] ? -scale[i] : scale[i];
        const StringScaleFit fit = length_fit(i);
        scale[i] = usable(fit.status) ? fit.scale_m_per_count : scale[i];
    }
    return zero_at_pose(start_.frame, start_.grip, rest_pose(start_.grip), zeros_, scale,
                        start_.corrections);
}

WeightFit CalibrationWorksheet::weight_fit(std::size_t string) const {
    WeightFit fit;
    std::vector<double> gains;
    for (const WeightReading &reading : weights_[string]) {
        gains.push_back(reading.weight_n / (0.5 * (reading.rise_n + reading.fall_n)));
        fit.friction_n += 0.5 * (reading.rise_n - reading.fall_n);
    }
    if (gains.empty()) {
        return fit;
    }
    const auto n = static_cast<double>(gains.size());
    fit.repeats = static_cast<int>(gains.size());
    fit.friction_n /= n;
    fit.gain = 0.0;
    for (const double gain : gains) {
        fit.gain += gain / n;
    }
    for (const double gain : gains) {
        fit.spread += gains.size() > 1 ? (gain - fit.gain) * (gain - fit.gain) / (n - 1.0) : 0.0;
    }
    fit.spread = std::sqrt(fit.spread);
    return fit;
}

DeviceModel CalibrationWorksheet::measured() const {
    DeviceModel model = start_;
    for (std::size_t i = 0; i < kStringCount; ++i) {
        if (reversed_[i]) {
            model.strings.scale_m_per_count[i] = -model.strings.scale_m_per_count[i];
        }
        const StringScaleFit fit = length_fit(i);
        if (usable(fit.status)) {
            model.strings.scale_m_per_count[i] = fit.scale_m_per_count;
            model.strings.offset_m[i] = fit.offset_m;
            model.strings.zero_count[i] = 0;
        }
    }
    const HomeZero found = zero();
    if (usable(found.status)) {
        model.strings = found.strings;
    }
    return model;
}

SelfCalibrationSettings CalibrationWorksheet::settings() const {
    SelfCalibrationSettings settings;
    settings.fit_gains = true;
    bool by_ruler = true;
    for (std::size_t i = 0; i < kStringCount; ++i) {
        by_ruler = by_ruler && usable(length_fit(i).status);
    }
    if (by_ruler) {
        settings.gain_prior = kRulerGainPrior;
        settings.true_size = TrueSize::none;
    }
    return settings;
}

std::string CalibrationWorksheet::refusal(const SelfCalibrationResult &result) {
    if (!usable(result.status)) {
        return describe(result.status);
    }
    if (!(result.parity_rms_m <= kMostParity_m)) {
        return "After the fit the eight lengths still contradict each other by " +
               with_unit(result.parity_rms_m, "m") + " rms; the limit is " +
               with_unit(kMostParity_m, "m") +
               ". Check the wiring, the preset and the frame's size, and that no string slips.";
    }
    if (!(result.grip_error_rms_m <= kMostGripError_m)) {
        return "From these poses the position of the grip would be known only to " +
               with_unit(result.grip_error_rms_m, "m") + "; the limit is " +
               with_unit(kMostGripError_m, "m") +
               ". Move the grip through more of the workspace, and turn, open and close it.";
    }
    const int left_out =
        result.rejected_outliers + result.rejected_singular + result.rejected_unsolved;
    if (result.used < left_out) {
        return "Only " + std::to_string(result.used) + " of " +
               std::to_string(result.used + left_out) +
               " poses agree with each other. Zero at the home pose first, then move the grip more "
               "slowly and keep it within the frame.";
    }
    return {};
}

MotorCalibration CalibrationWorksheet::motors(const DeviceModel &found) const {
    MotorCalibration motors = motors_;
    for (std::size_t i = 0; i < kStringCount; ++i) {
        const double ratio =
            std::fabs(found.strings.scale_m_per_count[i] / start_.strings.scale_m_per_count[i]);
        motors.effective_radius_m[i] *= ratio;
        const WeightFit weight = weight_fit(i);
        if (weight.repeats > 0) {
            // The current that held the weight must belong to the weight's tension, whatever the
            // radius is now.
            motors.tension_gain[i] *= weight.gain * ratio;
        }
    }
    return motors;
}

StringArray CalibrationWorksheet::residuals(const DeviceModel &model) const {
    StringArray rms{};
    ForwardKinematics kinematics;
    int solved_poses = 0;
    if (usable(kinematics.configure(model.frame, model.grip))) {
        const std::size_t stride = std::max<std::size_t>(1, poses_.size() / kResidualPoses);
        for (std::size_t k = 0; k < poses_.size(); k += stride) {
            const StringArray lengths = wound_lengths(model.strings, model.corrections, poses_[k]);
            const KinematicsResult solved = kinematics.solve_cold(lengths);
            if (!usable(solved.status)) {
                continue;
            }
            const StringArray fitted = string_lengths(model.frame, model.grip, solved.pose);
            for (std::size_t i = 0; i < kStringCount; ++i) {
                rms[i] += (lengths[i] - fitted[i]) * (lengths[i] - fitted[i]);
            }
            ++solved_poses;
        }
    }
    for (double &value : rms) {
        value = solved_poses > 0 ? std::sqrt(value / solved_poses)
                                 : std::numeric_limits<double>::quiet_NaN();
    }
    return rms;
}

} // namespace spidar
