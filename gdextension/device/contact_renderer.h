// Contact planes -> wrench, at servo rate. Each plane pushes with a spring and damper along its normal, never
// pulls, and rubs by a stick-slip spring (Coulomb cone). Planes of nearly the same direction that touch at the
// same time share one stiffness, so that one or four coplanar contacts feel the same.
#pragma once

#include <array>

#include "device/servo_settings.h"
#include "device/servo_snapshot.h"

namespace spidar {

// Caps: beyond these the 1 kHz loop with its link and strings is not stable in any hand.
inline constexpr double kMaxStiffness_n_m = 2000.0;
inline constexpr double kMaxDamping_n_s_m = 5.0;
inline constexpr double kMaxGraspStiffness_nm_rad = 3.0;
inline constexpr double kMaxGraspDamping_nm_s_rad = 0.02;
// One game period: steps of a plane between two updates are spread over it.
inline constexpr double kContactCrossFade_s = 0.016;
// A plane moves on by its velocity no longer than this without an update.
inline constexpr double kContactExtrapolation_s = 0.030;

class ContactRenderer {
public:
    void configure(const SafetySettings &safety) noexcept;

    // A valid set (validate_contacts) replaces the last one; the same id and target carries on. True when a
    // value was brought down to a cap.
    bool accept(const HapticCommand &command) noexcept;
    // Once a cycle, before accept(). True in the cycle in which a set is dropped for its age.
    bool age(double dt_s) noexcept;

    // The wrench of all contacts on the grip. damping_scale 0..1: 0 when the twist cannot be trusted.
    Wrench render(const GripState &grip, double dt_s, double damping_scale) noexcept;
    // Adds this cycle's impulses; scale: the part of the rendered wrench that is really asked of the strings.
    void integrate(double scale, double dt_s) noexcept;

    // Same order as the command's contacts.
    int report(std::array<ContactReport, kMaxContacts> &reports) const noexcept;

private:
    // What a plane is right now, cross-faded and moved on.
    struct Surface {
        Vec3 normal{0.0, 1.0, 0.0};
        Vec3 velocity_m_s{0.0};
        double offset_m = 0.0;
        double stiffness_n_m = 0.0;
        double damping_n_s_m = 0.0;
        double friction = 0.0;
    };
    struct Track {
        ContactPlane plane; // as last given, capped
        Surface from;       // where the cross-fade starts
        bool fading_in = false;
        Surface now;
        double depth_m = 0.0; // or rad
        bool touching = false;
        bool anchored = false;
        Vec3 anchor_m{0.0}; // the friction spring's other end, device frame
        Vec3 force_n{0.0};
        double grasp_torque_nm = 0.0;
        Vec3 impulse_ns{0.0};
        double grasp_impulse_nms = 0.0;
    };

    void place(Track &track, double dt_s) const noexcept;
    [[nodiscard]] double share_of(std::size_t index) const noexcept;
    void push_point(Track &track, const GripState &grip, double share,
                    double damping_scale) const noexcept;
    void push_grasp(Track &track, const GripState &grip, double share,
                    double damping_scale) const noexcept;

    double full_s_ = 0.1;
    double gone_s_ = 0.3;
    std::array<Track, kMaxContacts> tracks_{};
    std::size_t count_ = 0;
    double age_s_ = 0.0;
    double strength_ = 1.0; // falls with age, comes back gradually
};

} // namespace spidar
