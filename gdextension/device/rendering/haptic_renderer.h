// Adds all requests to one wrench in each cycle: contact planes, shapes, coupling, raw wrench,
// effects and the compensation of the grip's weight. Each request ages and fades by itself.
#pragma once

#include "core/base/sound_state.h"
#include "device/contact/contact_renderer.h"
#include "device/contact/touch/touch_renderer.h"
#include "device/contract/rest.h"
#include "device/contract/servo_snapshot.h"
#include "device/rendering/coupling_request.h"
#include "device/rendering/effect_set.h"
#include "device/rendering/motion_filter.h"
#include "device/rendering/passivity.h"
#include "device/rendering/wrench_request.h"

namespace spidar {

class HapticRenderer {
public:
    void configure(const ServoSettings &settings) noexcept;
    // Changes limits and caps; active requests continue.
    void retune(const ServoSettings &settings) noexcept;
    // Renders shapes; see TouchRenderer.
    [[nodiscard]] TouchRenderer &touch() noexcept { return parts_.touch; }
    [[nodiscard]] const TouchRenderer &touch() const noexcept { return parts_.touch; }
    // Marks the requests of this command as seen, without rendering them.
    void acknowledge(const HapticCommand &command) noexcept;

    // Called first in each cycle: ages the present requests, then takes new ones. An invalid
    // request is counted, and the last valid one stays until it expires. now_s:
    // ServoSnapshot::time_s of this cycle.
    void take(const HapticCommand &command, double now_s, double dt_s,
              ServoCounters &counters) noexcept;

    // Returns the requested wrench, not yet limited by limit_factor(). moved: displacement in the
    // last cycle. fingers: those of a rigid grip, for shapes. trusted: the pose is current;
    // otherwise the grip is not predicted and its velocity counts as 0.
    Wrench render(const GripState &grip, const Displacement &moved, const FingerMotion &fingers,
                  bool trusted, double dt_s) noexcept;
    // Called after render(): adds the impulses of contacts. scale: share of the returned wrench
    // that was requested from the strings.
    void given(double scale, double dt_s) noexcept;
    // Takes the wrench of the commanded tensions, from which the energy is computed.
    void achieved(const Wrench &wrench) noexcept { parts_.observer.hold(wrench); }

    // The part of planes and shapes in the wrench of the last render().
    [[nodiscard]] const Wrench &contact_push() const noexcept { return contact_push_; }

    void report(ServoSnapshot &snapshot) const noexcept;

    // Returns whether this command contains no new request.
    [[nodiscard]] bool has_seen(const HapticCommand &command) const noexcept;
    // True when no part changes: the grip stands still, and nothing but a raw wrench in full
    // strength is requested.
    [[nodiscard]] bool at_rest() const noexcept { return all_at_rest(parts_); }
    [[nodiscard]] std::uint32_t awake_parts() const noexcept { return awake_mask(parts_); }
    [[nodiscard]] bool rests_through(double dt_s) const noexcept {
        return parts_.wrench.rests_through(dt_s);
    }
    void advance_at_rest(double dt_s) noexcept;
    // Checks restored memory: see core/base/sound_state.h.
    [[nodiscard]] bool is_sound() const noexcept {
        return parts_.motion.is_sound() && parts_.contacts.is_sound() && parts_.touch.is_sound() &&
               parts_.coupling.is_sound() && parts_.wrench.is_sound() &&
               parts_.effects.is_sound() && parts_.controller.is_sound() &&
               parts_.observer.is_sound() && spidar::is_sound(last_clamp_);
    }

private:
    Wrench touch_push(GripMotion motion, const FingerMotion &fingers, double dt_s) noexcept;
    void note(const GainClamp &clamp, ServoCounters &counters) noexcept;

    struct Parts {
        MotionFilter motion;
        ContactRenderer contacts;
        TouchRenderer touch;
        CouplingRequest coupling;
        WrenchRequest wrench;
        EffectSet effects;
        PassivityController controller;
        EnergyObserver observer;
        template <typename Combine>
        auto with_all(Combine &&combine) const noexcept {
            const auto &[a, b, c, d, e, f, g, h] = *this;
            return combine(a, b, c, d, e, f, g, h);
        }
    };
    Parts parts_;
    Wrench contact_push_{};
    Wrench load_{}; // compensates the grip's weight
    GainClamp last_clamp_{};
    std::uint64_t wrench_sequence_ = 0;
    std::uint64_t contacts_sequence_ = 0;
    std::uint64_t touch_sequence_ = 0;
    std::uint64_t coupling_sequence_ = 0;
    std::uint64_t effects_sequence_ = 0;
};

} // namespace spidar
