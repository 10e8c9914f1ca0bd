// What a contact's plane is right now: the game gives it 30 to 144 times a second, the servo loop asks 1000 times. In
// between it moves on: by its velocity, as the game gives it, and by its turning and acceleration, as the last
// updates showed them.
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

// One plane from update to update. Stops (grasp_stop, turn_stop) move by their velocity alone.
class SurfaceTrack {
public:
    // The first update, or another surface under the same id.
    void begin(const ContactPlane &plane) noexcept;
    // The next update of the same surface, apart_s later by the game's own clock (0: unknown). from: what is rendered at
    // this moment. pivot_m: the point about which a turn of the plane leaves it in place.
    void renew(const ContactPlane &plane, const ContactSurface &from, double apart_s,
               const Vec3 &pivot_m) noexcept;
    // The surface at the clock's present.
    [[nodiscard]] ContactSurface now(const GameClock &clock) const noexcept;
    // core/base/sound_state.h
    [[nodiscard]] bool is_sound() const noexcept {
        return are_flags(fading_in_) && spidar::is_sound(plane_.target);
    }

private:
    ContactPlane plane_; // as last given
    ContactSurface from_;
    bool fading_in_ = false;
    Vec3 pivot_m_{0.0};
    // Between the last two updates, and what is made of the last three.
    Vec3 seen_turn_rad_s_{0.0};
    Vec3 turn_rad_s_{0.0};
    double seen_acceleration_m_s2_ = 0.0;
    double acceleration_m_s2_ = 0.0;
};

} // namespace spidar
