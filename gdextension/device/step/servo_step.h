// One servo cycle between read and write: a deterministic, allocation-free function of (state,
// reading, command, time step). Equal input gives equal bits in threaded and stepped loops, tests
// and replay.
#pragma once

#include "core/base/sound_state.h"
#include "device/contract/device_event.h"
#include "device/contract/haptic_command.h"
#include "device/contract/rest.h"
#include "device/contract/servo_snapshot.h"
#include "device/contract/transport.h"
#include "device/rendering/haptic_renderer.h"
#include "device/safety/device_state_machine.h"
#include "device/safety/safety_monitor.h"
#include "device/safety/zero_check.h"
#include "device/settings/servo_settings.h"
#include "device/step/game_watch.h"
#include "device/step/tension_drive.h"
#include "device/tracking/fingers.h"
#include "device/tracking/grip_tracker.h"
#include "device/tracking/report_link.h"
#include "device/tracking/sample_guard.h"

namespace spidar {

// Longest time step (unit: s). A longer one means that the computer was suspended.
inline constexpr double kLongestStep_s = 0.05;
// Shortest time step (unit: s). A shorter one would turn one encoder count into an unbounded speed.
inline constexpr double kShortestStep_s = 1e-6;

// Holds all state that evolves from cycle to cycle.
class ServoStep {
public:
    // A negative status keeps the old settings; else all state restarts. Not for the servo loop.
    Status configure(const ServoSettings &settings) noexcept;

    // Sets the memory of the shapes' closest points (ProxyMemory). The loop owns it, and
    // configure() keeps it. Without this memory shapes cannot be felt.
    void use(ProxyMemory *memory) noexcept { parts_.renderer.touch().use(memory); }
    [[nodiscard]] TouchRenderer &touch() noexcept { return parts_.renderer.touch(); }
    [[nodiscard]] const TouchRenderer &touch() const noexcept { return parts_.renderer.touch(); }

    // Takes this command's counters and requests as seen, so that a request from before a start has
    // no effect.
    void acknowledge(const HapticCommand &command) noexcept;

    // Runs one cycle. read_status: result of Transport::read(). may_arm_itself: true for simulated
    // devices, which arm when forces are enabled. Returns what to write; snapshot() holds the rest.
    DriveCommand step(Status read_status, const DeviceReading &reading,
                      const HapticCommand &command, double dt_s, bool may_arm_itself) noexcept;

    // Reports the result of a write. A failure is counted, and the device is lost.
    void report_write(Status write_status) noexcept;

    // Used share of each motor's thermal budget. It outlasts the loop (safety/motor_heat.h).
    [[nodiscard]] const StringArray &heat() const noexcept { return parts_.monitor.heat().heat(); }
    void set_heat(const StringArray &heat) noexcept {
        parts_.monitor.set_heat(heat);
        resting_ = false;
    }

    // The next step computes the tensions anew, even at rest. This changes no output except the
    // counters tension_skipped and steps_skipped.
    void forget_settled() noexcept {
        parts_.drive.forget_settled();
        resting_ = false;
    }

    [[nodiscard]] const ServoSnapshot &snapshot() const noexcept { return snapshot_; }
    // Events of the last step.
    [[nodiscard]] std::span<const DeviceEvent> events() const noexcept {
        return parts_.events.events();
    }

