// Renders a coupling in each servo cycle: a spring and a damper in seven DOF from the grip to a
// proxy that the game moves. Between two updates the proxy moves on by its velocity.
#pragma once

#include "core/base/sound_state.h"
#include "device/contract/game_clock.h"
#include "device/contract/haptic_command.h"
#include "device/contract/motion.h"
#include "device/contract/request_fade.h"
#include "device/settings/gain_clamp.h"
#include "device/settings/servo_settings.h"

namespace spidar {

class CouplingRequest {
public:
    void configure(const ServoSettings &settings) noexcept;
    // Changes the caps for couplings that are accepted from now on; all other state stays.
    void retune(const ServoSettings &settings) noexcept;
    // Takes a valid coupling (validate_coupling). A jump of the proxy relative to the last coupling
    // is spread over kCrossFade_s. now_s: present time on the clock of Coupling::state_time_s.
    // Returns the first value that was clamped.
    GainClamp accept(const Coupling &coupling, double now_s) noexcept;
    // Ages the coupling by one cycle; called before accept(). Returns true in the cycle in which it
    // expires.
    bool age(double dt_s) noexcept;
    [[nodiscard]] Wrench render(const GripMotion &motion) const noexcept;
    [[nodiscard]] bool at_rest() const noexcept { return !live_; }
    // Checks restored memory: see core/base/sound_state.h.
    [[nodiscard]] bool is_sound() const noexcept {
        return are_flags(live_, caps_.from_latency) && clock_.is_sound();
    }

private:
    struct Proxy {
        Vec3 position_m{0.0};
        Mat3 rotation{1.0};
        double grasp_angle_rad = 0.0;
    };
    [[nodiscard]] Proxy proxy_now() const noexcept;

    GainCaps caps_{};
    Coupling coupling_{};
    DofGains from_stiffness_{};
    DofGains from_damping_{};
    Displacement jump_{}; // from the new proxy to the last one, at the update
    bool live_ = false;
    GameClock clock_;
    RefreshedStrength strength_{0.0};
};

} // namespace spidar
