// Events of a device that a game may show. A table holds the meaning and the remedy of each kind.
// Events are rare; a fixed, wait-free queue carries them from the servo thread.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>

#include "core/base/sound_state.h"

namespace spidar {

// The values are stored in recordings and used by the Godot interface: append, never reorder.
enum class DeviceEventKind : std::uint8_t {
    device_connected = 0,
    device_lost,
    open_failed,
    armed,
    disarmed,
    reports_late,
    reports_stopped,
    reports_missed,
    report_out_of_order,
    device_restarted,
    write_blocked,
    sample_refused,
    count_jump,
    pose_lost,
    string_suspected,
    string_fault,
    string_named,
    fast_grip,
    over_speed,
    workspace_edge,
    motors_warm,
    overheated,
    shaking,
    unstable,
    request_refused,
    request_limited,
    game_stalled,
    panic_stopped,
    cycles_late,
    loop_stalled,
    clock_jumped,
    no_real_time_priority,
    zero_needed,
    zero_taken,
    zero_confirmed,
    zero_refused,
    no_hand,
    impossible_tension,
    device_stopped,
};
inline constexpr int kDeviceEventKinds = 39;

enum class EventLevel : std::uint8_t { info = 0, warning = 1, fault = 2 };

struct DeviceEvent {
    // Servo clock (ServoSnapshot::time_s) of the event.
    double time_s = 0.0;
    // Value in the unit of the description; 0 when the kind has none.
    double value = 0.0;
    DeviceEventKind kind = DeviceEventKind::device_connected;
    std::int8_t string = -1; // 0-7, or -1
    // Events of this kind that were left out since the last one that was reported.
    std::uint16_t repeated = 0;
};

struct EventDescription {
    const char *name;     // name in the enumeration
    const char *category; // link, string, motion, heat, request, game, timing, calibration, state
    EventLevel level;
    const char *unit;    // of DeviceEvent::value; "" for none
    const char *message; // one sentence
    const char *remedy;  // one sentence; "" when there is nothing to do
};

// Returns the description. An unknown kind gets a description that says so.
[[nodiscard]] const EventDescription &describe(DeviceEventKind kind) noexcept;

// The events of one servo cycle. An event whose kind was reported less than kQuiet_s ago is left
// out and counted, so that a warning that repeats in each cycle does not flood the queue. Kinds of
// level `fault` are reported each time.
class EventLog {
public:
    static constexpr double kQuiet_s = 1.0;
    // Largest number of events per cycle; more are counted as left out.
    static constexpr int kMostAtOnce = 8;

    void begin_cycle(double time_s) noexcept;
    // Adds an event. string: 0-7 or -1. value: in the unit of the kind's description.
    void tell(DeviceEventKind kind, int string = -1, double value = 0.0) noexcept;
    // True when no event was added in this cycle, not even one that was left out.
    [[nodiscard]] bool at_rest() const noexcept { return silent_; }
    [[nodiscard]] std::span<const DeviceEvent> events() const noexcept {
        return {events_.data(), count_};
    }
    // Checks restored memory: see core/base/sound_state.h.
    [[nodiscard]] bool is_sound() const noexcept {
        return are_flags(silent_) && count_ <= events_.size() &&
               std::all_of(memory_.begin(), memory_.end(),
                           [](const auto &one) { return are_flags(one.told); }) &&
               std::all_of(events_.begin(), events_.end(), [](const auto &one) {
                   return static_cast<int>(one.kind) < kDeviceEventKinds;
               });
    }

private:
    struct Memory {
        double told_s = 0.0;
        std::uint16_t left_out = 0;
        bool told = false;
    };
    std::array<DeviceEvent, kMostAtOnce> events_{};
    std::size_t count_ = 0;
    std::array<Memory, kDeviceEventKinds> memory_{};
    double now_s_ = 0.0;
    bool silent_ = true;
};

} // namespace spidar
