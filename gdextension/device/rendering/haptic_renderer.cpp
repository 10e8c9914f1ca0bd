#include "device/rendering/haptic_renderer.h"

#include "device/contract/dof_lanes.h"

namespace spidar {

void HapticRenderer::configure(const ServoSettings &settings) noexcept {
    *this = HapticRenderer();
    const RenderSettings &render = settings.render;
    motion_.configure(render, settings.rate_hz);
    contacts_.configure(settings);
    coupling_.configure(settings);
    wrench_.configure(settings.safety);
    effects_.configure(settings);
    const double share = render.passivity_share;
    const double linear = share * render.max_damping_n_s_m;
    const double turn = share * render.max_turn_damping_nm_s_rad;
    controller_.configure(
        {linear, linear, linear, turn, turn, turn, share * render.max_grasp_damping_nm_s_rad});
    load_.force_n = -render.compensated_mass_kg * render.gravity_m_s2;
}

void HapticRenderer::retune(const ServoSettings &settings) noexcept {
    contacts_.retune(settings);
    coupling_.retune(settings);
    effects_.retune(settings);
    wrench_.retune(settings.safety);
}

void HapticRenderer::acknowledge(const HapticCommand &command) noexcept {
    wrench_sequence_ = command.wrench_sequence;
    contacts_sequence_ = command.contacts_sequence;
    coupling_sequence_ = command.coupling_sequence;
    effects_sequence_ = command.effects_sequence;
}

void HapticRenderer::note(const GainClamp &clamp, ServoCounters &counters) noexcept {
    if (clamp.gain != GainClamp::Gain::none) {
        last_clamp_ = clamp;
        ++counters.clamped_requests;
    }
}

void HapticRenderer::take(const HapticCommand &command, double now_s, double dt_s,
                          ServoCounters &counters) noexcept {
    counters.expired_requests += wrench_.age(dt_s) ? 1U : 0U;
    counters.expired_requests += contacts_.age(dt_s) ? 1U : 0U;
    counters.expired_requests += coupling_.age(dt_s) ? 1U : 0U;
    counters.expired_requests += static_cast<std::uint64_t>(effects_.age(dt_s));
    // A renewed sequence that is not valid: the last good request stands until it expires.
    const auto is_new = [&counters](std::uint64_t &seen, std::uint64_t sequence, auto &&validate) {
        if (sequence == seen) {
            return false;
        }
        seen = sequence;
        const bool good = usable(validate());
        counters.rejected_requests += good ? 0U : 1U;
        return good;
    };
    if (is_new(wrench_sequence_, command.wrench_sequence,
               [&] { return validate_wrench(command.wrench, command.wrench_duration_s); })) {
        note(wrench_.accept(command.wrench, command.wrench_duration_s), counters);
    }
    if (is_new(contacts_sequence_, command.contacts_sequence,
               [&] { return validate_contacts(command); })) {
        note(contacts_.accept(command, now_s), counters);
    }
    if (is_new(coupling_sequence_, command.coupling_sequence,
               [&] { return validate_coupling(command.coupling); })) {
        note(coupling_.accept(command.coupling, now_s), counters);
    }
    if (is_new(effects_sequence_, command.effects_sequence,
               [&] { return validate_effects(command); })) {
        note(effects_.accept(command), counters);
    }
}

Wrench HapticRenderer::render(const GripState &grip, const Displacement &moved, bool trusted,
                              double dt_s) noexcept {
    observer_.update(moved);
    GripMotion motion;
    motion.grip = grip;
    if (trusted) {
        motion_.update(moved, dt_s);
        motion.ahead = motion_.ahead();
        motion.velocity = motion_.velocity();
        motion.lead_s = motion_.steady_lead_s();
    } else {
        motion_.reset();
    }
    // A raw wrench is given as it was asked: whoever asks for one answers for its energy.
    const Wrench held = coupling_.render(motion);
    Wrench sum = wrench_.value() + controller_.correct(held, moved, motion.velocity, dt_s);
    contact_push_ = Wrench();
    if (!contacts_.empty()) {
        contact_push_ = contacts_.render(motion, dt_s);
        sum = sum + contact_push_;
    }
    if (!effects_.empty()) {
        sum = sum + effects_.render(motion);
    }
    return sum + load_;
}

void HapticRenderer::given(double scale, double dt_s) noexcept {
    contacts_.integrate(scale, dt_s);
    observer_.hold(Wrench()); // until it is known what the strings give
}

void HapticRenderer::report(ServoSnapshot &snapshot) const noexcept {
    snapshot.contact_count = contacts_.report(snapshot.contacts);
    snapshot.injected_j = observer_.injected_j();
    snapshot.clamp = last_clamp_;
}

bool HapticRenderer::has_seen(const HapticCommand &command) const noexcept {
    return command.wrench_sequence == wrench_sequence_ &&
           command.contacts_sequence == contacts_sequence_ &&
           command.coupling_sequence == coupling_sequence_ &&
           command.effects_sequence == effects_sequence_;
}

bool HapticRenderer::at_rest() const noexcept {
    return contacts_.empty() && effects_.empty() && !coupling_.live() && motion_.settled() &&
           controller_.settled();
}

// What is over or empty has an age too: a game that comes back is judged by it.
void HapticRenderer::wait(double dt_s) noexcept {
    wrench_.age(dt_s);
    contacts_.age(dt_s);
    effects_.age(dt_s);
}

} // namespace spidar
