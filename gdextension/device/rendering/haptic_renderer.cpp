#include "device/rendering/haptic_renderer.h"

#include "device/contract/dof_lanes.h"

namespace spidar {

void HapticRenderer::configure(const ServoSettings &settings) noexcept {
    ProxyMemory *const memory = parts_.touch.memory();
    *this = HapticRenderer();
    parts_.touch.use(memory);
    const RenderSettings &render = settings.render;
    parts_.motion.configure(render, settings.rate_hz);
    parts_.contacts.configure(settings);
    parts_.touch.configure(settings);
    parts_.coupling.configure(settings);
    parts_.wrench.configure(settings.safety);
    parts_.effects.configure(settings);
    const double share = render.passivity_share;
    const double linear = share * render.max_damping_n_s_m;
    const double turn = share * render.max_turn_damping_nm_s_rad;
    parts_.controller.configure(
        {linear, linear, linear, turn, turn, turn, share * render.max_grasp_damping_nm_s_rad});
    load_.force_n = -render.compensated_mass_kg * render.gravity_m_s2;
}

void HapticRenderer::retune(const ServoSettings &settings) noexcept {
    parts_.contacts.retune(settings);
    parts_.touch.retune(settings);
    parts_.coupling.retune(settings);
    parts_.effects.retune(settings);
    parts_.wrench.retune(settings.safety);
}

void HapticRenderer::acknowledge(const HapticCommand &command) noexcept {
    wrench_sequence_ = command.wrench_sequence;
    contacts_sequence_ = command.contacts_sequence;
    touch_sequence_ = command.touch_sequence;
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
    counters.expired_requests += parts_.wrench.age(dt_s) ? 1U : 0U;
    counters.expired_requests += parts_.contacts.age(dt_s) ? 1U : 0U;
    counters.expired_requests += parts_.touch.age(dt_s) ? 1U : 0U;
    counters.expired_requests += parts_.coupling.age(dt_s) ? 1U : 0U;
    counters.expired_requests += static_cast<std::uint64_t>(parts_.effects.age(dt_s));
    // A new sequence number with an invalid request: the last valid request stays until it expires.
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
        note(parts_.wrench.accept(command.wrench, command.wrench_duration_s), counters);
    }
    if (is_new(contacts_sequence_, command.contacts_sequence,
               [&] { return validate_contacts(command); })) {
        note(parts_.contacts.accept(command, now_s), counters);
    }
    const TouchScene *const touch = command.touch;
    if (is_new(touch_sequence_, command.touch_sequence, [&] {
            return touch == nullptr        ? Status::ok
                   : !parts_.touch.ready() ? Status::invalid_request
                                           : validate(*touch);
        })) {
        if (touch == nullptr) {
            parts_.touch.accept_nothing(command.touch_sequence);
        } else {
            note(parts_.touch.accept(*touch, command.touch_sequence, now_s), counters);
        }
    }
    if (is_new(coupling_sequence_, command.coupling_sequence,
               [&] { return validate_coupling(command.coupling); })) {
        note(parts_.coupling.accept(command.coupling, now_s), counters);
    }
    if (is_new(effects_sequence_, command.effects_sequence,
               [&] { return validate_effects(command); })) {
        note(parts_.effects.accept(command), counters);
    }
}

Wrench HapticRenderer::touch_push(GripMotion motion, const FingerMotion &fingers,
                                  double dt_s) noexcept {
    if (!fingers.given) {
        return parts_.touch.render(motion, dt_s);
    }
    motion.grip.frame.grasp_angle_rad = fingers.angle_rad;
    motion.ahead.grasp_rad = motion.lead_s * fingers.rate_rad_s;
    motion.velocity.grasp_rate_rad_s = fingers.rate_rad_s;
    Wrench push = parts_.touch.render(motion, dt_s);
    push.grasp_torque_nm = 0.0;
    return push;
}

Wrench HapticRenderer::render(const GripState &grip, const Displacement &moved,
                              const FingerMotion &fingers, bool trusted, double dt_s) noexcept {
    parts_.observer.update(moved);
    GripMotion motion;
    motion.grip = grip;
    if (trusted) {
        parts_.motion.update(moved, dt_s);
        motion.ahead = parts_.motion.ahead();
        motion.velocity = parts_.motion.velocity();
        motion.lead_s = parts_.motion.steady_lead_s();
    } else {
        parts_.motion.reset();
    }
    // A raw wrench bypasses the passivity controller: its sender is responsible for its energy.
    const Wrench held = parts_.coupling.render(motion);
    Wrench sum =
        parts_.wrench.value() + parts_.controller.correct(held, moved, motion.velocity, dt_s);
    contact_push_ = Wrench();
    if (!parts_.contacts.at_rest()) {
        contact_push_ = parts_.contacts.render(motion, dt_s);
    }
    if (parts_.touch.ready()) {
        contact_push_ = contact_push_ + touch_push(motion, fingers, dt_s);
    }
    sum = sum + contact_push_;
    if (!parts_.effects.at_rest()) {
        sum = sum + parts_.effects.render(motion);
    }
    return sum + load_;
}

void HapticRenderer::given(double scale, double dt_s) noexcept {
    parts_.contacts.integrate(scale, dt_s);
    parts_.touch.integrate(scale, dt_s);
    parts_.observer.hold(Wrench()); // until the wrench of the strings is known
}

void HapticRenderer::report(ServoSnapshot &snapshot) const noexcept {
    snapshot.contact_count = parts_.contacts.report(snapshot.contacts);
    parts_.touch.report(snapshot.touch);
    snapshot.injected_j = parts_.observer.injected_j();
    snapshot.clamp = last_clamp_;
}

bool HapticRenderer::has_seen(const HapticCommand &command) const noexcept {
    return command.wrench_sequence == wrench_sequence_ &&
           command.contacts_sequence == contacts_sequence_ &&
           command.touch_sequence == touch_sequence_ &&
           command.coupling_sequence == coupling_sequence_ &&
           command.effects_sequence == effects_sequence_;
}

// Requests that ended or are empty age too: the age decides about the next update of the game.
void HapticRenderer::advance_at_rest(double dt_s) noexcept {
    parts_.wrench.age(dt_s);
    parts_.contacts.age(dt_s);
    parts_.touch.age(dt_s);
    parts_.effects.age(dt_s);
}

} // namespace spidar
