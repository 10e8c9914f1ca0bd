#include "device/safety/safety_monitor.h"

#include <algorithm>

namespace spidar {

namespace {

constexpr double kFade_s = 0.020;
constexpr double kRecovery_s = 0.050;

} // namespace

Status SafetyMonitor::configure(const ServoSettings &settings) noexcept {
    StringMonitor strings;
    const Status status = strings.configure(settings);
    if (!usable(status)) {
        return status;
    }
    *this = SafetyMonitor();
    parts_.strings = strings;
    safety_ = settings.safety;
    parts_.speed.configure(safety_);
    parts_.heat.configure(safety_);
    workspace_.configure(settings);
    parts_.hand.configure(safety_);
    return Status::ok;
}

void SafetyMonitor::restart() noexcept {
    parts_.speed.configure(safety_);
    parts_.shake.configure();
    parts_.bounce.configure();
    parts_.strings.reset();
    parts_.hand.restart();
    named_told_ = false;
    fade_ = 1.0;
    scale_ = 1.0;
    fading_ = false;
}

SafetyMonitor::Verdict SafetyMonitor::watch_strings(const Sample &sample, EventLog &events,
                                                    double dt_s) noexcept {
    if (sample.fresh) {
        parts_.strings.update(sample.counts, sample.lengths_m, sample.grip, sample.moved,
                              sample.strongest_n, dt_s);
    }
    if (parts_.strings.suspicious()) {
        events.tell(DeviceEventKind::string_suspected, parts_.strings.string(),
                    parts_.strings.parity_m());
    }
    const FaultEvidence &named = parts_.strings.named();
    const bool found = named.fault != StringFault::none;
    if (found && !named_told_) {
        events.tell(DeviceEventKind::string_named, named.string, named.error_m);
    }
    named_told_ = found;
    if (parts_.strings.faulty()) {
        return {StopReason::fault, Status::string_fault, parts_.strings.string()};
    }
    return found ? Verdict{StopReason::string_named, Status::string_fault, named.string}
                 : Verdict{};
}

SafetyMonitor::Verdict SafetyMonitor::watch_motion(const Sample &sample, EventLog &events,
                                                   double dt_s) noexcept {
    parts_.speed.update(sample.fastest_m_s, sample.grip.twist, dt_s);
    parts_.shake.update(sample.grip.twist, sample.contact_push,
                        sample.motors_on && sample.rendering, dt_s);
    if (!sample.motors_on) {
        parts_.bounce.configure();
        return {};
    }
    if (parts_.bounce.update(sample.grip.twist, sample.contact_push, dt_s)) {
        // A series of bounces counts as two halvings: to a quarter at once, and off at the next
        // series.
        parts_.shake.found(parts_.bounce.speed_m_s());
        parts_.shake.found(parts_.bounce.speed_m_s());
    }
    if (parts_.speed.too_fast()) {
        return {StopReason::fault, Status::over_speed, -1};
    }
    if (parts_.speed.fast(dt_s)) {
        events.tell(DeviceEventKind::fast_grip, -1, sample.fastest_m_s);
    }
    if (parts_.shake.unstable()) {
        return {StopReason::fault, Status::unstable, -1};
    }
    if (parts_.shake.scale() < 1.0) {
        events.tell(DeviceEventKind::shaking, -1, parts_.shake.swing_m_s());
    }
    const double beyond_m = workspace_.beyond_m(sample.grip);
    if (beyond_m > 0.0) {
        events.tell(DeviceEventKind::workspace_edge, -1, beyond_m);
    }
    return {};
}

SafetyMonitor::Verdict SafetyMonitor::watch_heat(EventLog &events) noexcept {
    if (parts_.heat.is_spent()) {
        return {StopReason::overheated, Status::overheated, parts_.heat.warmest_string()};
    }
    if (parts_.heat.scale() < 1.0) {
        events.tell(DeviceEventKind::motors_warm, parts_.heat.warmest_string(),
                    parts_.heat.spent());
    }
    return {};
}

SafetyMonitor::Verdict SafetyMonitor::watch(const Sample &sample, EventLog &events,
                                            double dt_s) noexcept {
    if (sample.fresh) {
        parts_.hand.update(sample.grip.pose, dt_s);
    }
    const Verdict strings = watch_strings(sample, events, dt_s);
    const Verdict motion = watch_motion(sample, events, dt_s);
    const Verdict heat = watch_heat(events);
    fading_ = parts_.strings.suspicious() || parts_.speed.fast(dt_s);
    fade_ =
        fading_ ? std::max(0.0, fade_ - dt_s / kFade_s) : std::min(1.0, fade_ + dt_s / kRecovery_s);
    scale_ =
        fade_ * parts_.shake.scale() * parts_.heat.scale() * WorkspaceGuard::scale(sample.grip);
    if (!sample.motors_on) {
        return {};
    }
    // A fault comes before a reason to fade; of two of a kind the first.
    Verdict worst = strings;
    for (const Verdict &other : {motion, heat}) {
        const bool is_worse = worst.status == Status::ok || (worst.reason != StopReason::fault &&
                                                             other.reason == StopReason::fault);
        worst = other.status != Status::ok && is_worse ? other : worst;
    }
    return worst;
}

} // namespace spidar
