// What the motors do while a device is calibrated, and what that tells: nothing, all strings taut, one string pulled
// (wiring), one string lifting a known weight. One task at a time, slow and weak; every task ends by itself or at once
// when told. Servo-safe: no allocation, no clock.
#pragma once

#include <cstdint>

#include "core/base/types.h"

namespace spidar {

enum class CalibrationTask : std::uint8_t {
    idle = 0, // motors off
    taut = 1, // kTaut_n on every string, until another task
    wiring = 2,
    weighing = 3,
};

enum class TaskVerdict : std::uint8_t {
    running = 0,
    done = 1,
    no_movement = 2,    // wiring: no string moved by kMoved_m
    wrong_string = 3,   // wiring: another string moved most, see TaskResult::moved_string
    wrong_sign = 4,     // wiring: the right string, but its count says that it grew longer
    not_lifted = 5,     // weighing: no movement up to kMostOfWeight times the weight
    moved_too_fast = 6, // a string faster than kTaskSpeed_m_s: motors off
    stopped = 7,        // motors off: stopped, or nobody watches any more
    not_ready = 8,      // the device cannot pull: RigNews::device_status says why
    too_warm = 9,       // a motor's thermal budget is spent: motors off
};

// One plain English sentence; never null.
[[nodiscard]] const char *describe(TaskVerdict verdict) noexcept;

struct TaskOrder {
    CalibrationTask task = CalibrationTask::idle;
    int string = 0;           // wiring, weighing: 0-7
    double weight_n = 0.0;    // weighing: what hangs on the string
    std::uint32_t number = 0; // a new number begins the task
};

struct TaskResult {
    std::uint32_t number = 0;
    TaskVerdict verdict = TaskVerdict::done;
    int string = 0;
    int moved_string = 0;  // wiring: the one that changed most
    StringArray moved_m{}; // wiring: change of each length while string was pulled
    double rise_n = 0.0;   // weighing: commanded tension at which the weight rose
    double fall_n = 0.0;   // and at which it sank; friction is half their difference
};

inline constexpr double kTaut_n = 0.5;        // the pretension of the servo loop
inline constexpr double kWiringPull_n = 2.0;  // moves a lightly held grip by millimetres
inline constexpr double kMoved_m = 0.001;     // 40 counts: no noise, no slack
inline constexpr double kLeastWeight_n = 0.5; // below, friction (0.1 N) hides it
inline constexpr double kMostWeight_n = 4.0;
inline constexpr double kMostOfWeight = 1.6; // highest tension tried, over the weight
inline constexpr double kWeighRate_n_per_s = 1.0;
inline constexpr double kLifted_m = 0.002; // movement that counts as lifted, or sunk again
inline constexpr double kTaskSpeed_m_s = 2.0;
inline constexpr double kTaskMaxTension_n = kMostWeight_n * kMostOfWeight;
inline constexpr double kTaskSlew_n_per_ms = 0.02;

// What a task sees in one cycle.
struct TaskInput {
    StringArray lengths_m{}; // by the scale assumed; only changes of it are used
    bool device_ready = false;
    // Simulated device: the true tension of each string, as a spring scale would show it. There the weight counts as
    // lifted when the string really pulls as hard.
    const StringArray *true_tensions_n = nullptr;
    double dt_s = 0.001;
};

class CalibrationTasks {
public:
    // Tensions wanted now (unit: N). An order that is out of range is refused as `stopped`.
    StringArray step(const TaskOrder &order, const TaskInput &input) noexcept;
    // Motors off now: the running task ends with this verdict.
    void abort(TaskVerdict verdict) noexcept;
    [[nodiscard]] const TaskResult &result() const noexcept { return result_; }
    [[nodiscard]] bool active() const noexcept { return task_ != CalibrationTask::idle; }

private:
    enum class Phase : std::uint8_t { settle, pull, rise, fall };

    void begin(const TaskOrder &order, const TaskInput &input) noexcept;
    void finish(TaskVerdict verdict) noexcept;
    StringArray wiring(const TaskInput &input) noexcept;
    StringArray weighing(const TaskInput &input) noexcept;
    void judge_wiring(const StringArray &lengths_m) noexcept;
    [[nodiscard]] bool too_fast(const TaskInput &input) noexcept;

    CalibrationTask task_ = CalibrationTask::idle;
    Phase phase_ = Phase::settle;
    double phase_time_s_ = 0.0;
    double tension_n_ = 0.0; // weighing: of the string
    double weight_n_ = 0.0;
    StringArray baseline_m_{};
    StringArray last_lengths_m_{};
    StringArray speed_m_s_{}; // low-passed: one count a millisecond is 25 mm/s
    bool has_last_ = false;
    TaskResult result_;
};

} // namespace spidar
