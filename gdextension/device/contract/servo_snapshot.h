// What the servo loop publishes in each cycle: a plain value, device frame, SI units.
#pragma once

#include <array>
#include <cstdint>

#include "core/base/sound_state.h"
#include "core/base/status.h"
#include "core/base/types.h"
#include "core/kinematics/grasp_detector.h"
#include "device/contract/device_state.h"
#include "device/contract/grip_state.h"
#include "device/contract/haptic_command.h"
#include "device/settings/gain_clamp.h"

namespace spidar {

struct ContactReport {
    std::int32_t id = 0;
    Vec3 impulse_ns{0.0};           // on the grip, summed since this id appeared
    double grasp_impulse_nms = 0.0; // grasp_stop only
    bool touching = false;
};

// Impulse that the tool has given to one part of the scene (device/contact/touch).
struct TouchPartReport {
    std::int32_t id = 0;
    Vec3 impulse_ns{0.0};          // on the part, summed since this id appeared
    Vec3 angular_impulse_nms{0.0}; // about the part's origin
};

// A point where the tool touches or almost touches the scene.
struct TouchPointReport {
    std::int32_t tool_id = 0;
    std::int32_t scene_id = 0;
    Vec3 point_m{0.0}; // on the surface of the scene
    Vec3 normal{0.0};  // out of the scene
    Vec3 force_n{0.0}; // on the tool
    double gap_m = 0.0;
    double slip_m_s = 0.0; // speed along the surface; 0: friction holds
};

inline constexpr int kMostTouchParts = 32;
inline constexpr int kMostTouchPoints = 24;
struct TouchReport {
    std::uint64_t sequence = 0; // touch_sequence of the rendered scene
    // Pose of the proxy: where the tool is shown, outside all surfaces.
    Vec3 position_m{0.0};
    Mat3 rotation{1.0};
    double grasp_rad = 0.0;
    // Wrench of contacts and load on the hand, before limits.
    Wrench wrench;
    // Grasp torque by which the jaws, closed on each other or on the held body, resist closing
    // further. 0 while they are open.
    double stop_push_nm = 0.0;
    DofGains stiffness{}; // as used in this cycle
    int part_count = 0;
    int point_count = 0;
    // Closest-point queries of the last cycle.
    std::int32_t queries = 0;
    // Solver passes of the last cycle.
    std::int32_t passes = 0;
    // Number of cycles that used the last answer again.
    std::uint64_t skipped = 0;
    std::array<TouchPartReport, kMostTouchParts> parts{}; // in the order of the scene
    std::array<TouchPointReport, kMostTouchPoints> points{};
};

// Counters; each only grows.
struct ServoCounters {
    std::uint64_t ticks = 0;
    std::uint64_t kinematics_skipped = 0; // counts were unchanged
    // Cycles that used the last tensions, since pose and request were unchanged and the tensions
    // had stopped changing.
    std::uint64_t tension_skipped = 0;
    // Cycles that used the whole last answer, since everything was at rest (contract/rest.h).
    std::uint64_t steps_skipped = 0;
    std::uint64_t cold_starts = 0;
    std::uint64_t bad_samples = 0; // refused, or without a pose
    std::uint64_t read_timeouts = 0;
    // Requests that were not finite or malformed.
    std::uint64_t rejected_requests = 0;
    std::uint64_t clamped_requests = 0;
    std::uint64_t expired_requests = 0;
    std::uint64_t saturated_ticks = 0; // strings at a bound changed the wrench
    std::uint64_t slewed_ticks = 0;    // the slew limit changed a tension
    std::uint64_t write_failures = 0;
    std::uint64_t reports_missed = 0; // gaps in the sequence numbers of the device
    std::uint64_t old_reports = 0;    // repeated or out of order: ignored
    std::uint64_t faded_ticks = 0;    // a safety monitor reduced the wrench
    std::uint64_t bad_time_steps = 0; // outside [1e-6, 0.05] s: replaced by 1 / rate
    // Cycles in which a tension outside [0, max] or a NaN reached the safety gate: a defect.
    std::uint64_t gate_clamps = 0;
};

struct ServoSnapshot {
    double time_s = 0.0; // sum of all time steps
    DeviceState state = DeviceState::closed;
    Status fault = Status::ok;     // the reason when state is fault
    std::int8_t fault_string = -1; // 0-7, or -1
    GripState grip;
    GraspPhase grasp = GraspPhase::open;
    CountArray counts{};
    StringArray lengths_m{};
    StringArray tensions_n{}; // commanded, after every limit
    Wrench requested;         // sum of all requests, after limits and ramp
    // The wrench that tensions_n give. tension_report() names the causes of its error.
    Wrench achieved;
    std::uint8_t at_min_mask = 0;
    std::uint8_t at_max_mask = 0;
    Status tension_status = Status::ok;
    double force_scale = 0.0;   // ramp of arming and fading, 0..1
    double tension_scale = 0.0; // part of force_scale that scales all tensions, also the pretension
    double safety_scale = 1.0;  // share of the wrench that the safety monitors allow, 0..1
    double thermal_share = 0.0; // used part of the warmest motor's budget; 1: spent
    double parity_error_m = 0.0; // part of the eight lengths that no pose explains
    bool zero_known = false;
    int contact_count = 0;
    std::array<ContactReport, kMaxContacts> contacts{};
    TouchReport touch;
    // Work done on the hand per DOF since the start, in the order of DofGains: commanded tensions
    // times measured motion.
    std::array<double, kDofCount> injected_j{};
    GainClamp clamp; // the last clamped gain
    ServoCounters counters;
    std::uint8_t buttons = 0;
};

// Checks restored memory: see core/base/sound_state.h.
[[nodiscard]] inline bool is_sound(const ServoSnapshot &snapshot) noexcept {
    bool sound = is_one_of(snapshot.state, DeviceState::calibrated) &&
                 is_one_of(snapshot.grasp, GraspPhase::over_closed) &&
                 is_string_or_none(snapshot.fault_string) &&
                 are_flags(snapshot.zero_known, snapshot.grip.frame.rotation_held) &&
                 snapshot.contact_count >= 0 && snapshot.contact_count <= kMaxContacts &&
                 is_sound(snapshot.clamp);
    for (const ContactReport &contact : snapshot.contacts) {
        sound = sound && are_flags(contact.touching);
    }
    const TouchReport &touch = snapshot.touch;
    sound = sound && touch.part_count >= 0 && touch.part_count <= kMostTouchParts &&
            touch.point_count >= 0 && touch.point_count <= kMostTouchPoints;
    return sound;
}

} // namespace spidar
