// Runs the monitors of the grip. They scale the wrench down or, while the motors are on, give a
// reason to stop (motor_rule.h). Each monitor has its own file.
#pragma once

#include "core/base/sound_state.h"
#include "device/contract/device_event.h"
#include "device/contract/rest.h"
#include "device/safety/monitors/bounce_monitor.h"
#include "device/safety/monitors/hand_presence.h"
#include "device/safety/monitors/shake_monitor.h"
#include "device/safety/monitors/speed_guard.h"
#include "device/safety/monitors/string_monitor.h"
#include "device/safety/monitors/thermal_budget.h"
#include "device/safety/monitors/workspace_guard.h"
#include "device/safety/motor_rule.h"

namespace spidar {

class SafetyMonitor {
public:
    // A reason to stop for motor_rule.h. There is none while `status` is ok.
    struct Verdict {
        StopReason reason = StopReason::fault;
        Status status = Status::ok;
        int string = -1;
    };
    struct Sample {
        const GripState &grip;
        const CountArray &counts;
        const StringArray &lengths_m;
        double fastest_m_s = 0.0;
        double strongest_n = 0.0; // largest commanded tension
        bool fresh = false;       // a good sample arrived in this cycle
        bool moved = false;       // the pose changed
        bool motors_on = false;
        bool rendering = false; // a wrench is requested
        Wrench contact_push{};  // the part of it that contacts request
    };

    Status configure(const ServoSettings &settings) noexcept;
    // Restarts after a cleared fault or a new zero. The heat stays.
    void restart() noexcept;

    Verdict watch(const Sample &sample, EventLog &events, double dt_s) noexcept;
    // Heats the motors' model by the tensions of this cycle (unit: N).
    void spend(const StringArray &tensions_n, double dt_s) noexcept {
        parts_.heat.spend(tensions_n, dt_s);
    }

    // True when nothing is scaled down and all monitors are at rest. spend() must still be called.
    [[nodiscard]] bool at_rest() const noexcept {
        return fade_ >= 1.0 && scale_ >= 1.0 && !fading_ && all_at_rest(parts_);
    }
    void advance_at_rest(double dt_s) noexcept { parts_.hand.advance_at_rest(dt_s); }
    [[nodiscard]] bool rests_through(double /*dt_s*/) const noexcept {
        return parts_.heat.at_rest();
    }
    [[nodiscard]] std::uint32_t awake_parts() const noexcept { return awake_mask(parts_); }
    // Scale of the wrench, 0..1: the product of a fade (to 0 within 20 ms while a string is
    // suspected or the grip is too fast, back to 1 within 50 ms) and of the scales of shaking, heat
    // and workspace.
    [[nodiscard]] double wrench_scale() const noexcept { return scale_; }
    // False while the velocity must not be used for damping.
    [[nodiscard]] bool velocity_trusted() const noexcept { return !fading_; }
    [[nodiscard]] Wrench wall(const GripState &grip) const noexcept {
        return workspace_.wall(grip);
    }
    [[nodiscard]] bool hand_present() const noexcept { return parts_.hand.present(); }
    [[nodiscard]] const StringMonitor &strings() const noexcept { return parts_.strings; }
    [[nodiscard]] const ThermalBudget &heat() const noexcept { return parts_.heat; }
    void set_heat(const StringArray &heat) noexcept { parts_.heat.set_heat(heat); }
    // Checks restored memory: see core/base/sound_state.h.
    [[nodiscard]] bool is_sound() const noexcept {
        return are_flags(fading_, named_told_) && workspace_.is_sound() &&
               parts_.speed.is_sound() && parts_.shake.is_sound() && parts_.bounce.is_sound() &&
               parts_.strings.is_sound() && parts_.hand.is_sound();
    }

private:
    Verdict watch_strings(const Sample &sample, EventLog &events, double dt_s) noexcept;
    Verdict watch_motion(const Sample &sample, EventLog &events, double dt_s) noexcept;
    Verdict watch_heat(EventLog &events) noexcept;

    SafetySettings safety_{};
    WorkspaceGuard workspace_; // has no state
    struct Parts {
        SpeedGuard speed;
        ShakeMonitor shake;
        BounceMonitor bounce;
        StringMonitor strings;
        ThermalBudget heat;
        HandPresence hand;
        template <typename Combine>
        auto with_all(Combine &&combine) const noexcept {
            const auto &[a, b, c, d, e, f] = *this;
            return combine(a, b, c, d, e, f);
        }
    };
    Parts parts_;
    double fade_ = 1.0;
    double scale_ = 1.0;
    bool fading_ = false;
    bool named_told_ = false;
};

} // namespace spidar
