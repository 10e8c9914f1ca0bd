// The grip's motion as contacts, coupling and effects see it: a notch filter removes the
// oscillation of rotors against grip on the elastic strings, and the motion is predicted by the
// delay of the loop. Forces from an unfiltered pose would drive that oscillation.
#pragma once

#include <array>

#include "core/base/one_pole.h"
#include "core/base/sound_state.h"
#include "device/contract/motion.h"
#include "device/settings/render_settings.h"

namespace spidar {

class MotionFilter {
public:
    void configure(const RenderSettings &settings, double rate_hz) noexcept;
    // Resets to rest: no prediction, no velocity.
    void reset() noexcept;
    // moved: displacement since the last cycle, dt_s ago.
    void update(const Displacement &moved, double dt_s) noexcept;

    [[nodiscard]] Displacement ahead() const noexcept;
    [[nodiscard]] Twist velocity() const noexcept;
    // Returns the prediction time minus the delay that the notch filter adds to a steady motion
    // (unit: s).
    [[nodiscard]] double steady_lead_s() const noexcept { return steady_lead_s_; }
    // True when the grip stood still so long that updates without motion change nothing.
    [[nodiscard]] bool at_rest() const noexcept { return at_rest_; }
    // Checks restored memory: see core/base/sound_state.h.
    [[nodiscard]] bool is_sound() const noexcept { return are_flags(at_rest_); }

private:
    // One lane per DOF, padded to whole vectors.
    static constexpr std::size_t kLanes = 8;
    using Lanes = std::array<double, kLanes>;

    OnePole velocity_filter_;
    double lead_s_ = 0.0;
    double steady_lead_s_ = 0.0;
    // offset = filtered - measured: offset'' + 2 width w offset' + w^2 offset = -depth speed.
    double w_ = 0.0; // angular frequency of the notch (unit: rad/s); 0: no notch
    double depth_ = 0.0;
    // Warps time so that the trapezoidal rule is exact at w.
    double warp_ = 1.0;
    Lanes offset_{};
    Lanes offset_rate_{};
    Lanes velocity_{};
    bool at_rest_ = true;
};

} // namespace spidar
