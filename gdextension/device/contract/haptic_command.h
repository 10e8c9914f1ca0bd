// What the game asks the device thread to render. A plain value: published whole, through a triple buffer.
// Device frame, SI. Requests add up; each ages from the tick it arrives and fades when it is not renewed.
#pragma once

#include <array>
#include <cstdint>

#include "core/base/sound_state.h"
#include "core/base/status.h"
#include "core/base/types.h"

namespace spidar {

inline constexpr int kMaxContacts = 8;
// Beyond any frame: no request reaches further, so that absurd ones do not overflow.
inline constexpr double kFarAway_m = 10.0;
// A raw wrench is short-lived by nature: nothing local stops a grip that the hand lets go.
inline constexpr double kMaxWrenchDuration_s = 60.0;

// Which point of the grip a contact plane stops.
enum class ContactTarget : std::uint8_t {
    centre = 0,      // P0
    pole1_plus = 1,  // P0 + r1
    pole1_minus = 2, // P0 - r1
    pole2_plus = 3,  // P0 + r2
    pole2_minus = 4, // P0 - r2
    grasp_stop = 5,  // 1-D: acts on grasp_angle
    turn_stop = 6,   // 1-D: acts on the grip's turn about one axis
};

// core/base/sound_state.h
[[nodiscard]] constexpr bool is_sound(ContactTarget target) noexcept {
    return is_one_of(target, ContactTarget::turn_stop);
}

// Bit k of a DOF mask: x, y, z, turns about x, y, z, grasp; axes of the device.
inline constexpr std::uint8_t kAllDof = 0x7F;
// One value a DOF in that order: N, N/m or N s/m for the first three, N m, N m/rad or N m s/rad for the others
// (grasp: per radian of grasp_angle). Not the paper's q, whose g is twice the grasp torque.
using DofGains = SevenDof<struct DofGainsMeaning>;

// Between updates a plane moves on by its velocity, and turns and speeds up as it did over the last ones.
// Unilateral: the target point x is pushed out along +normal when dot(normal, x) < offset.
// grasp_stop: normal.x is +1 (stops opening below offset_rad) or -1: keeps normal.x * grasp_angle >= offset;
// stiffness is then in N m/rad, damping in N m s/rad. A stop at a width of angle w: normal.x = -1, offset = -w.
// turn_stop: keeps dot(normal, turn) >= offset_rad, `turn` the rotation vector of the grip's orientation as seen
// from the device frame (zero at rest); units as for grasp_stop. Its rate is dot(normal, velocity), in rad/s.
struct ContactPlane {
    Vec3 normal{0.0, 1.0, 0.0}; // unit
    double offset_m = 0.0;      // or rad
    Vec3 velocity_m_s{0.0};     // of the surface, where the target is nearest
    double stiffness_n_m = 350.0;
    double damping_n_s_m = 2.0;
    double friction = 0.0; // Coulomb coefficient
    ContactTarget target = ContactTarget::centre;
    std::int32_t id = 0; // persistent; impulses come back by it
};

// A spring and damper in all seven DOF between the grip and a proxy of the game's: something held or dragged.
// The proxy moves on by its twist from the time that it was computed for (game_clock.h says how long).
struct Coupling {
    Vec3 position_m{0.0}; // of the proxy, where the grip's centre should be
    Mat3 rotation{1.0};
    double grasp_angle_rad = 0.0;
    Twist twist; // of the proxy
    DofGains stiffness{350.0, 350.0, 350.0, 0.5, 0.5, 0.5, 0.125};
    DofGains damping{2.0, 2.0, 2.0, 0.002, 0.002, 0.002, 0.0005};
    double max_force_n = 5.0;
    double max_moment_nm = 0.2;
    double max_grasp_torque_nm = 0.2;
    // ServoSnapshot::time_s of the pose that the game computed it from; negative: when it arrives.
    double state_time_s = -1.0;
    std::uint8_t dof_mask = 0; // 0: no coupling
};

inline constexpr int kMaxEffects = 6;
enum class EffectKind : std::uint8_t {
    viscous = 0,   // -gain * velocity
    constant = 1,  // gain as a wrench
    spring = 2,    // gain * (centre - pose)
    vibration = 3, // gain * sin(2 pi frequency t) as a wrench
    detents =
        4, // valleys at centre + n * spacing, gain deep: the greatest force on the way out of one
};
inline constexpr int kEffectKindCount = 5;
// Bounds of a vibration: a string should buzz, not hammer.
inline constexpr double kMaxVibration_n = 2.0;
inline constexpr double kMaxVibration_nm = 0.05;
inline constexpr double kMinVibration_hz = 5.0;
inline constexpr double kMaxVibration_hz = 250.0; // and a quarter of the servo rate
// Detents closer than this (m, rad) are finer than the encoders.
inline constexpr double kMinDetentSpacing = 1e-3;

struct Effect {
    EffectKind kind = EffectKind::viscous;
    std::uint8_t dof_mask = 0; // 0: no effect
    std::int32_t id = 0;       // persistent: the same id and kind carries on
    DofGains gain{};
    Vec3 centre_m{0.0};        // spring, detents
    Mat3 centre_rotation{1.0}; // spring, detents
    double centre_grasp_rad = 0.0;
    double frequency_hz = 0.0; // vibration
    DofGains spacing{};        // detents: m, rad
    // Full for so long from when it came, or came with another `renewal`; then faded like a wrench.
    double duration_s = 0.0;
    std::uint32_t renewal = 0;
};

// Limits that a game may change while the device is open; ranges as in SafetySettings and RenderSettings.
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
    // Edge counters: the device acts when a value differs from the last one it saw.
    std::uint32_t arm_count = 0;
    std::uint32_t disarm_count = 0;
    std::uint32_t clear_fault_count = 0;
    std::uint32_t zero_count = 0; // zero_at_home(): the grip is held at home
    // Sign of life: the game changes it each frame. 0: nobody promised one, so nobody is missed.
    std::uint32_t heartbeat = 0;
    // The loop's own watchdogs and panic_stop() set these, not the game: motors off for this reason, latched.
    std::uint32_t stop_count = 0;
    Status stop_reason = Status::panic_stopped;

