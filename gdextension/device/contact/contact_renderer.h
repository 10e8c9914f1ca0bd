// Contact planes -> wrench, at servo rate: the grip's pose is projected on all of them at once (the god-object), and
// the offset pushes. A contact never pulls, and rubs by a stick-slip spring (Coulomb cone). One contact or several
// with the same plane feel the same; at edges and in wedges the pushes are those of the nearest allowed pose.
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

// How stiff the god-object holds the grip's orientation and grasp angle while a contact away from the centre turns
// it. A contact at a pole's end (lever r) gives way by 1 / stiffness + r^2 / this.
inline constexpr double kGodObjectTurnStiffness_nm_rad = 1.0;
inline constexpr double kGodObjectGraspStiffness_nm_rad = 0.25;

class ContactRenderer {
public:
    void configure(const ServoSettings &settings) noexcept;
    // Other caps for what is accepted from now on; all else stays.
    void retune(const ServoSettings &settings) noexcept;

    // A valid set (validate_contacts) replaces the last one; the same id and target carries on. Says what was
    // brought down to a cap. now_s: the clock of HapticCommand::contacts_state_time_s.
    GainClamp accept(const HapticCommand &command, double now_s) noexcept;
    // Once a cycle, before accept(). True in the cycle in which a set is dropped for its age.
    bool age(double dt_s) noexcept;

    // The wrench of all contacts on the grip.
    Wrench render(const GripMotion &motion, double dt_s) noexcept;
    // Adds this cycle's impulses; scale: the part of the rendered wrench that is really asked of the strings.
    void integrate(double scale, double dt_s) noexcept;

    // Same order as the command's contacts.
    int report(std::array<ContactReport, kMaxContacts> &reports) const noexcept;
    [[nodiscard]] bool at_rest() const noexcept { return count_ == 0; }
    // core/base/sound_state.h
    [[nodiscard]] bool is_sound() const noexcept {
        return count_ <= tracks_.size() && are_flags(caps_.from_latency) && clock_.is_sound() &&
               std::all_of(tracks_.begin(), tracks_.end(), [](const auto &one) {
                   return one.surface.is_sound() && are_flags(one.touching, one.anchored) &&
                          spidar::is_sound(one.plane.target);
               });
    }

private:
    struct Track {
        ContactPlane plane; // as last given, capped
        SurfaceTrack surface;
        ContactSurface now;
        double depth_m = 0.0; // or rad: predicted, what the spring sees
        double push = 0.0;    // N, or N m, along the normal
        bool touching = false;
        bool anchored = false;
        Vec3 anchor_m{0.0}; // the friction spring's other end, device frame
        Vec3 force_n{0.0};
        double grasp_torque_nm = 0.0;
        Vec3 moment_nm{0.0}; // turn_stop
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
    double state_time_s_ = -1.0; // of the last set
    GripPose pose_;              // last rendered
    RefreshedStrength strength_{1.0};
};

} // namespace spidar
