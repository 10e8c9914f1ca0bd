// Motor tasks of a calibration and their results: motors off, all strings taut, one string pulled
// (wiring), one string lifting a known weight. One task runs at a time, slowly and weakly. The
// wiring and weighing tasks end by themselves; a new order or abort() ends any task at once.
// Servo-safe: no allocation, no clock.
#pragma once

#include <cstdint>

#include "core/base/types.h"

namespace spidar {

enum class CalibrationTask : std::uint8_t {
    idle = 0, // motors off
    taut = 1, // kTaut_n on every string, until another task
    // Pulls one string and reports which count moved.
    wiring = 2,
    // Lifts a known weight with one string.
    weighing = 3,
};

enum class TaskVerdict : std::uint8_t {
    running = 0,
    done = 1,
    no_movement = 2,  // wiring: no string moved by kMoved_m
    wrong_string = 3, // wiring: another string moved most, see TaskResult::moved_string
    wrong_sign = 4,   // wiring: right string, but its count reports a longer string
    // weighing: no rise up to kMostOfWeight times the weight, or no sinking after it
    not_lifted = 5,
    moved_too_fast = 6, // a string was faster than kTaskSpeed_m_s: motors off
    stopped = 7, // motors off: order out of range, no new beat, or a thread of the rig was late
    // the device cannot pull: it has a fault (RigNews::device_status) or does not answer
    not_ready = 8,
    too_warm = 9, // a motor's thermal budget is spent: motors off
};

// Returns English sentences that say what happened and what to do; never null.
[[nodiscard]] const char *describe(TaskVerdict verdict) noexcept;

struct TaskOrder {
    CalibrationTask task = CalibrationTask::idle;
    int string = 0;           // wiring, weighing: 0-7
    double weight_n = 0.0;    // weighing: weight on the string
    std::uint32_t number = 0; // a new number starts the task
};

struct TaskResult {
    std::uint32_t number = 0;
    TaskVerdict verdict = TaskVerdict::done;
    int string = 0;
    int moved_string = 0;  // wiring: the string that changed most
    StringArray moved_m{}; // wiring: change of each length during the pull
    double rise_n = 0.0;   // weighing: commanded tension at which the weight rose
    // Weighing: commanded tension at which the weight sank. Friction is (rise_n - fall_n) / 2.
    double fall_n = 0.0;
};

// Tension of the taut task (unit: N): the pretension of the servo loop.
inline constexpr double kTaut_n = 0.5;
// Pull of the wiring task (unit: N): moves a lightly held grip by millimeters.
inline constexpr double kWiringPull_n = 2.0;
// Smallest movement that counts in the wiring task (unit: m): 40 counts, above noise and slack.
inline constexpr double kMoved_m = 0.001;
// Smallest weight that is accepted (unit: N): friction (0.1 N) would hide a smaller one.
inline constexpr double kLeastWeight_n = 0.5;
// Largest weight that is accepted (unit: N).
inline constexpr double kMostWeight_n = 4.0;
// largest tension of the weighing task, divided by the weight
inline constexpr double kMostOfWeight = 1.6;
// Rate at which the weighing task raises and lowers the tension (unit: N/s).
inline constexpr double kWeighRate_n_per_s = 1.0;
// Movement that counts as lifted, or as sunk again (unit: m).
inline constexpr double kLifted_m = 0.002;
// String speed at which a task stops the motors (unit: m/s).
inline constexpr double kTaskSpeed_m_s = 2.0;
// Largest tension of any task (unit: N).
inline constexpr double kTaskMaxTension_n = kMostWeight_n * kMostOfWeight;
// Largest tension change of any task (unit: N/ms).
inline constexpr double kTaskSlew_n_per_ms = 0.02;

// Input of a task in one cycle.
struct TaskInput {
    StringArray lengths_m{}; // with the present scale; only changes are used
    bool device_ready = false;
    // Simulated device: the true tension of each string, as a spring scale would show it; null for
    // a real device. The weight then counts as lifted when the string really pulls that hard.
    const StringArray *true_tensions_n = nullptr;
    double dt_s = 0.001;
};

class CalibrationTasks {
public:
    // Returns the tensions to command (unit: N). An order with a value out of range gets the
    // verdict `stopped`.
    StringArray step(const TaskOrder &order, const TaskInput &input) noexcept;
    // Ends the running task with this verdict; step() then returns zeros until a new order.
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
    double tension_n_ = 0.0; // weighing: tension of the string
    double weight_n_ = 0.0;
    StringArray baseline_m_{};
    StringArray last_lengths_m_{};
    StringArray speed_m_s_{}; // low-pass filtered: one count per millisecond is 25 mm/s
    bool has_last_ = false;
    TaskResult result_;
};

} // namespace spidar
