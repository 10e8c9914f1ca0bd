// Measurements of a calibration, their results, and the names for GDScript.
#include "godot/calibration/spidar_g_calibrator.h"

#include <system_error>

#include "godot/base/type_conversions.h"

#include <godot_cpp/variant/packed_string_array.hpp>

using godot::ClassDB;
using godot::D_METHOD;

namespace {

template <typename Values>
godot::PackedFloat64Array part_of(const Values &values, std::size_t first) {
    std::array<double, spidar::kStringCount> eight{};
    for (std::size_t i = 0; i < eight.size(); ++i) {
        eight[i] = values[first + i];
    }
    return spidar::to_godot(eight);
}

[[nodiscard]] bool is_string(int string) {
    return string >= 0 && string < spidar::kStringCount;
}

} // namespace

bool SpidarGCalibrator::may_measure(const char *method, int string) {
    if (!is_open() || news_.readings == 0) {
        return reject(std::string(method) +
                      ": no device is open, or it has not sent a reading yet.");
    }
    if (!is_string(string)) {
        return reject(std::string(method) + ": string = " + std::to_string(string) +
                      ": give a string index from 0 to 7.");
    }
    if (!spidar::usable(news_.status) && news_.status != spidar::Status::read_timeout) {
        return reject(std::string(method) + ": " + spidar::describe(news_.status));
    }
    problem_.clear();
    return true;
}

spidar::DeviceModel SpidarGCalibrator::model() const {
    return has_result_ && spidar::usable(result_.status) ? result_.model : sheet_.measured();
}

bool SpidarGCalibrator::take_zero() {
    if (!may_measure("take_zero", 0)) {
        return false;
    }
    const std::string problem = sheet_.add_zero(news_.counts);
    if (!problem.empty()) {
        return reject(problem);
    }
    has_result_ = false; // the result belongs to another zero
    sheet_.clear_poses();
    model_changed_ = true;
    return true;
}

void SpidarGCalibrator::clear_zero() {
    sheet_.clear_zero();
    has_result_ = false;
    model_changed_ = true;
}

godot::Dictionary SpidarGCalibrator::get_zero() const {
    godot::Dictionary told;
    const spidar::HomeZero zero = sheet_.zero();
    told["repeats"] = static_cast<std::int64_t>(sheet_.zero_repeats());
    told["status"] = static_cast<int>(zero.status);
    told["text"] = godot::String(spidar::describe(zero.status));
    told["spread_m"] = spidar::to_godot(zero.spread_m);
    return told;
}

bool SpidarGCalibrator::take_length(int string, double length_m) {
    if (!may_measure("take_length", string)) {
        return false;
    }
    const auto i = static_cast<std::size_t>(string);
    const std::string problem = sheet_.add_length(i, news_.counts[i], length_m);
    if (!problem.empty()) {
        return reject(problem);
    }
    has_result_ = false;
    model_changed_ = true;
    return true;
}

void SpidarGCalibrator::clear_lengths(int string) {
    if (is_string(string)) {
        sheet_.clear_lengths(static_cast<std::size_t>(string));
        has_result_ = false;
        model_changed_ = true;
    }
}

godot::Dictionary SpidarGCalibrator::get_lengths(int string) const {
    godot::Dictionary told;
    if (!is_string(string)) {
        return told;
    }
    const auto i = static_cast<std::size_t>(string);
    godot::PackedInt32Array counts;
    godot::PackedFloat64Array lengths;
    for (const spidar::CountLengthPair &pair : sheet_.lengths(i)) {
        counts.push_back(pair.count);
        lengths.push_back(pair.length_m);
    }
    const spidar::StringScaleFit fit = sheet_.length_fit(i);
    told["counts"] = counts;
    told["lengths_m"] = lengths;
    told["status"] = static_cast<int>(fit.status);
    told["text"] = godot::String(spidar::describe(fit.status));
    told["scale_m_per_count"] = fit.scale_m_per_count;
    told["scale_error_m_per_count"] = fit.scale_error_m_per_count;
    told["residual_rms_m"] = fit.residual_rms_m;
    told["repeat_spread_m"] = fit.repeat_spread_m;
    told["repeated_points"] = fit.repeated_points;
    return told;
}

godot::Dictionary SpidarGCalibrator::get_weights(int string) const {
    godot::Dictionary told;
    if (!is_string(string)) {
        return told;
    }
    const spidar::WeightFit fit = sheet_.weight_fit(static_cast<std::size_t>(string));
    told["repeats"] = fit.repeats;
    told["gain"] = fit.gain;
    told["spread"] = fit.spread;
    told["friction_n"] = fit.friction_n;
    return told;
}

void SpidarGCalibrator::clear_weights(int string) {
    if (is_string(string)) {
        sheet_.clear_weights(static_cast<std::size_t>(string));
    }
}

