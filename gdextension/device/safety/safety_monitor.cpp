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
    strings_ = strings;
    safety_ = settings.safety;
    speed_.configure(safety_);
    heat_.configure(safety_);
    workspace_.configure(settings);
    hand_.configure(safety_);
    return Status::ok;
}

void SafetyMonitor::restart() noexcept {
    speed_.configure(safety_);
    shake_.configure();
    bounce_.configure();
    strings_.reset();
    hand_.restart();
    named_told_ = false;
    fade_ = 1.0;
    scale_ = 1.0;
    fading_ = false;
}

SafetyMonitor::Verdict SafetyMonitor::watch_strings(const Sample &sample, EventLog &events,
                                                    double dt_s) noexcept {
    if (sample.fresh) {
        strings_.update(sample.counts, sample.lengths_m, sample.grip, sample.moved,
                        sample.strongest_n, dt_s);
    }
    if (strings_.suspicious()) {
        events.tell(DeviceEventKind::string_suspected, strings_.string(), strings_.parity_m());
    }
    const FaultEvidence &named = strings_.named();
    const bool found = named.fault != StringFault::none;
    if (found && !named_told_) {
        events.tell(DeviceEventKind::string_named, named.string, named.error_m);
    }
    named_told_ = found;
    if (strings_.faulty()) {
        return {Action::motors_off, Status::string_fault, strings_.string()};
    }
    return found ? Verdict{Action::stand_down, Status::string_fault, named.string} : Verdict{};
}

SafetyMonitor::Verdict SafetyMonitor::watch_motion(const Sample &sample, EventLog &events,
                                                   double dt_s) noexcept {
    speed_.update(sample.fastest_m_s, sample.grip.twist, dt_s);
    shake_.update(sample.grip.twist, sample.contact_push, sample.motors_on && sample.rendering,
                  dt_s);
    if (!sample.motors_on) {
        bounce_.configure();
        return {};
    }
    if (bounce_.update(sample.grip.twist, sample.contact_push, dt_s)) {
        // Three bounces have given enough: to a quarter at once, and off at the next row.
        shake_.found(bounce_.speed_m_s());
        shake_.found(bounce_.speed_m_s());
    }
    if (speed_.too_fast()) {
        return {Action::motors_off, Status::over_speed, -1};
    }
    if (speed_.fast(dt_s)) {
        events.tell(DeviceEventKind::fast_grip, -1, sample.fastest_m_s);
    }
    if (shake_.unstable()) {
        return {Action::motors_off, Status::unstable, -1};
    }
    if (shake_.scale() < 1.0) {
        events.tell(DeviceEventKind::shaking, -1, shake_.swing_m_s());
    }
    const double beyond_m = workspace_.beyond_m(sample.grip);
    if (beyond_m > 0.0) {
        events.tell(DeviceEventKind::workspace_edge, -1, beyond_m);
    }
    return {};
}

SafetyMonitor::Verdict SafetyMonitor::watch_heat(EventLog &events) noexcept {
    if (!(heat_.spent() < 1.0)) {
        return {Action::stand_down, Status::overheated, heat_.warmest_string()};
    }
    if (heat_.scale() < 1.0) {
        events.tell(DeviceEventKind::motors_warm, heat_.warmest_string(), heat_.spent());
    }
    return {};
}

SafetyMonitor::Verdict SafetyMonitor::watch(const Sample &sample, EventLog &events,
                                            double dt_s) noexcept {
    if (sample.fresh) {
        hand_.update(sample.grip.pose, dt_s);
    }
    const Verdict strings = watch_strings(sample, events, dt_s);
    const Verdict motion = watch_motion(sample, events, dt_s);
    const Verdict heat = watch_heat(events);
    fading_ = strings_.suspicious() || speed_.fast(dt_s);
    fade_ =
        fading_ ? std::max(0.0, fade_ - dt_s / kFade_s) : std::min(1.0, fade_ + dt_s / kRecovery_s);
    scale_ = fade_ * shake_.scale() * heat_.scale() * WorkspaceGuard::scale(sample.grip);
    Verdict worst = strings;
    for (const Verdict &other : {motion, heat}) {
        worst = other.action > worst.action ? other : worst;
    }
    return sample.motors_on ? worst : Verdict{};
}

} // namespace spidar
