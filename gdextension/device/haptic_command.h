// What the game asks the device thread to render. A plain value: published whole, through a triple buffer.
// Device frame, SI. Requests add up; each ages from the tick it arrives and fades when it is not renewed.
#pragma once

#include <array>
#include <cstdint>

#include "core/status.h"
#include "core/types.h"

namespace spidar {

inline constexpr int kMaxContacts = 8;
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
};

// Unilateral: the target point x is pushed out along +normal when dot(normal, x) < offset.
// grasp_stop: normal.x is +1 (stops opening below offset_rad) or -1: keeps normal.x * grasp_angle >= offset;
// stiffness is then in N m/rad, damping in N m s/rad. A stop at a width of angle w: normal.x = -1, offset = -w.
struct ContactPlane {
    Vec3 normal{0.0, 1.0, 0.0}; // unit
    double offset_m = 0.0;      // or rad
    Vec3 velocity_m_s{0.0};     // the plane's own: it moves on between updates (at most 30 ms)
    double stiffness_n_m = 350.0;
    double damping_n_s_m = 2.0;
    double friction = 0.0; // Coulomb coefficient
    ContactTarget target = ContactTarget::centre;
    std::int32_t id = 0; // persistent; impulses come back by it
};

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
    Status stop_reason = Status::ok;

    // Raw wrench, full for wrench_duration_s after wrench_sequence changes, then faded.
    std::uint64_t wrench_sequence = 0;
    Wrench wrench;
    double wrench_duration_s = 0.0;

    std::uint64_t contacts_sequence = 0;
    int contact_count = 0;
    std::array<ContactPlane, kMaxContacts> contacts{};
};

// ok, or invalid_request / not_finite: the command must then not be published. Over-large but finite values
// are ok: the device brings them down to its limits. duration_s: 0 to kMaxWrenchDuration_s.
[[nodiscard]] Status validate_wrench(const Wrench &wrench, double duration_s) noexcept;
[[nodiscard]] Status validate_contact(const ContactPlane &contact) noexcept;
// contact_count and every contact that it covers.
[[nodiscard]] Status validate_contacts(const HapticCommand &command) noexcept;

} // namespace spidar
