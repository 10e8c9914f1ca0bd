#include "device/calibration/calibration_tasks.h"

#include <cmath>
#include <cstddef>

namespace spidar {

namespace {

// Time for the strings to become taut and the hand to come to rest.
constexpr double kSettle_s = 0.5;
constexpr double kPull_s = 0.6;
constexpr double kWeighStart = 0.6; // share of the weight at which the ramp begins
constexpr double kWeighEnd = 0.4;
// How far the tension rises beyond the lift (unit: N): four times a motor's friction.
constexpr double kPastWeight_n = 0.4;
constexpr double kSpeedFilter_s = 0.005;

StringArray all_at(double tension_n) noexcept {
    StringArray tensions;
    tensions.fill(tension_n);
    return tensions;
}

} // namespace

const char *describe(TaskVerdict verdict) noexcept {
    switch (verdict) {
    case TaskVerdict::running:
        return "The task is running.";
    case TaskVerdict::done:
        return "The task is done.";
    case TaskVerdict::no_movement:
        return "No string moved: check that the motor's supply is on, that its string is on the "
               "drum, and that the grip is held loosely.";
    case TaskVerdict::wrong_string:
        return "The encoder of another string moved most, so two motor cables, two encoder cables "
               "or two strings are exchanged. Correct them and start the task again.";
    case TaskVerdict::wrong_sign:
        return "The encoder counts in the other direction, because the string is wound the other "
               "way. Its scale becomes negative.";
    case TaskVerdict::not_lifted:
        return "The weight did not move: check its value, that it hangs freely on this string, and "
               "the motor's supply.";
    case TaskVerdict::moved_too_fast:
        return "A string moved faster than 2 m/s, so the motors were switched off. Hold the grip "
               "and try again.";
    case TaskVerdict::stopped:
        return "The task was stopped; the motors are off.";
    case TaskVerdict::not_ready:
        return "The device cannot pull now; check its state, then start the task again.";
    case TaskVerdict::too_warm:
        return "A motor is too warm, so the motors were switched off. Let it cool for half a "
               "minute and try again.";
    }
    return "The verdict is unknown.";
}

StringArray CalibrationTasks::step(const TaskOrder &order, const TaskInput &input) noexcept {
    if (order.number != result_.number) {
        begin(order, input);
    }
    const bool fast = too_fast(input);
    if (!active()) {
        return {};
    }
    if (!input.device_ready) {
        abort(TaskVerdict::not_ready);
        return {};
    }
    if (fast) {
        abort(TaskVerdict::moved_too_fast);
        return {};
    }
    phase_time_s_ += input.dt_s;
    switch (task_) {
    case CalibrationTask::wiring:
        return wiring(input);
    case CalibrationTask::weighing:
        return weighing(input);
    case CalibrationTask::taut:
        return all_at(kTaut_n);
    case CalibrationTask::idle:
        break;
    }
    return {};
}

void CalibrationTasks::abort(TaskVerdict verdict) noexcept {
    if (active()) {
        finish(verdict);
    }
}

void CalibrationTasks::begin(const TaskOrder &order, const TaskInput &input) noexcept {
    result_ = {};
    result_.number = order.number;
    result_.string = order.string;
    result_.verdict = TaskVerdict::running;
    task_ = order.task;
    phase_ = Phase::settle;
    phase_time_s_ = 0.0;
    weight_n_ = order.weight_n;
    tension_n_ = kWeighStart * weight_n_;
    baseline_m_ = input.lengths_m;
    const bool of_a_string = task_ == CalibrationTask::wiring || task_ == CalibrationTask::weighing;
    const bool bad_string = of_a_string && (order.string < 0 || order.string >= kStringCount);
    const bool bad_weight = task_ == CalibrationTask::weighing &&
                            !(weight_n_ >= kLeastWeight_n && weight_n_ <= kMostWeight_n);
    if (task_ > CalibrationTask::weighing || bad_string || bad_weight) {
        finish(TaskVerdict::stopped);
    } else if (task_ == CalibrationTask::idle) {
        finish(TaskVerdict::done);
    }
}

void CalibrationTasks::finish(TaskVerdict verdict) noexcept {
    result_.verdict = verdict;
    task_ = CalibrationTask::idle;
}

// Pulls all strings taut, then one harder, and checks what its encoder reports.
StringArray CalibrationTasks::wiring(const TaskInput &input) noexcept {
    StringArray tensions = all_at(kTaut_n);
    if (phase_ == Phase::settle) {
        if (phase_time_s_ >= kSettle_s) {
            phase_ = Phase::pull;
            phase_time_s_ = 0.0;
            baseline_m_ = input.lengths_m;
        }
        return tensions;
    }
    tensions[static_cast<std::size_t>(result_.string)] = kWiringPull_n;
    if (phase_time_s_ >= kPull_s) {
        judge_wiring(input.lengths_m);
        return {};
    }
    return tensions;
}

void CalibrationTasks::judge_wiring(const StringArray &lengths_m) noexcept {
    std::size_t most = 0;
    for (std::size_t i = 0; i < kStringCount; ++i) {
        result_.moved_m[i] = lengths_m[i] - baseline_m_[i];
        if (std::fabs(result_.moved_m[i]) > std::fabs(result_.moved_m[most])) {
            most = i;
        }
    }
    result_.moved_string = static_cast<int>(most);
    if (!(std::fabs(result_.moved_m[most]) >= kMoved_m)) {
        finish(TaskVerdict::no_movement);
    } else if (result_.moved_string != result_.string) {
        finish(TaskVerdict::wrong_string);
    } else {
        finish(result_.moved_m[most] > 0.0 ? TaskVerdict::wrong_sign : TaskVerdict::done);
    }
}

// Raises the tension until the weight rises, then lowers it until it sinks: friction helps once and
// hinders once.
StringArray CalibrationTasks::weighing(const TaskInput &input) noexcept {
    const auto string = static_cast<std::size_t>(result_.string);
    StringArray tensions{};
    const auto moved_in = [&](double sign) {
        if (input.true_tensions_n != nullptr) {
            return sign * ((*input.true_tensions_n)[string] - weight_n_) >= 0.0;
        }
        return sign * (baseline_m_[string] - input.lengths_m[string]) >= kLifted_m;
    };
    switch (phase_) {
    case Phase::settle:
        if (phase_time_s_ >= kSettle_s) {
            phase_ = Phase::rise;
            baseline_m_ = input.lengths_m;
        }
        break;
    case Phase::rise:
        tension_n_ += kWeighRate_n_per_s * input.dt_s;
        if (moved_in(1.0)) {
            result_.rise_n = tension_n_;
            phase_ = input.true_tensions_n != nullptr ? Phase::pull : Phase::fall;
            baseline_m_ = input.lengths_m;
        } else if (!(tension_n_ < kMostOfWeight * weight_n_)) {
            finish(TaskVerdict::not_lifted);
            return {};
        }
        break;
    case Phase::pull: // a scale must pass the weight, so that friction reverses
        tension_n_ += kWeighRate_n_per_s * input.dt_s;
        if (!(tension_n_ < result_.rise_n + kPastWeight_n)) {
            phase_ = Phase::fall;
        }
        break;
    case Phase::fall:
        tension_n_ -= kWeighRate_n_per_s * input.dt_s;
        // The lifted weight continues to rise for a while: it sinks from its highest point.
        baseline_m_[string] = std::fmin(baseline_m_[string], input.lengths_m[string]);
        if (moved_in(-1.0)) {
            result_.fall_n = tension_n_;
            finish(TaskVerdict::done);
            return {};
        }
        if (!(tension_n_ > kWeighEnd * weight_n_)) {
            finish(TaskVerdict::not_lifted);
            return {};
        }
        break;
    }
    tensions[string] = tension_n_;
    return tensions;
}

bool CalibrationTasks::too_fast(const TaskInput &input) noexcept {
    bool fast = false;
    const double share = std::fmin(1.0, input.dt_s / kSpeedFilter_s);
    for (std::size_t i = 0; i < kStringCount; ++i) {
        const double speed =
            has_last_ ? (input.lengths_m[i] - last_lengths_m_[i]) / input.dt_s : 0.0;
        speed_m_s_[i] += share * (speed - speed_m_s_[i]);
        fast = fast || !(std::fabs(speed_m_s_[i]) <= kTaskSpeed_m_s);
    }
    last_lengths_m_ = input.lengths_m;
    has_last_ = true;
    return fast;
}

} // namespace spidar
