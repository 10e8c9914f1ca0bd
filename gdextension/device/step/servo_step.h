// One servo cycle between read and write: a deterministic, allocation-free function of
// (state, reading, command, time step). Same input, same bits: threaded, stepped, tests and replay all call it.
#pragma once

#include "core/tension/tension_solver.h"
#include "device/contract/device_event.h"
#include "device/contract/haptic_command.h"
#include "device/contract/servo_snapshot.h"
#include "device/contract/transport.h"
#include "device/rendering/haptic_renderer.h"
#include "device/safety/device_state_machine.h"
#include "device/safety/safety_gate.h"
#include "device/safety/safety_monitor.h"
#include "device/safety/zero_check.h"
#include "device/settings/servo_settings.h"
#include "device/tracking/grip_tracker.h"
#include "device/tracking/report_order.h"
#include "device/tracking/sample_guard.h"

namespace spidar {

// Longer steps than this are a suspended computer, not a servo cycle.
inline constexpr double kLongestStep_s = 0.05;
// Shorter ones than any servo has would make speeds without bound out of one encoder count.
inline constexpr double kShortestStep_s = 1e-6;

// A device clock that went back by more than this is not a late report but a new start.
inline constexpr std::uint64_t kClockBack_us = 50'000;

// Everything that evolves from tick to tick lives in here.
class ServoStep {
public:
    // On a failure the old settings stand; else everything starts afresh. Not from the servo loop.
    Status configure(const ServoSettings &settings) noexcept;

    // Takes this command's edges and requests as already seen: what was asked before a start does not act after it.
    void acknowledge(const HapticCommand &command) noexcept;

    // read_status: what Transport::read returned. may_arm_itself: simulated devices arm when forces are enabled.
    // Returns what to write; snapshot() holds the rest.
    DriveCommand step(Status read_status, const DeviceReading &reading,
                      const HapticCommand &command, double dt_s, bool may_arm_itself) noexcept;

    // A failed write: counted; device lost.
    void report_write(Status write_status) noexcept;

    // The next step skips nothing but kinematics. It changes no output, only the counters tension_skipped and
    // steps_skipped.
    void forget_settled() noexcept {
        solver_.forget_settled();
        resting_ = false;
    }

    [[nodiscard]] const ServoSnapshot &snapshot() const noexcept { return snapshot_; }
    // What happened in the last step.
    [[nodiscard]] std::span<const DeviceEvent> events() const noexcept { return events_.events(); }

private:
    struct Edges {
        bool arm = false;
        bool disarm = false;
        bool clear_fault = false;
        bool zero = false;
        bool heartbeat = false;
        bool stop = false;
    };
    Edges take_edges(const HapticCommand &command) noexcept;
    void take_limits(const HapticCommand &command) noexcept;
    void clear_fault(bool answers) noexcept;
    void jump_clock(double asked_dt_s) noexcept;
    // False: an old report, or none of this device's.
    bool accept_report(const DeviceReading &reading) noexcept;
    void observe(Status read_status, const DeviceReading &reading, double dt_s) noexcept;
    void solve_pose(const CountArray &counts, bool unchanged, double dt_s) noexcept;
    void watch(double dt_s) noexcept;
    void check_zero(double dt_s) noexcept;
    void take_zero(const CountArray &counts) noexcept;
    void advance_state(const HapticCommand &command, const Edges &edges,
                       const DeviceReading &reading, double dt_s) noexcept;
    void tell_state() noexcept;
    void tell_fault(Status why, int string) noexcept;
    void raise(Status why, int string) noexcept;
    void lose(Status why) noexcept;
    // servo_step_rest.cpp: would the next step give what the last one gave?
    [[nodiscard]] bool comes_to_rest(const Edges &edges) const noexcept;
    [[nodiscard]] bool may_rest(Status read_status, const DeviceReading &reading,
                                const HapticCommand &command, double dt_s,
                                bool may_arm_itself) const noexcept;
    void rest(const DeviceReading &reading, const HapticCommand &command, double dt_s) noexcept;
    DriveCommand drive(double dt_s) noexcept;
    DriveCommand hold_pretension(double dt_s) noexcept;
    [[nodiscard]] DriveCommand command_for(const StringArray &tensions_n) const noexcept;
    void clear_reports() noexcept;
    void clear_outputs() noexcept;
    void publish_state() noexcept;
    void add_rotor_compensation(StringArray &tensions_n) const noexcept;

    ServoSettings settings_{};
    double nominal_dt_s_ = 0.001;
    double max_tension_n_ = 0.0;
    MotorScale motors_;
    SampleGuard guard_;
    GripTracker tracker_;
    GraspDetector grasp_;
    HapticRenderer renderer_;
    DeviceStateMachine machine_;
    TensionSolver solver_;
    SafetyGate gate_;
    SafetyMonitor monitor_;
    ReportOrder order_;
    ZeroCheck zero_check_;
    EventLog events_;
    WrenchMatrix matrix_{};
    bool matrix_valid_ = false; // of the present pose
    bool motors_were_on_ = false;
    bool limiting_ = false;  // the sum of all requests is being brought down
    bool tracking_ = false;  // the newest sample gave a pose
    bool answered_ = false;  // any reading yet
    bool fresh_ = false;     // a good sample in this cycle
    bool moved_ = false;     // with another pose
    bool rendering_ = false; // a wrench was asked for in the last cycle
    bool resting_ = false;   // all that evolves in time stands still
    bool settled_ = false;   // the last tensions were the ones before, unlimited
    bool saturated_ = false; // and limited by strings at a bound
    bool forces_enabled_ = false;
    DriveCommand last_drive_; // valid while resting_
    bool simulated_ = false;
    bool device_zeroed_ = true; // as the device said last
    DeviceState told_state_ = DeviceState::closed;
    double since_beat_s_ = 0.0; // of the game
    std::uint64_t device_time_us_ = 0;
    double since_report_s_ = 0.0;
    int unsolved_in_row_ = 0; // samples without a pose
    double link_scale_ = 1.0; // of the wrench, while reports fail to come
    std::uint32_t arm_count_ = 0;
    std::uint32_t disarm_count_ = 0;
    std::uint32_t clear_fault_count_ = 0;
    std::uint32_t zero_count_ = 0;
    std::uint32_t heartbeat_ = 0;
    std::uint32_t stop_count_ = 0;
    std::uint32_t limits_sequence_ = 0;
    ServoSnapshot snapshot_{};
};

} // namespace spidar