bool SpidarGCalibrator::is_reversed(int string) const {
    return is_string(string) && sheet_.reversed(static_cast<std::size_t>(string));
}

void SpidarGCalibrator::set_collecting(bool collecting) {
    orders_.collecting = collecting && is_open();
    if (is_open()) {
        give();
    }
}

void SpidarGCalibrator::clear_poses() {
    sheet_.clear_poses();
    has_result_ = false;
    model_changed_ = true;
}

godot::Dictionary SpidarGCalibrator::get_coverage() const {
    const spidar::Coverage &covered = sheet_.coverage();
    godot::Dictionary told;
    told["poses"] = static_cast<std::int64_t>(sheet_.poses().size());
    told["travel_m"] = spidar::to_godot(covered.travel_m);
    told["turn_rad"] = covered.turn_rad;
    told["grasp_rad"] = covered.grasp_rad;
    return told;
}

bool SpidarGCalibrator::compute() {
    if (!began_) {
        return reject("compute: nothing was measured yet: open a device first.");
    }
    if (job_) {
        return reject("compute: the last computation is still running: wait for its result.");
    }
    job_ = std::make_unique<Job>();
    job_->sheet = sheet_;
    const auto work = [job = job_.get()] {
        const spidar::CalibrationWorksheet &sheet = job->sheet;
        job->result = spidar::self_calibrate(sheet.measured(), sheet.poses(), sheet.settings());
        job->before_m = sheet.residuals(sheet.before());
        job->after_m = sheet.residuals(job->result.model);
        job->done.store(true, std::memory_order_release);
    };
    try {
        job_->thread = std::thread(work);
    } catch (const std::system_error &error) {
        job_.reset();
        return reject(std::string("compute: the system cannot start another thread. ") +
                      error.what());
    }
    problem_.clear();
    return true;
}

void SpidarGCalibrator::finish_job() {
    if (!job_ || !job_->done.load(std::memory_order_acquire)) {
        return;
    }
    result_ = job_->result;
    before_m_ = job_->before_m;
    after_m_ = job_->after_m;
    has_result_ = true;
    model_changed_ = true;
    job_.reset();
    const std::string refused = spidar::CalibrationWorksheet::refusal(result_);
    if (!refused.empty()) {
        reject(refused);
    }
}

godot::Dictionary SpidarGCalibrator::get_result() const {
    godot::Dictionary told;
    told["known"] = has_result_;
    if (!has_result_) {
        return told;
    }
    const std::string refused = spidar::CalibrationWorksheet::refusal(result_);
    godot::PackedStringArray weak;
    for (const spidar::WeakCombination &combination : result_.weak) {
        weak.push_back(spidar::to_godot(spidar::describe(combination)));
    }
    told["usable"] = refused.empty();
    told["refusal"] = spidar::to_godot(refused);
    told["status"] = static_cast<int>(result_.status);
    told["text"] = godot::String(spidar::describe(result_.status));
    told["weak"] = weak;
    told["used"] = result_.used;
    told["left_out"] =
        result_.rejected_outliers + result_.rejected_singular + result_.rejected_unsolved;
    told["grip_error_rms_m"] = result_.grip_error_rms_m;
    told["offset_error_rms_m"] = result_.offset_error_rms_m;
    told["parity_rms_m"] = result_.parity_rms_m;
    told["offset_changes_m"] = part_of(result_.change, spidar::kOffsetUnknowns);
    told["gain_changes"] = part_of(result_.change, spidar::kGainUnknowns);
    told["offset_errors_m"] = part_of(result_.expected_error, spidar::kOffsetUnknowns);
    told["gain_errors"] = part_of(result_.expected_error, spidar::kGainUnknowns);
    told["residuals_before_m"] = spidar::to_godot(before_m_);
    told["residuals_after_m"] = spidar::to_godot(after_m_);
    return told;
}

godot::Ref<SpidarGCalibration> SpidarGCalibrator::make_calibration() {
    if (!began_) {
        reject("make_calibration: nothing was measured yet: open a device first.");
        return {};
    }
    if (has_result_) {
        const std::string refused = spidar::CalibrationWorksheet::refusal(result_);
        if (!refused.empty()) {
            reject(refused);
            return {};
        }
    } else if (!spidar::usable(sheet_.zero().status)) {
        reject("make_calibration: zero at the home pose first, or calibrate by free motion.");
        return {};
    }
    problem_.clear();
    const spidar::DeviceModel found = model();
    const spidar::MotorCalibration motors = sheet_.motors(found);
    godot::Ref<SpidarGCalibration> made;
    made.instantiate();
    made->set_string_offsets(spidar::to_godot(found.strings.offset_m));
    made->set_string_scales(spidar::to_godot(found.strings.scale_m_per_count));
    made->set_zero_counts(spidar::to_godot(found.strings.zero_count));
    made->set_effective_radii(spidar::to_godot(motors.effective_radius_m));
    made->set_torque_constants(spidar::to_godot(motors.torque_constant_nm_a));
    made->set_tension_gains(spidar::to_godot(motors.tension_gain));
    made->set_max_currents(spidar::to_godot(motors.max_current_a));
    made->set_corrections(corrections_);
    return made;
}

