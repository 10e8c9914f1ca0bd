// All that watches the grip while forces act, and what it decides: scale the wrench down, let the forces go, or
// switch the motors off. Each part has a file of its own.
#pragma once

#include "device/contract/device_event.h"
#include "device/safety/monitors/bounce_monitor.h"
#include "device/safety/monitors/hand_presence.h"
#include "device/safety/monitors/shake_monitor.h"
#include "device/safety/monitors/speed_guard.h"
#include "device/safety/monitors/string_monitor.h"
#include "device/safety/monitors/thermal_budget.h"
#include "device/safety/monitors/workspace_guard.h"

namespace spidar {

class SafetyMonitor {
public:
    enum class Action : std::uint8_t { none, stand_down, motors_off };
    struct Verdict {
        Action action = Action::none;
        Status status = Status::ok; // why
        int string = -1;
    };
    struct Sample {
        const GripState &grip;
        const CountArray &counts;
        const StringArray &lengths_m;
        double fastest_m_s = 0.0;
        double strongest_n = 0.0; // largest tension commanded
        bool fresh = false;       // a good sample came in this cycle
        bool moved = false;       // with another pose
        bool motors_on = false;
        bool rendering = false; // a wrench is asked for
        Wrench contact_push{};  // the part of it that contacts ask for
    };

    Status configure(const ServoSettings &settings) noexcept;
    // A fault was cleared or a zero taken: the grip starts with a clean record (heat stays).
    void restart() noexcept;

    Verdict watch(const Sample &sample, EventLog &events, double dt_s) noexcept;
    // What the motors pull in this cycle (unit: N).
    void spend(const StringArray &tensions_n, double dt_s) noexcept {
        heat_.spend(tensions_n, dt_s);
    }

    // Nothing is scaled down, and watch() of the same sample changes nothing but the age of the hand's last move.
    [[nodiscard]] bool at_rest() const noexcept {
        return fade_ >= 1.0 && scale_ >= 1.0 && !fading_ && shake_.settled() && bounce_.settled() &&
               strings_.settled();
    }
    // In place of watch(), at rest.
    void wait(double dt_s) noexcept { hand_.wait(dt_s); }
    // What is left of the wrench, 0..1. Falls to zero within 20 ms, comes back within 50.
    [[nodiscard]] double wrench_scale() const noexcept { return scale_; }
    // False: the velocity is not to be damped with.
    [[nodiscard]] bool velocity_trusted() const noexcept { return !fading_; }
    [[nodiscard]] Wrench wall(const GripState &grip) const noexcept {
        return workspace_.wall(grip);
    }
    [[nodiscard]] bool hand_present() const noexcept { return hand_.present(); }
    [[nodiscard]] const StringMonitor &strings() const noexcept { return strings_; }
    [[nodiscard]] const ThermalBudget &heat() const noexcept { return heat_; }

private:
    Verdict watch_strings(const Sample &sample, EventLog &events, double dt_s) noexcept;
    Verdict watch_motion(const Sample &sample, EventLog &events, double dt_s) noexcept;
    Verdict watch_heat(EventLog &events) noexcept;

    SafetySettings safety_{};
    SpeedGuard speed_;
    ShakeMonitor shake_;
    BounceMonitor bounce_;
    StringMonitor strings_;
    ThermalBudget heat_;
    WorkspaceGuard workspace_;
    HandPresence hand_;
    double fade_ = 1.0;
    double scale_ = 1.0;
    bool fading_ = false;
    bool named_told_ = false;
};

} // namespace spidar
