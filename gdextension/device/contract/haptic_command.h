// What the game requests the servo loop to render. A plain value, published as a whole through a
// triple buffer. Device frame, SI units. Requests add up. A request ages from the cycle in which it
// arrives, and fades when it is not refreshed or when its duration ends.
#pragma once

#include <array>
#include <cstdint>

#include "core/base/sound_state.h"
#include "core/base/status.h"
#include "core/base/types.h"

namespace spidar {

// Largest number of contact planes.
inline constexpr int kMaxContacts = 8;
// Distances in a request are clamped to this (unit: m), since larger values could overflow. It is
// larger than any frame.
inline constexpr double kFarAway_m = 10.0;
// Longest duration of a raw wrench or an effect (unit: s): if the hand lets go, no contact stops
// the grip that they push.
inline constexpr double kMaxWrenchDuration_s = 60.0;

// The point of the grip that a contact plane stops.
enum class ContactTarget : std::uint8_t {
    centre = 0,      // P0
    pole1_plus = 1,  // P0 + r1
    pole1_minus = 2, // P0 - r1
    pole2_plus = 3,  // P0 + r2
    pole2_minus = 4, // P0 - r2
    grasp_stop = 5,  // 1-D stop on grasp_angle
    // 1-D stop on the grip's turn about one axis.
    turn_stop = 6,
};

// Checks restored memory: see core/base/sound_state.h.
[[nodiscard]] constexpr bool is_sound(ContactTarget target) noexcept {
    return is_one_of(target, ContactTarget::turn_stop);
}

// All bits of a DOF mask. Bit k: x, y, z, turns about x, y, z, grasp; axes of the device.
inline constexpr std::uint8_t kAllDof = 0x7F;
// One value per DOF in the order of those bits. Units: N, N/m or N s/m for the first three; N m, N
// m/rad or N m s/rad for the others. The last value belongs to grasp_angle and not to the paper's
// g, which is twice the grasp torque.
using DofGains = SevenDof<struct DofGainsMeaning>;

// A unilateral constraint of the target point x: pushes x along +normal while dot(normal, x) <
// offset. Between updates the plane moves by its velocity, and by the turn and the acceleration
// that the last updates show.
// grasp_stop: keeps normal.x * grasp_angle >= offset (rad), with normal.x = +1 or -1. Stiffness is
// in N m/rad, damping in N m s/rad. Example: closing stops at the angle w with normal.x = -1,
// offset = -w.
// turn_stop: keeps dot(normal, turn) >= offset (rad). `turn` is the rotation vector of the grip's
// orientation in the device frame, zero at rest. The rate of the stop is dot(normal, velocity) in
// rad/s; other units as for grasp_stop.
struct ContactPlane {
    Vec3 normal{0.0, 1.0, 0.0}; // unit vector
    double offset_m = 0.0;      // m; rad for stops
    Vec3 velocity_m_s{0.0};     // of the surface point nearest to the target
    double stiffness_n_m = 350.0;
    double damping_n_s_m = 2.0;
    double friction = 0.0; // Coulomb coefficient
    ContactTarget target = ContactTarget::centre;
    std::int32_t id = 0; // persistent; ContactReport uses the same id
};

// A spring and damper in all seven DOF between the grip and a proxy of the game, for something held
// or dragged. Between updates the proxy moves by its twist, from state_time_s on (see
// game_clock.h).
struct Coupling {
    Vec3 position_m{0.0}; // of the proxy: where the grip center should be
    Mat3 rotation{1.0};
    double grasp_angle_rad = 0.0;
    Twist twist; // of the proxy
    DofGains stiffness{350.0, 350.0, 350.0, 0.5, 0.5, 0.5, 0.125};
    DofGains damping{2.0, 2.0, 2.0, 0.002, 0.002, 0.002, 0.0005};
    double max_force_n = 5.0;
    double max_moment_nm = 0.2;
    double max_grasp_torque_nm = 0.2;
    // ServoSnapshot::time_s of the pose used to compute the coupling. Negative: time of arrival.
    double state_time_s = -1.0;
    std::uint8_t dof_mask = 0; // 0: no coupling
};

// Largest number of effects.
inline constexpr int kMaxEffects = 6;
enum class EffectKind : std::uint8_t {
    viscous = 0,   // -gain * velocity
    constant = 1,  // gain as a wrench
    spring = 2,    // gain * (center - pose)
    vibration = 3, // gain * sin(2 pi frequency t) as a wrench
    // Valleys at center + n * spacing; gain is the largest force on the way out of one.
    detents = 4,
};
inline constexpr int kEffectKindCount = 5;
// Largest vibration force along each axis (unit: N).
inline constexpr double kMaxVibration_n = 2.0;
// Largest vibration moment about each axis, and largest grasp torque (unit: N m).
inline constexpr double kMaxVibration_nm = 0.05;
inline constexpr double kMinVibration_hz = 5.0;
// Larger frequencies are refused. A frequency above a quarter of the servo rate is lowered to it.
inline constexpr double kMaxVibration_hz = 250.0;
// Smallest spacing of detents (m or rad): 1 mm is about 40 encoder counts.
inline constexpr double kMinDetentSpacing = 1e-3;

struct Effect {
    EffectKind kind = EffectKind::viscous;
    std::uint8_t dof_mask = 0; // 0: no effect
    std::int32_t id = 0;       // persistent: an effect with the same id and kind continues
    DofGains gain{};
    Vec3 centre_m{0.0};        // spring, detents
    Mat3 centre_rotation{1.0}; // spring, detents
    double centre_grasp_rad = 0.0;
    double frequency_hz = 0.0; // vibration
    DofGains spacing{};        // detents: m, rad
    // Time of full strength (unit: s), counted from the arrival or from the last change of
    // `renewal`. Then the effect fades.
    double duration_s = 0.0;
    std::uint32_t renewal = 0;
};

// Limits that a game may change while the device is open; validate_limits() checks them.
struct LiveLimits {
    double max_force_n = 0.0;
    double max_moment_nm = 0.0;
    double max_grasp_torque_nm = 0.0;
    double max_stiffness_n_m = 0.0;
    double max_turn_stiffness_nm_rad = 0.0;
    double max_grasp_stiffness_nm_rad = 0.0; // per radian of grasp_angle
};

struct TouchScene; // device/contact/touch

struct HapticCommand {
    bool forces_enabled = false;
    // The device acts once on each change of one of these counters, from arm_count to zero_count.
    std::uint32_t arm_count = 0;
    std::uint32_t disarm_count = 0;
    std::uint32_t clear_fault_count = 0;
    std::uint32_t zero_count = 0; // zero_at_home(): the grip is at home
    // Sign of life: the game changes it in each frame. 0: the game is not watched.
    std::uint32_t heartbeat = 0;
    // Set by the loop's own watchdogs and panic_stop(), not by the game. A change switches the
    // motors off and latches a fault with stop_reason.
    std::uint32_t stop_count = 0;
    Status stop_reason = Status::panic_stopped;

