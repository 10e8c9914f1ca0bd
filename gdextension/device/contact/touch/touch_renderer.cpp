#include "device/contact/touch/touch_renderer.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "core/geometry/rotation_log.h"
#include "device/contract/dof_lanes.h"

namespace spidar {

namespace {

// Distance of a part between two scenes above which it was teleported: nothing lies in between.
constexpr double kJump_m = 0.05;
constexpr double kJump_rad = 0.5;
// Longest damping time, for soft contacts: their velocity is measured over some milliseconds.
constexpr double kMostDamping_s = 0.01;

bool same(const ToolPose &a, const ToolPose &b) noexcept {
    return a.position_m == b.position_m && a.rotation == b.rotation && a.grasp_rad == b.grasp_rad;
}

bool same(const Wrench &a, const Wrench &b) noexcept {
    return lanes(a) == lanes(b);
}

bool same(const Twist &a, const Twist &b) noexcept {
    return lanes(a) == lanes(b);
}

Wrench blend(const Wrench &from, const Wrench &to, double share) noexcept {
    return (1.0 - share) * from + share * to;
}

// Limits the length of a velocity and keeps its direction.
Vec3 capped_speed(const Vec3 &velocity_m_s, std::int32_t index, GainClamp &clamp) noexcept {
    const double speed_m_s = glm::length(velocity_m_s);
    const double given_m_s =
        capped(speed_m_s, kMaxSurfaceSpeed_m_s, GainClamp::Gain::speed, index, false, clamp);
    return given_m_s < speed_m_s ? (given_m_s / speed_m_s) * velocity_m_s : velocity_m_s;
}

// Returns the common part of two motions per axis: the smaller one where the signs agree. A single
// jolt is thereby ignored.
Vec3 shared(const Vec3 &a, const Vec3 &b) noexcept {
    Vec3 both(0.0);
    for (int axis = 0; axis < 3; ++axis) {
        if (a[axis] * b[axis] > 0.0) {
            both[axis] = std::abs(a[axis]) < std::abs(b[axis]) ? a[axis] : b[axis];
        }
    }
    return both;
}

} // namespace

static_assert(kMostTouchParts == kMaxSceneParts && kMostTouchPoints == kMaxPoints);

void TouchRenderer::configure(const ServoSettings &settings) noexcept {
    ProxyMemory *const memory = memory_;
    *this = TouchRenderer();
    memory_ = memory;
    strength_.configure(settings.safety);
    retune(settings);
}

void TouchRenderer::retune(const ServoSettings &settings) noexcept {
    caps_ = gain_caps(settings.render, settings.rate_hz);
    GainClamp unnoted;
    tune(unnoted);
    use_wanted_springs();
}

void TouchRenderer::use_wanted_springs() noexcept {
    settings_ = wanted_settings_;
    springs_left_s_ = 0.0;
    proxy_.configure(settings_);
    settled_ = false;
}

void TouchRenderer::tune(GainClamp &clamp) noexcept {
    // The proxy divides by this value.
    constexpr double kSoftest = 1e-6;
    for (std::size_t dof = 0; dof < asked_.size(); ++dof) {
        const DofCap cap = stiffness_cap(caps_, dof);
        const double wanted =
            asked_[dof] > 0.0 ? capped(asked_[dof], cap.most, cap.gain,
                                       static_cast<std::int32_t>(dof), caps_.from_latency, clamp)
                              : kAutomaticShare * cap.most;
        wanted_settings_.stiffness[dof] = std::max(wanted, kSoftest);
    }
    // One time constant for all DOF, so that none is damped above its cap.
    const double damping_n_s_m = capped(asked_damping_n_s_m_, caps_.damping_n_s_m,
                                        GainClamp::Gain::damping, 0, false, clamp);
    wanted_settings_.damping_s = kMostDamping_s;
    double stiffest_n_m = 0.0;
    for (std::size_t dof = 0; dof < asked_.size(); ++dof) {
        const double stiffness = wanted_settings_.stiffness[dof];
        stiffest_n_m = std::max(stiffest_n_m, dof < 3 ? stiffness : 0.0);
        wanted_settings_.damping_s =
            std::min(wanted_settings_.damping_s, damping_cap(caps_, dof).most / stiffness);
    }
    wanted_settings_.damping_s = std::min(wanted_settings_.damping_s, damping_n_s_m / stiffest_n_m);
}

GainClamp TouchRenderer::accept(const TouchScene &touch, std::uint64_t sequence,
                                double now_s) noexcept {
    GainClamp clamp;
    sequence_ = sequence;
    settled_ = false;
    clock_.receive(touch.state_time_s, now_s);
    asked_ = touch.stiffness;
    asked_damping_n_s_m_ = touch.damping_n_s_m;
    const ProxySettings wanted_before = wanted_settings_;
    tune(clamp);
    if (empty()) {
        use_wanted_springs(); // nobody feels the change
    } else if (wanted_settings_ != wanted_before) {
        springs_left_s_ = kFeelFade_s;
    }
    tool_ = touch.tool;
    for (int t = 0; t < tool_.count; ++t) {
        const auto k = static_cast<std::size_t>(t);
        tool_numbers_[k] = tool_.parts[k].shape->number();
    }
    felt_ = touch.felt;
    if (!same(touch.load, load_) || load_age_s_ >= kCrossFade_s) {
        // The same load again, from ticks that share a drawn frame, continues unchanged.
        load_from_ = load_now_;
        load_ = touch.load;
        load_age_s_ = 0.0;
    }
    loaded_ = !same(load_, Wrench()) || !same(load_from_, Wrench());
    const bool stamped = touch.state_time_s >= 0.0 && state_time_s_ >= 0.0;
    proxy_.tie(tool_, clock_.carried_s() + lead_s_ - cycle_s_);
    renew(touch, stamped ? std::max(0.0, touch.state_time_s - state_time_s_) : 0.0, clamp);
    state_time_s_ = touch.state_time_s;
    if (empty()) {
        strength_.set(1.0); // the game continues without contacts: no onset is needed
    }
    return clamp;
}

void TouchRenderer::accept_nothing(std::uint64_t sequence) noexcept {
    sequence_ = sequence;
    settled_ = false;
    drop();
    strength_.set(1.0);
}

void TouchRenderer::drop() noexcept {
    tool_.count = 0;
    tool_.joint_count = 0;
    proxy_.tie(tool_, 0.0);
    tool_.stop_rad = Tool().stop_rad;
    scene_.count = 0;
    load_ = Wrench();
    load_from_ = Wrench();
    load_now_ = Wrench();
    loaded_ = false;
}

bool TouchRenderer::empty() const noexcept {
    return scene_.count == 0 && !loaded_ && tool_.joint_count == 0 &&
           !(tool_.stop_rad < tool_.jaws.closed_rad);
}

void TouchRenderer::renew(const TouchScene &touch, double apart_s, GainClamp &clamp) noexcept {
    const ContactScene old = scene_;
    const std::array<Track, kMaxSceneParts> old_tracks = tracks_;
    scene_.count = touch.scene.count;
    // Extrapolates a moving part from the end of the last cycle by the prediction time of the grip.
    const double later_s = clock_.carried_s() + lead_s_ - cycle_s_;
    for (int s = 0; s < scene_.count; ++s) {
        const auto k = static_cast<std::size_t>(s);
        ScenePart part = touch.scene.parts[k];
        part.friction =
            capped(part.friction, kMaxFriction, GainClamp::Gain::friction, s, false, clamp);
        part.traits.static_friction = capped(part.traits.static_friction, kMaxFriction,
                                             GainClamp::Gain::friction, s, false, clamp);
        // The damping of the tool plus that of the surface.
        part.damping_n_s_m =
            capped(part.damping_n_s_m,
                   std::max(0.0, caps_.damping_n_s_m -
                                     std::min(asked_damping_n_s_m_, caps_.damping_n_s_m)),
                   GainClamp::Gain::damping, s, false, clamp);
        part.velocity_m_s = capped_speed(part.velocity_m_s, s, clamp);
        part.belt_m_s = capped_speed(part.belt_m_s, s, clamp);
        shape_numbers_[k] = part.shape->number();
        const CookedShape *const relief = part.traits.texture.relief;
        relief_numbers_[k] = relief != nullptr ? relief->number() : 0;
        Track track;
        track.velocity_m_s = part.velocity_m_s;
        track.angular_rad_s = part.angular_rad_s;
        track.wanted = feel_of(part);
        if (part.angular_rad_s != Vec3(0.0)) {
            part.at.rotation = rotation_exp(later_s * part.angular_rad_s) * part.at.rotation;
        }
        const auto *const end = old.parts.data() + old.count;
        const auto *const before = std::find_if(
            old.parts.data(), end, [&part](const ScenePart &one) { return one.id == part.id; });
        if (before != end) {
            const Track &was = old_tracks[static_cast<std::size_t>(before - old.parts.data())];
            track.impulse_ns = was.impulse_ns;
            track.angular_impulse_nms = was.angular_impulse_nms;
            track.feel_left_s = track.wanted == was.wanted ? was.feel_left_s : kFeelFade_s;
            set_feel(begin(feel_of(*before), track.wanted, part.stiffness_at_once), part);
            if (apart_s > 0.0) {
                track.seen_acceleration_m_s2 = (track.velocity_m_s - was.velocity_m_s) / apart_s;
                track.acceleration_m_s2 =
                    shared(was.seen_acceleration_m_s2, track.seen_acceleration_m_s2);
            }
            part.at.origin_m +=
                later_s * track.velocity_m_s + 0.5 * later_s * later_s * track.acceleration_m_s2;
            const Vec3 by_m = part.at.origin_m - before->at.origin_m;
            const bool turned = part.at.rotation != before->at.rotation;
            const Vec3 by_rad =
                turned ? rotation_log(part.at.rotation * glm::transpose(before->at.rotation))
                       : Vec3(0.0);
            if (glm::length(by_m) < kJump_m && glm::length(by_rad) < kJump_rad) {
                part.at = before->at;
                track.correction_m = by_m;
                track.correction_rad = by_rad;
            }
        } else {
            part.at.origin_m += later_s * track.velocity_m_s;
        }
        scene_.parts[k] = part;
        tracks_[k] = track;
    }
}

bool TouchRenderer::age(double dt_s) noexcept {
    clock_.advance(dt_s);
    cycle_s_ = dt_s;
    if (empty()) {
        return false; // an empty scene does not expire
    }
    if (strength_.advance(clock_.age_s(), dt_s)) {
        return false;
    }
    drop();
    return true;
}

bool TouchRenderer::carry(double dt_s) noexcept {
    const bool carries = clock_.carries();
    const double left_s = std::clamp(kCrossFade_s - clock_.age_s(), 0.0, dt_s);
    const double corrects = left_s / (kCrossFade_s * dt_s);
    // From the scene's time to the middle of this cycle, plus the time by which the grip is
    // predicted.
    const double middle_s = clock_.carried_s() + lead_s_ - 0.5 * dt_s;
    bool moves = false;
    for (int s = 0; s < scene_.count; ++s) {
        const auto k = static_cast<std::size_t>(s);
        const Track &track = tracks_[k];
        ScenePart &part = scene_.parts[k];
        part.velocity_m_s = corrects * track.correction_m;
        part.angular_rad_s = corrects * track.correction_rad;
        if (carries) {
            part.velocity_m_s += track.velocity_m_s + middle_s * track.acceleration_m_s2;
            part.angular_rad_s += track.angular_rad_s;
        }
        moves = moves || part.velocity_m_s != Vec3(0.0) || part.angular_rad_s != Vec3(0.0);
    }
    return moves;
}

bool TouchRenderer::approach_feel(double dt_s) noexcept {
    bool changes = springs_left_s_ > 0.0;
    if (changes) {
        settings_ = approach(settings_, wanted_settings_, springs_left_s_, dt_s);
        springs_left_s_ = std::max(0.0, springs_left_s_ - dt_s);
        proxy_.configure(settings_);
    }
    for (int s = 0; s < scene_.count; ++s) {
        const auto k = static_cast<std::size_t>(s);
        Track &track = tracks_[k];
        if (track.feel_left_s > 0.0) {
            changes = true;
            set_feel(approach(feel_of(scene_.parts[k]), track.wanted, track.feel_left_s, dt_s),
                     scene_.parts[k]);
            track.feel_left_s = std::max(0.0, track.feel_left_s - dt_s);
        }
    }
    return changes;
}

Wrench TouchRenderer::render(const GripMotion &motion, double dt_s) noexcept {
    lead_s_ = motion.lead_s;
    const ToolPose grip{motion.grip.pose.position_m, motion.grip.frame.rotation,
                        motion.grip.frame.grasp_angle_rad};
    ToolPose device = moved(grip, motion.ahead);
    if (memory_ == nullptr) {
        return {};
    }
    const bool changes = approach_feel(dt_s);
    if (loaded_) {
        load_age_s_ += dt_s;
        const double share = cross_fade(load_age_s_);
        load_now_ = blend(load_from_, load_, share);
        // The load displaces the proxy's target by load / stiffness in each DOF.
        DofLanes gives = lanes(load_now_);
        for (std::size_t dof = 0; dof < gives.size(); ++dof) {
            gives[dof] /= settings_.stiffness[dof];
        }
        device = moved(device, of_lanes<Displacement>(gives));
    }
    const double strength = strength_.value();
    // Joints have springs, motors and slack that move by themselves.
    const bool waits = !carry(dt_s) && !changes && tool_.joint_count == 0 &&
                       same(device, device_) && same(motion.velocity, velocity_) &&
                       strength == rendered_strength_;
    if (settled_ && waits) {
        skipped_ += scene_.count > 0 ? 1 : 0;
        return wrench_;
    }
    const ToolPose before = proxy_.pose();
    const Wrench wrench_before = wrench_;
    proxy_.update(tool_, scene_, device, motion.velocity, dt_s, *memory_);
    DofLanes felt = lanes(proxy_.wrench());
    const DofLanes load = lanes(load_now_);
    for (std::size_t dof = 0; dof < felt.size(); ++dof) {
        const bool is_felt = ((felt_ >> dof) & 1U) != 0;
        felt[dof] = strength * ((is_felt ? felt[dof] : 0.0) + load[dof]);
    }
    wrench_ = of_lanes<Wrench>(felt);
    settled_ = waits && same(before, proxy_.pose()) && same(wrench_before, wrench_);
    device_ = device;
    velocity_ = motion.velocity;
    rendered_strength_ = strength;
    return wrench_;
}

void TouchRenderer::integrate(double scale, double dt_s) noexcept {
    if (!(scale > 0.0)) {
        return;
    }
    const double impulse = scale * dt_s * rendered_strength_;
    for (int s = 0; s < scene_.count; ++s) {
        const auto k = static_cast<std::size_t>(s);
        const PartForce &given = proxy_.given()[k];
        tracks_[k].impulse_ns += impulse * given.force_n;
        tracks_[k].angular_impulse_nms += impulse * given.moment_nm;
    }
}

void TouchRenderer::report(TouchReport &report) const noexcept {
    report.sequence = sequence_;
    const ToolPose &pose = proxy_.pose();
    report.position_m = pose.position_m;
    report.rotation = pose.rotation;
    report.grasp_rad = pose.grasp_rad;
    report.wrench = wrench_;
    report.stop_push_nm = proxy_.stop_push_nm();
    report.stiffness = settings_.stiffness;
    report.queries = proxy_.queries();
    report.passes = proxy_.passes();
    report.skipped = skipped_;
    report.part_count = scene_.count;
    for (int s = 0; s < scene_.count; ++s) {
        const auto k = static_cast<std::size_t>(s);
        const Track &track = tracks_[k];
        report.parts[k] = {scene_.parts[k].id, track.impulse_ns, track.angular_impulse_nms};
    }
    report.point_count = proxy_.contact_count();
    for (int i = 0; i < report.point_count; ++i) {
        const ProxyContact &contact = proxy_.contact(i);
        report.points[static_cast<std::size_t>(i)] = {contact.tool_id,
                                                      contact.scene_id,
                                                      contact.point_m,
                                                      contact.normal,
                                                      contact.push_n * contact.normal +
                                                          contact.friction_n + contact.drawn_n,
                                                      contact.gap_m,
                                                      contact.slip_m_s};
    }
}

bool TouchRenderer::is_sound() const noexcept {
    bool sound = scene_.count >= 0 && scene_.count <= kMaxSceneParts && tool_.count >= 0 &&
                 tool_.count <= kMaxToolParts && tool_.joint_count >= 0 &&
                 tool_.joint_count <= kMaxToolJoints &&
                 are_flags(caps_.from_latency, loaded_, settled_) && clock_.is_sound() &&
                 proxy_.is_sound();
    for (std::size_t k = 0; k < scene_.parts.size(); ++k) {
        const ScenePart &part = scene_.parts[k];
        sound = sound && are_flags(part.traits.catches_again, part.stiffness_at_once,
                                   tracks_[k].wanted.traits.catches_again);
    }
    for (const ToolPart &part : tool_.parts) {
        sound = sound && is_one_of(part.mount, ToolMount::jaw_plus);
    }
    return sound;
}

} // namespace spidar
