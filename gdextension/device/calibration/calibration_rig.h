// A device on the bench: opened for calibration alone, read by a thread of its own, its motors moved by one
// CalibrationTask at a time and never by a game. Weak and slow (kTaskMaxTension_n, kTaskSlew_n_per_ms), off unless a task
// runs, off when the one who gave it stops looking for kUnwatched_s, and off while a motor is too warm. Time is measured, and a device whose write may
// block is written by a WriterThread, so that a slow endpoint delays nothing. No call here waits for the device, but the
// destructor waits for the call to the device that is under way.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "core/base/status.h"
#include "core/calibration/motor_calibration.h"
#include "device/calibration/calibration_hand.h"
#include "device/calibration/calibration_tasks.h"
#include "device/contract/transport.h"

namespace spidar {

enum class RigState : std::uint8_t { closed = 0, opening = 1, open = 2, failed = 3 };

// Motors go off when nobody gives orders for this long: an editor that hangs, a window that is gone.
inline constexpr double kUnwatched_s = 1.0;

struct RigSettings {
    double rate_hz = 1000.0;
    StringArray scale_m_per_count{}; // as assumed before the calibration; not zero
    MotorCalibration motors;
    PlantSettings plant; // where the scripted hand of a simulated device may go
    double max_tension_n = kTaskMaxTension_n;
    // Of a simulated device, which hurts nobody: an editor on a busy machine may be slow.
    double simulated_unwatched_s = kUnwatched_s;
};

// Counts kept while collecting: poses further apart than a hand's tremor.
inline constexpr double kSampleInterval_s = 0.02;
inline constexpr std::size_t kWaitingSamples = 1024;

// Controlling thread -> rig.
struct RigOrders {
    TaskOrder task;
    std::uint32_t beat = 0; // any new value: somebody is watching
    HandScript hand = HandScript::home;
    int hand_place = 0;
    std::uint32_t hand_number = 0; // a new number begins the script
    bool collecting = false;
};

// Rig -> controlling thread.
struct RigNews {
    Status status = Status::not_open; // of the last read
    Status device_status = Status::ok;
    CountArray counts{};
    std::uint64_t readings = 0;
    std::uint32_t losses = 0; // times the device was lost: unplugged, or as if
    double time_s = 0.0;
    bool motors_on = false;
    StringArray tensions_n{}; // commanded
    TaskResult task;
    bool simulated = false;
    bool hand_has_arrived = false;
    StringArray true_lengths_m{}; // simulated: what a ruler along each string would show
};

class CalibrationRig {
public:
    // Called once, in the rig's thread. Null: the device cannot be opened, with the sentence that says why.
    using MakeTransport = std::function<std::unique_ptr<Transport>(std::string &problem)>;

    CalibrationRig(const RigSettings &settings, MakeTransport make_transport);
    ~CalibrationRig();
    CalibrationRig(const CalibrationRig &) = delete;
    CalibrationRig &operator=(const CalibrationRig &) = delete;

    // One of both, once. threaded: false when the system has no thread left.
    bool start_threaded();
    void start_stepped();
    // Stepped: time moves on. At most a minute a call.
    void advance(double seconds) noexcept;
    // The thread switches the motors off, closes the device and ends; state() tells when.
    void ask_close() noexcept;

    [[nodiscard]] RigState state() const noexcept;
    [[nodiscard]] std::string problem() const; // why state() is failed, or was closed by itself
    // Controlling thread; wait-free.
    void give(const RigOrders &orders) noexcept;
    bool latest(RigNews &news) noexcept;
    bool next_sample(CountArray &counts) noexcept;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace spidar