    // A raw wrench, added to contacts and coupling. Each change of wrench_sequence applies it in
    // full for wrench_duration_s; then it fades out within SafetySettings::wrench_fade_s.
    std::uint64_t wrench_sequence = 0;
    Wrench wrench;
    double wrench_duration_s = 0.0;

    std::uint64_t contacts_sequence = 0;
    int contact_count = 0;
    std::array<ContactPlane, kMaxContacts> contacts{};
    // Like Coupling::state_time_s.
    double contacts_state_time_s = -1.0;

    // Scene that the hand can touch; null: nothing to touch. A new scene needs a new
    // touch_sequence. The scene must stay unchanged until TouchReport::sequence shows a newer one.
    std::uint64_t touch_sequence = 0;
    const TouchScene *touch = nullptr;

    std::uint64_t coupling_sequence = 0;
    Coupling coupling;

    std::uint64_t effects_sequence = 0;
    int effect_count = 0;
    std::array<Effect, kMaxEffects> effects{};

    // How far the game closes the fingers of a rigid grip, 0..1 (FingerSettings::by_game).
    double grasp_share = 0.0;

    // `limits` apply from a change of limits_sequence on; until then the settings apply.
    std::uint32_t limits_sequence = 0;
    LiveLimits limits;
};

// Returns ok, or invalid_request or not_finite if the request must not be published. Forces and
// gains above a limit are ok, since the device clamps them. duration_s: 0 to kMaxWrenchDuration_s.
[[nodiscard]] Status validate_wrench(const Wrench &wrench, double duration_s) noexcept;
[[nodiscard]] Status validate_contact(const ContactPlane &contact) noexcept;
// Checks contact_count and every contact that it covers.
[[nodiscard]] Status validate_contacts(const HapticCommand &command) noexcept;
[[nodiscard]] Status validate_coupling(const Coupling &coupling) noexcept;
[[nodiscard]] Status validate_effect(const Effect &effect) noexcept;
// Checks effect_count and every effect that it covers.
[[nodiscard]] Status validate_effects(const HapticCommand &command) noexcept;
// Requires finite limits, none negative, and force, moment and grasp torque above 0.
[[nodiscard]] Status validate_limits(const LiveLimits &limits) noexcept;

} // namespace spidar
