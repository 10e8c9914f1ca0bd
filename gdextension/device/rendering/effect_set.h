// Renders effects on any DOF in each servo cycle: viscous field, force, spring to a point,
// vibration, detents.
#pragma once

#include <algorithm>

#include "core/base/sound_state.h"
#include "device/contract/dof_lanes.h"
#include "device/contract/haptic_command.h"
#include "device/contract/motion.h"
#include "device/settings/gain_clamp.h"
#include "device/settings/servo_settings.h"

namespace spidar {

class EffectSet {
public:
    void configure(const ServoSettings &settings) noexcept;
    // Changes the caps for effects that are accepted from now on; all other state stays.
    void retune(const ServoSettings &settings) noexcept;
    // Replaces the effects by a valid set (validate_effects). An effect whose id and kind were in
    // the last set continues. Starts, changes and removals are spread over kCrossFade_s. Returns
    // the first value that was clamped.
    GainClamp accept(const HapticCommand &command) noexcept;
    // Ages the effects by one cycle; called before accept(). Returns the number of effects that
    // ended in this cycle.
    int age(double dt_s) noexcept;
    Wrench render(const GripMotion &motion) noexcept;
    // True when every effect of the set has ended and the removed ones have faded.
    [[nodiscard]] bool at_rest() const noexcept;
    // Checks restored memory: see core/base/sound_state.h.
    [[nodiscard]] bool is_sound() const noexcept {
        return count_ <= tracks_.size() && are_flags(caps_.from_latency) &&
               std::all_of(tracks_.begin(), tracks_.end(), [](const auto &one) {
                   return are_flags(one.ended) &&
                          static_cast<int>(one.effect.kind) < kEffectKindCount;
               });
    }

private:
    struct Track {
        Effect effect;       // as last received, clamped
        DofGains from{};     // gain at the time of the last change
        double fade_s = 0.0; // time since the last change
        double age_s = 0.0;
        double phase_rad = 0.0;
        bool ended = false;
    };
    [[nodiscard]] DofGains gain_now(const Track &track) const noexcept;
    [[nodiscard]] DofLanes force(const Track &track, const GripMotion &motion) const noexcept;
    GainClamp cap(Effect &effect, std::int32_t index) const noexcept;

    double fade_out_s_ = 0.05;
    double rate_hz_ = 1000.0;
    GainCaps caps_{};
    std::array<Track, kMaxEffects> tracks_{};
    std::size_t count_ = 0;
    // Forces of removed effects; leaving_part_ falls from 1 to 0 in kCrossFade_s.
    DofLanes leaving_{};
    double leaving_part_ = 0.0;
    // Force of each effect in the last cycle.
    std::array<DofLanes, kMaxEffects> last_{};
};

} // namespace spidar
