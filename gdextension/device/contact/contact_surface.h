// The plane of a contact at the present time. A game updates it 30 to 144 times per second, and the
// servo loop uses it 1000 times. Between two updates, the plane is extrapolated by the velocity
// that the game gave, and by the turn rate and acceleration on which the last three updates agree.
#pragma once

#include "core/base/sound_state.h"
#include "device/contract/game_clock.h"
#include "device/contract/haptic_command.h"

namespace spidar {

struct ContactSurface {
    Vec3 normal{0.0, 1.0, 0.0};
    Vec3 velocity_m_s{0.0};
    double offset_m = 0.0;
    double stiffness_n_m = 0.0;
    double damping_n_s_m = 0.0;
    double friction = 0.0;
};

// Extrapolates one plane from update to update. Stops (grasp, turn) are extrapolated by velocity
// only.
class SurfaceTrack {
public:
    // Starts with the first update, or with another surface of the same id.
    void begin(const ContactPlane &plane) noexcept;
    // Takes the next update of the same surface. apart_s: time between the last update and this one
    // on the game's clock (0: unknown). from: the surface as it is rendered now. pivot_m: point of
    // the plane that does not move when the plane turns.
    void renew(const ContactPlane &plane, const ContactSurface &from, double apart_s,
               const Vec3 &pivot_m) noexcept;
    // Returns the surface at the present time of `clock`.
    [[nodiscard]] ContactSurface now(const GameClock &clock) const noexcept;
    // Checks restored memory: see core/base/sound_state.h.
    [[nodiscard]] bool is_sound() const noexcept {
        return are_flags(fading_in_) && spidar::is_sound(plane_.target);
    }

private:
    ContactPlane plane_; // as last received
    // The surface from which the cross-fade starts.
    ContactSurface from_;
    bool fading_in_ = false;
    Vec3 pivot_m_{0.0};
    // seen_: turn rate and acceleration between the last two updates. The others are used to
    // extrapolate: what seen_ and the seen_ before it have in common.
    Vec3 seen_turn_rad_s_{0.0};
    Vec3 turn_rad_s_{0.0};
    double seen_acceleration_m_s2_ = 0.0;
    double acceleration_m_s2_ = 0.0;
};

} // namespace spidar