void SpidarGCalibrator::_bind_methods() {
    bind_device();
    bind_measurements();
    bind_boards();
    BIND_ENUM_CONSTANT(DEVICE_CLOSED);
    BIND_ENUM_CONSTANT(DEVICE_OPENING);
    BIND_ENUM_CONSTANT(DEVICE_OPEN);
    BIND_ENUM_CONSTANT(DEVICE_FAILED);
    BIND_ENUM_CONSTANT(TASK_IDLE);
    BIND_ENUM_CONSTANT(TASK_TAUT);
    BIND_ENUM_CONSTANT(TASK_WIRING);
    BIND_ENUM_CONSTANT(TASK_WEIGHING);
    BIND_ENUM_CONSTANT(VERDICT_RUNNING);
    BIND_ENUM_CONSTANT(VERDICT_DONE);
    BIND_ENUM_CONSTANT(VERDICT_NO_MOVEMENT);
    BIND_ENUM_CONSTANT(VERDICT_WRONG_STRING);
    BIND_ENUM_CONSTANT(VERDICT_WRONG_SIGN);
    BIND_ENUM_CONSTANT(VERDICT_NOT_LIFTED);
    BIND_ENUM_CONSTANT(VERDICT_MOVED_TOO_FAST);
    BIND_ENUM_CONSTANT(VERDICT_STOPPED);
    BIND_ENUM_CONSTANT(VERDICT_NOT_READY);
    BIND_ENUM_CONSTANT(VERDICT_TOO_WARM);
    BIND_ENUM_CONSTANT(HAND_HOME);
    BIND_ENUM_CONSTANT(HAND_FREE_MOTION);
    BIND_ENUM_CONSTANT(HAND_PLACE);
    BIND_ENUM_CONSTANT(PARAMETER_BOARD_ID);
    BIND_ENUM_CONSTANT(PARAMETER_QUADRATURE_MASK);
}

void SpidarGCalibrator::bind_device() {
    using Self = SpidarGCalibrator;
    spidar::bind_checked<&Self::open, "", "open", "config", "calibration", "stepped">(false);
    ClassDB::bind_method(D_METHOD("close"), &Self::close);
    ClassDB::bind_method(D_METHOD("poll"), &Self::poll);
    spidar::bind_checked<&Self::advance, "", "advance", "seconds">();
    ClassDB::bind_method(D_METHOD("get_device_state"), &Self::get_device_state);
    ClassDB::bind_method(D_METHOD("get_problem"), &Self::get_problem);
    ClassDB::bind_method(D_METHOD("get_live"), &Self::get_live);
    spidar::bind_checked<&Self::start_task, "", "start_task", "task", "string", "weight_n">(0, 0.0);
    ClassDB::bind_method(D_METHOD("get_task"), &Self::get_task);
    spidar::bind_checked<&Self::move_simulated_hand, "", "move_simulated_hand", "hand", "place">(0);
}

void SpidarGCalibrator::bind_measurements() {
    using Self = SpidarGCalibrator;
    ClassDB::bind_method(D_METHOD("take_zero"), &Self::take_zero);
    ClassDB::bind_method(D_METHOD("clear_zero"), &Self::clear_zero);
    ClassDB::bind_method(D_METHOD("get_zero"), &Self::get_zero);
    spidar::bind_checked<&Self::take_length, "", "take_length", "string", "length_m">();
    spidar::bind_checked<&Self::clear_lengths, "", "clear_lengths", "string">();
    spidar::bind_checked<&Self::get_lengths, "", "get_lengths", "string">();
    spidar::bind_checked<&Self::get_weights, "", "get_weights", "string">();
    spidar::bind_checked<&Self::clear_weights, "", "clear_weights", "string">();
    spidar::bind_checked<&Self::is_reversed, "", "is_reversed", "string">();
    spidar::bind_checked<&Self::set_collecting, "", "set_collecting", "collecting">();
    ClassDB::bind_method(D_METHOD("is_collecting"), &Self::is_collecting);
    ClassDB::bind_method(D_METHOD("clear_poses"), &Self::clear_poses);
    ClassDB::bind_method(D_METHOD("get_coverage"), &Self::get_coverage);
    ClassDB::bind_method(D_METHOD("compute"), &Self::compute);
    ClassDB::bind_method(D_METHOD("is_computing"), &Self::is_computing);
    ClassDB::bind_method(D_METHOD("get_result"), &Self::get_result);
    ClassDB::bind_method(D_METHOD("make_calibration"), &Self::make_calibration);
}
