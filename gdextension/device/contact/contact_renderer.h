// Renders contact planes as a wrench in each servo cycle. The god-object is the nearest pose to the
// grip's that is behind no plane (god_object.h); springs push the grip toward it. A contact does
// not pull along its normal. Its friction is a spring along the plane, whose force is limited to
// the friction coefficient times the push (Coulomb). Several contacts of one target with the same
// plane feel like one of them.
#pragma once

#include <algorithm>
#include <array>

#include "core/base/sound_state.h"
#include "device/contact/contact_surface.h"
#include "device/contact/god_object.h"
#include "device/contract/game_clock.h"
#include "device/contract/motion.h"
#include "device/contract/request_fade.h"
#include "device/contract/servo_snapshot.h"
#include "device/settings/gain_clamp.h"
#include "device/settings/servo_settings.h"

namespace spidar {

// Stiffness of the god-object's orientation. A push with lever arm r about P0, as at a pole's end,
// also turns the god-object: its contact then gives way by r^2 / this value more per newton.
inline constexpr double kGodObjectTurnStiffness_nm_rad = 1.0;
// Stiffness of the god-object's grasp angle, per radian of grasp_angle.
inline constexpr double kGodObjectGraspStiffness_nm_rad = 0.25;

class ContactRenderer {
public:
    void configure(const ServoSettings &settings) noexcept;
    // Changes the caps for contacts that are accepted from now on; all other state stays.
    void retune(const ServoSettings &settings) noexcept;

    // Replaces the contacts by a valid set (validate_contacts). A contact whose id and target were
    // in the last set keeps its impulses, and its plane changes gradually. Returns the first value
    // that was clamped. now_s: present time on the clock of HapticCommand::contacts_state_time_s.
    GainClamp accept(const HapticCommand &command, double now_s) noexcept;
    // Ages the contacts by one cycle; called before accept(). Returns true in the cycle in which
    // they expire.
    bool age(double dt_s) noexcept;

    // Returns the wrench of all contacts on the grip.
    Wrench render(const GripMotion &motion, double dt_s) noexcept;
    // Adds the impulses of this cycle. scale: share of the rendered wrench that was requested from
    // the strings.
    void integrate(double scale, double dt_s) noexcept;

    // Writes one report per contact, in the command's order. Returns their number.
    int report(std::array<ContactReport, kMaxContacts> &reports) const noexcept;
    [[nodiscard]] bool at_rest() const noexcept { return count_ == 0; }
    // Checks restored memory: see core/base/sound_state.h.
    [[nodiscard]] bool is_sound() const noexcept {
        return count_ <= tracks_.size() && are_flags(caps_.from_latency) && clock_.is_sound() &&
               std::all_of(tracks_.begin(), tracks_.end(), [](const auto &one) {
                   return one.surface.is_sound() && are_flags(one.touching, one.anchored) &&
                          spidar::is_sound(one.plane.target);
               });
    }

private:
    struct Track {
        ContactPlane plane; // as last received, clamped
        SurfaceTrack surface;
        ContactSurface now;
        // Depth of the predicted point behind the plane, negative in front of it; rad for stops.
        double depth_m = 0.0;
        double push = 0.0; // along the normal: N, or N m for stops
        bool touching = false;
        bool anchored = false;
        Vec3 anchor_m{0.0}; // end of the friction spring on the plane, device frame
        Vec3 force_n{0.0};
        double grasp_torque_nm = 0.0;
        Vec3 moment_nm{0.0}; // of a turn stop; else zero
        Vec3 impulse_ns{0.0};
        double grasp_impulse_nms = 0.0;
    };

    void place(Track &track, double dt_s) const noexcept;
    [[nodiscard]] Vec3 foot(const ContactPlane &plane) const noexcept;
    ConstraintRow measure(Track &track, const GripMotion &motion) const noexcept;
    void rub(Track &track, const GripMotion &motion) const noexcept;

    GainCaps caps_{};
    std::array<Track, kMaxContacts> tracks_{};
    std::size_t count_ = 0;
    std::uint32_t active_mask_ = 0;
    GameClock clock_;
    double state_time_s_ = -1.0; // of the last set of contacts, on the game's clock
    GripPose pose_;              // pose of the last render()
    RefreshedStrength strength_{1.0};
};

} // namespace spidar
