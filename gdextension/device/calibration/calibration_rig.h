// A device on the bench, opened for calibration alone. The rig reads the device, and one
// CalibrationTask at a time moves its motors; no game does. Tensions are limited by
// kTaskMaxTension_n and kTaskSlew_n_per_ms. The motors pull only for a task, and after it until the
// tension is lowered. A task ends when the controlling thread has sent no new beat for
// kUnwatched_s, or when a motor is too warm. With start_threaded(), a thread of the rig runs the
// cycles, a WriterThread writes if a write may block, and no call waits for the device, except the
// destructor: it waits for the device call in progress.
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

// Time without a new RigOrders::beat, as in a hung editor, until the motors go off (unit: s).
inline constexpr double kUnwatched_s = 1.0;

struct RigSettings {
    double rate_hz = 1000.0;
    StringArray scale_m_per_count{}; // present calibration (unit: m); must not be 0
    MotorCalibration motors;
    // The simulated device's settings, which limit the targets of its hand.
    PlantSettings plant;
    double max_tension_n = kTaskMaxTension_n;
    // Used instead of kUnwatched_s for a simulated device. It may be longer: an editor on a busy
    // machine can be slow, and no hand is at risk.
    double simulated_unwatched_s = kUnwatched_s;
};

// Time between kept readings (unit: s): poses must differ by more than a hand's tremor.
inline constexpr double kSampleInterval_s = 0.02;
// Largest number of collected readings that wait for next_sample(); further ones are dropped.
inline constexpr std::size_t kWaitingSamples = 1024;

// Orders from the controlling thread to the rig.
struct RigOrders {
    TaskOrder task;
    // Any new value shows that the controlling thread is alive.
    std::uint32_t beat = 0;
    HandScript hand = HandScript::home;
    int hand_place = 0;
    std::uint32_t hand_number = 0; // a new number restarts the script's time
    bool collecting = false;
};

// Reports from the rig to the controlling thread.
struct RigNews {
    Status status = Status::not_open; // status of the last read
    Status device_status = Status::ok;
    CountArray counts{};
    std::uint64_t readings = 0;
    // How often the device was lost: unplugged or failed.
    std::uint32_t losses = 0;
    double time_s = 0.0;
    bool motors_on = false;
    StringArray tensions_n{}; // commanded, per string
    TaskResult task;
    bool simulated = false;
    bool hand_has_arrived = false;
    // Simulated devices only: what a ruler along each string would show.
    StringArray true_lengths_m{};
};

class CalibrationRig {
public:
    // Called once, in the rig's thread or by start_stepped(). Returns null on failure, with the
    // reason in `problem`.
    using MakeTransport = std::function<std::unique_ptr<Transport>(std::string &problem)>;

    CalibrationRig(const RigSettings &settings, MakeTransport make_transport);
    ~CalibrationRig();
    CalibrationRig(const CalibrationRig &) = delete;
    CalibrationRig &operator=(const CalibrationRig &) = delete;

    // Starts the rig's thread. Call one of the two start functions, once. Returns false when the
    // system cannot start a thread.
    bool start_threaded();
    // Opens the device at once, without a thread: advance() then runs the cycles.
    void start_stepped();
    // After start_stepped(): runs the cycles of this many simulated seconds, at most 60. Does
    // nothing after start_threaded().
    void advance(double seconds) noexcept;
    // Asks the thread to switch the motors off, close the device and end; state() reports the end.
    // Without a thread, this function does the same itself.
    void ask_close() noexcept;

    [[nodiscard]] RigState state() const noexcept;
    // Why state() is failed; empty in any other state.
    [[nodiscard]] std::string problem() const;
    // Sends orders. Called by the controlling thread, like the next two functions; none of the
    // three waits.
    void give(const RigOrders &orders) noexcept;
    // Reads the newest report. Returns false when there is none since the last call.
    bool latest(RigNews &news) noexcept;
    // Takes the oldest collected reading. Returns false when there is none.
    bool next_sample(CountArray &counts) noexcept;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace spidar