    // A wrench that the game asks for itself, beside contacts and coupling. Each change of wrench_sequence applies it in
    // full for wrench_duration_s; then it fades out within SafetySettings::wrench_fade_s.
    std::uint64_t wrench_sequence = 0;
    Wrench wrench;
    double wrench_duration_s = 0.0;

    std::uint64_t contacts_sequence = 0;
    int contact_count = 0;
    std::array<ContactPlane, kMaxContacts> contacts{};
    // As Coupling::state_time_s.
    double contacts_state_time_s = -1.0;

    // Null with another touch_sequence: nothing to touch. It stays as it is until the device has acknowledged a newer one.
    std::uint64_t touch_sequence = 0;
    const TouchScene *touch = nullptr;

    std::uint64_t coupling_sequence = 0;
    Coupling coupling;

    std::uint64_t effects_sequence = 0;
    int effect_count = 0;
    std::array<Effect, kMaxEffects> effects{};

    // How far the game closes the fingers of a rigid grip, 0 to 1 (FingerSettings::by_game).
    double grasp_share = 0.0;

    // Taken when limits_sequence changes; until then those of the settings hold.
    std::uint32_t limits_sequence = 0;
    LiveLimits limits;
};

// ok, or invalid_request / not_finite: the command must then not be published. Over-large but finite values
// are ok: the device brings them down to its limits. duration_s: 0 to kMaxWrenchDuration_s.
[[nodiscard]] Status validate_wrench(const Wrench &wrench, double duration_s) noexcept;
[[nodiscard]] Status validate_contact(const ContactPlane &contact) noexcept;
// contact_count and every contact that it covers.
[[nodiscard]] Status validate_contacts(const HapticCommand &command) noexcept;
[[nodiscard]] Status validate_coupling(const Coupling &coupling) noexcept;
[[nodiscard]] Status validate_effect(const Effect &effect) noexcept;
[[nodiscard]] Status validate_effects(const HapticCommand &command) noexcept;
// Finite, none below zero, and a force, moment and grasp torque above it.
[[nodiscard]] Status validate_limits(const LiveLimits &limits) noexcept;

} // namespace spidar