    // Parts that keep a step from being skipped, for diagnosis (awake_mask in contract/rest.h).
    struct Awake {
        std::uint32_t step = 0;
        std::uint32_t renderer = 0;
        std::uint32_t monitor = 0;
    };
    [[nodiscard]] Awake awake_parts() const noexcept {
        return {awake_mask(parts_), parts_.renderer.awake_parts(), parts_.monitor.awake_parts()};
    }
    // Checks restored memory: see core/base/sound_state.h.
    [[nodiscard]] bool is_sound() const noexcept {
        return spidar::is_sound(settings_) && parts_.events.is_sound() && parts_.drive.is_sound() &&
               parts_.machine.is_sound() && parts_.tracker.is_sound() && parts_.link.is_sound() &&
               parts_.guard.is_sound() && parts_.grasp.is_sound() && parts_.fingers.is_sound() &&
               parts_.zero_check.is_sound() && parts_.monitor.is_sound() &&
               parts_.renderer.is_sound() &&
               are_flags(forces_enabled_, simulated_, device_zeroed_, limiting_, tracking_, fresh_,
                         moved_, rendering_, resting_, last_drive_.motors_on,
                         last_drive_.clear_faults) &&
               is_tally(unsolved_in_row_) && is_one_of(told_state_, DeviceState::calibrated) &&
               spidar::is_sound(snapshot_);
    }

private:
    using Edges = GameWatch::Edges;
    void take_limits(const HapticCommand &command) noexcept;
    void clear_fault(bool answers) noexcept;
    void jump_clock(double asked_dt_s) noexcept;
    // Returns false for an old report, which must not be used.
    bool accept_report(const DeviceReading &reading) noexcept;
    void observe(Status read_status, const DeviceReading &reading, double dt_s) noexcept;
    void solve_pose(const CountArray &counts, bool unchanged, double dt_s) noexcept;
    void hold_pose(Status why, double dt_s, bool stale) noexcept;
    void watch(double dt_s) noexcept;
    void check_zero(double dt_s) noexcept;
    void take_zero(const CountArray &counts) noexcept;
    void advance_state(const HapticCommand &command, const Edges &edges,
                       const DeviceReading &reading, double dt_s) noexcept;
    void tell_state() noexcept;
    // Applies motor_rule.h, and reports the stop when it changes the state.
    void stop(StopReason reason, Status why, int string) noexcept;
    // Stops with a fault, or with a panic if `why` is panic_stopped.
    void raise(Status why, int string) noexcept;
    void lose(Status why) noexcept;
    // Whether the next step would give the same result as the last (servo_step_rest.cpp).
    [[nodiscard]] bool comes_to_rest(const Edges &edges) const noexcept;
    [[nodiscard]] bool may_rest(Status read_status, const DeviceReading &reading,
                                const HapticCommand &command, double dt_s,
                                bool may_arm_itself) const noexcept;
    void rest(const DeviceReading &reading, const HapticCommand &command, double dt_s) noexcept;
    DriveCommand drive(double dt_s) noexcept;
    DriveCommand let_go() noexcept;
    // The grip with the fingers' angle, which replaces the grasp angle of a rigid grip.
    [[nodiscard]] GripState grip_with_fingers() const noexcept;
    void publish_state() noexcept;

    ServoSettings settings_{};
    double nominal_dt_s_ = 0.001;
    // All parts that evolve from cycle to cycle, besides what commands and readings bring.
    struct Parts {
        EventLog events; // first, since it is at rest least often
        TensionDrive drive;
        DeviceStateMachine machine;
        GripTracker tracker;
        ReportLink link;
        SampleGuard guard;
        GraspDetector grasp;
        Fingers fingers;
        ZeroCheck zero_check;
        SafetyMonitor monitor;
        HapticRenderer renderer;
        template <typename Combine>
        auto with_all(Combine &&combine) const noexcept {
            const auto &[a, b, c, d, e, f, g, h, i, j, k] = *this;
            return combine(a, b, c, d, e, f, g, h, i, j, k);
        }
    };
    Parts parts_;
    // What the last command and reading brought.
    GameWatch game_;
    std::uint32_t limits_sequence_ = 0;
    bool forces_enabled_ = false;
    bool simulated_ = false;
    bool device_zeroed_ = true;
    // Results of the last cycle.
    bool limiting_ = false;   // the sum of all requests was clamped
    bool tracking_ = false;   // the newest sample gave a pose
    bool fresh_ = false;      // a good sample arrived
    bool moved_ = false;      // the good sample changed the pose
    bool rendering_ = false;  // a wrench was requested
    int unsolved_in_row_ = 0; // samples without a pose
    DeviceState told_state_ = DeviceState::closed;
    bool resting_ = false;    // the next step may be skipped
    DriveCommand last_drive_; // valid while resting_
    ServoSnapshot snapshot_{};
};

} // namespace spidar
