// What may reach a servo step, from play to madness: motion of a hand, encoders and links that fail, games that ask for
// nonsense. One sequence of steps is a whole number of a seed and replays alone; cheap enough for 10^9 steps.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include <glm/geometric.hpp>

#include "core/presets/presets.h"
#include "device/contract/servo_snapshot.h"
#include "device/contract/transport.h"
#include "device/settings/servo_settings.h"
#include "support/case_random.h"

namespace spidar::test {

class ServoStepInput {
public:
    // Everything that a request asked for has ended by this time after the last one (unit: s).
    static constexpr double kLongestRequest_s = 0.4;

    ServoStepInput(std::uint64_t seed, std::uint64_t sequence) : dice_(seed, sequence) {
        choose_settings();
        for (Oscillator &part : parts_) {
            const double turn = dice_.between(0.5e-3, 6e-3);
            part.turn = {std::cos(turn), std::sin(turn)};
            const double start = dice_.between(-3.0, 3.0);
            part.now = {std::cos(start), std::sin(start)};
        }
        const Vec3 room = 0.4 * box_half_extents(settings.frame).value_or(Vec3(0.15));
        reach_ = {room.x, room.y, room.z, 0.25, 0.25, 0.2, 0.6};
        sends_heartbeat_ = dice_.below(2) == 0;
        numbers_reports_ = dice_.below(2) == 0;
        command.heartbeat = sends_heartbeat_ ? 1 : 0;
        command.forces_enabled = true;
        choose_stretch();
    }

    // One cycle's input, given what the last one led to.
    void next(const ServoSnapshot &last) {
        if (--steps_left_ <= 0) {
            choose_stretch();
        }
        dt_s = 1.0 / settings.rate_hz;
        if (odd_clock_) {
            dt_s *= dice_.below(64) == 0 ? dice_.nasty() : dice_.between(0.2, 3.0);
        }
        move();
        read();
        ++steps_;
        if (!silent_ && (hammering_ || steps_ % kGameSteps == 0)) {
            play(last);
        }
    }

    ServoSettings settings;
    Status read_status = Status::ok;
    DeviceReading reading;
    HapticCommand command;
    double dt_s = 1e-3;
    bool simulated = true;

private:
    struct Oscillator {
        std::array<double, 2> now{1.0, 0.0};
        std::array<double, 2> turn{1.0, 0.0};
        void advance() {
            const auto [c, s] = now;
            now = {c * turn[0] - s * turn[1], s * turn[0] + c * turn[1]};
        }
    };
    static constexpr int kGameSteps = 16;

    bool one_in(std::size_t n) { return dice_.below(n) == 0; }
    double odd(double size, std::size_t rarely) {
        return one_in(rarely) ? dice_.nasty() : dice_.between(-size, size);
    }
    Vec3 odd_vector(double size, std::size_t rarely) {
        return {odd(size, rarely), odd(size, rarely), odd(size, rarely)};
    }

    void choose_settings() {
        const std::size_t device = dice_.below(10);
        if (device == 0) {
            const DevicePreset preset = device_preset(Preset::spidar_g6_x3r);
            settings.frame = preset.frame;
            settings.grip = preset.grip;
        } else if (device == 1) {
            settings.frame = make_box_frame(
                {dice_.between(0.2, 0.4), dice_.between(0.2, 0.4), dice_.between(0.2, 0.4)});
            settings.grip.pole_half_length_m = dice_.between(0.03, 0.06);
        } else if (device == 2 && one_in(4)) { // slow: each step solves the general way
            settings.frame.pulley_radius_m = dice_.between(0.001, 0.01);
        }
        settings.rate_hz = one_in(8) ? dice_.between(300.0, 4000.0) : 1000.0;
        settings.strings = calibrate_at_home(
            string_lengths(settings.frame, settings.grip, rest_pose(settings.grip)), {}, 2.5e-5);
        for (std::size_t i = 0; i < kStringCount; ++i) {
            settings.strings.scale_m_per_count[i] *= one_in(4) ? -1.0 : 1.0;
            settings.strings.zero_count[i] = one_in(8) ? std::numeric_limits<std::int32_t>::max()
                                                       : static_cast<std::int32_t>(dice_.below(9));
        }
        if (one_in(4)) {
            settings.corrections.axial_stiffness_n.fill(dice_.between(3e3, 2e4));
            settings.corrections.winding_curvature_1_m.fill(dice_.between(-0.05, 0.05));
        }
        SafetySettings &safety = settings.safety;
        safety.arming_time_s = dice_.between(0.01, 0.2);
        safety.tension_slew_n_per_ms = one_in(4) ? dice_.spread(0.01, 100.0) : 1.0;
        safety.hand_presence_s = one_in(2) ? 0.0 : 5.0;
        safety.continuous_tension_n = one_in(4) ? dice_.between(0.5, 3.5) : 3.5;
        safety.thermal_time_s = one_in(4) ? dice_.between(0.1, 2.0) : 12.0;
        safety.game_timeout_s = dice_.between(0.05, 0.5);
        safety.max_force_n = one_in(4) ? dice_.between(0.0, 50.0) : 8.0;
        TensionSettings &tension = settings.tension;
        constexpr std::uint8_t kMasks[] = {kTranslationOnly, kNoGrasp, 0x40, 0x38};
        const bool rigid = settings.grip.kind == GripKind::rigid; // has no grasp to keep
        tension.dof_mask = one_in(4) ? kMasks[dice_.below(4)] : kAllDofs;
        tension.dof_mask |= rigid ? kTranslationOnly : 0;
        tension.broken_mask = 0;
        if (one_in(16)) {
            tension.broken_mask = static_cast<std::uint8_t>(1U << dice_.below(kStringCount));
        }
        tension.change_weight = one_in(4) ? 0.0 : 0.2;
        tension.max_tension_n = one_in(4) ? dice_.between(2.0, 20.0) : 10.0;
        RenderSettings &render = settings.render;
        render.compensated_mass_kg = one_in(4) ? dice_.between(0.0, 0.1) : 0.0;
        render.compensated_friction_n = one_in(4) ? dice_.between(0.0, 0.1) : 0.0;
        render.compensated_viscous_n_s_m = one_in(4) ? dice_.between(0.0, 0.1) : 0.0;
        render.passivity_share = one_in(4) ? 0.0 : 2.0;
        render.string_resonance_hz = one_in(4) ? 0.0 : 112.0;
        simulated = !one_in(4);
    }

    void choose_stretch() {
        steps_left_ = 16 + static_cast<int>(dice_.below(400));
        speed_ = 0;
        flicker_ = 0;
        stuck_ = -1;
        any_counts_ = false;
        slip_ = one_in(4) ? slip_ : CountArray{};
        const std::size_t motion = dice_.below(200);
        if (motion >= 30) {
            speed_ = motion < 140 ? 1 : motion < 185 ? 2 : 1;
        }
        if (motion >= 185 && motion < 188) {
            speed_ = 8; // faster than the grip may move
        } else if (motion < 190) {
            flicker_ = 1;
        } else if (motion < 193) {
            stuck_ = static_cast<int>(dice_.below(kStringCount));
        } else if (motion < 196) {
            slip_[dice_.below(kStringCount)] += static_cast<std::int32_t>(dice_.below(801)) - 400;
        } else if (motion == 196) {
            slip_ = {};
            flicker_ = 1U + static_cast<std::uint32_t>(dice_.below(200));
        } else if (motion == 197) {
            any_counts_ = true;
            steps_left_ = 8;
        } else {
            slip_ = {};
        }
        silent_ = one_in(64);
        if (silent_ && one_in(2)) { // all comes to rest
            steps_left_ += 3000;
            speed_ = 0;
            flicker_ = 0;
        }
        hammering_ = !silent_ && one_in(16);
        bad_link_ = one_in(32);
        odd_clock_ = one_in(32);
    }

    void move() {
        for (Oscillator &part : parts_) {
            for (int i = 0; i < speed_; ++i) {
                part.advance();
            }
        }
        std::array<double, 7> at{};
        for (std::size_t i = 0; i < at.size(); ++i) {
            at[i] = reach_[i] * parts_[i].now[1];
        }
        // Cayley: a rotation without a sine.
        const Vec3 a(at[3], at[4], at[5]);
        const double scale = 1.0 / (1.0 + glm::dot(a, a));
        const Mat3 cross(0.0, a.z, -a.y, -a.z, 0.0, a.x, a.y, -a.x, 0.0);
        const Mat3 turn = Mat3(1.0) + 2.0 * scale * (cross + cross * cross);
        const double grasp = settings.grip.kind == GripKind::rigid ? 0.0 : at[6];
        const GripPose pose = make_pose(settings.grip, Vec3(at[0], at[1], at[2]), turn, grasp);
        const StringArray lengths_m = string_lengths(settings.frame, settings.grip, pose);
        for (std::size_t i = 0; i < kStringCount; ++i) {
            if (static_cast<int>(i) == stuck_) {
                continue;
            }
            const StringCalibration &strings = settings.strings;
            const double away_m = lengths_m[i] - strings.offset_m[i];
            auto count =
                static_cast<std::uint32_t>(std::lround(away_m / strings.scale_m_per_count[i]));
            count += static_cast<std::uint32_t>(strings.zero_count[i]);
            count += static_cast<std::uint32_t>(slip_[i]);
            if (flicker_ > 0) {
                count += static_cast<std::uint32_t>(dice_.below(2 * flicker_ + 1)) - flicker_;
            }
            if (any_counts_) {
                count = static_cast<std::uint32_t>(dice_.bits());
            }
            reading.counts[i] = static_cast<std::int32_t>(count);
        }
    }

    void read() {
        read_status = Status::ok;
        reading.device_time_us += static_cast<std::uint64_t>(1e6 / settings.rate_hz);
        reading.sequence =
            static_cast<std::uint16_t>(reading.sequence + (numbers_reports_ ? 1 : 0));
        reading.device_status = Status::ok;
        reading.zeroed = true;
        if (!bad_link_) {
            return;
        }
        if (one_in(4)) {
            read_status = Status::read_timeout;
        }
        switch (dice_.below(600)) {
        case 0:
            read_status = Status::read_failed;
            break;
        case 1:
            reading.device_time_us = dice_.bits() >> dice_.below(64);
            break;
        case 2:
            reading.sequence = static_cast<std::uint16_t>(dice_.bits());
            break;
        case 3:
            reading.zeroed = false;
            break;
        case 4:
            reading.device_status = Status::device_emergency_stop;
            break;
        default:
            break;
        }
    }

    ContactPlane contact(const ServoSnapshot &last) {
        ContactPlane plane;
        plane.target = static_cast<ContactTarget>(dice_.below(one_in(64) ? 256 : 7));
        const Vec3 way = dice_.vector(1.0) + Vec3(1e-9);
        plane.normal = one_in(64) ? odd_vector(1.0, 2) : way / glm::length(way);
        double near = glm::dot(plane.normal, last.grip.pose.position_m);
        if (plane.target == ContactTarget::grasp_stop) {
            plane.normal = Vec3(one_in(2) ? 1.0 : -1.0, 0.0, 0.0);
            near = plane.normal.x * last.grip.frame.grasp_angle_rad;
        } else if (plane.target == ContactTarget::turn_stop) {
            near = 0.0;
        }
        plane.offset_m = one_in(64) ? odd(1.0, 2) : near + dice_.between(-0.02, 0.02);
        plane.velocity_m_s = one_in(8) ? odd_vector(1.0, 32) : Vec3(0.0);
        plane.stiffness_n_m = one_in(64) ? odd(1e4, 4) : dice_.between(0.0, 2000.0);
        plane.damping_n_s_m = one_in(64) ? odd(1e2, 4) : dice_.between(0.0, 5.0);
        plane.friction = one_in(64) ? odd(1e2, 4) : dice_.between(0.0, 1.0);
        plane.id = static_cast<std::int32_t>(dice_.below(10));
        return plane;
    }

    void ask_contacts(const ServoSnapshot &last) {
        command.contact_count = static_cast<int>(dice_.below(kMaxContacts + 1));
        for (std::size_t i = 0; i < static_cast<std::size_t>(command.contact_count); ++i) {
            ContactPlane &plane = command.contacts[i];
            plane = contact(last);
            if (i > 0 && one_in(4)) { // the same again, or its very opposite
                const ContactPlane &twin = command.contacts[i - 1];
                plane = twin;
                if (one_in(2) && twin.target != ContactTarget::grasp_stop) {
                    plane.normal = -twin.normal;
                    plane.offset_m = dice_.between(0.0, 0.01) - twin.offset_m;
                }
            }
        }
        command.contact_count =
            one_in(256) ? static_cast<int>(dice_.bits()) : command.contact_count;
        command.contacts_state_time_s = one_in(2) ? last.time_s : odd(1.0, 4);
        ++command.contacts_sequence;
    }

    void ask_coupling(const ServoSnapshot &last) {
        Coupling &coupling = command.coupling;
        coupling.position_m = last.grip.pose.position_m + odd_vector(0.01, 256);
        coupling.rotation = last.grip.frame.rotation * dice_.rotation(0.2);
        coupling.grasp_angle_rad = odd(0.5, 256);
        coupling.twist = {odd_vector(0.3, 256), odd_vector(2.0, 256), odd(1.0, 256)};
        for (std::size_t i = 0; i < kDofCount; ++i) {
            coupling.stiffness[i] = one_in(256) ? dice_.nasty() : dice_.between(0.0, 400.0);
            coupling.damping[i] = one_in(256) ? dice_.nasty() : dice_.between(0.0, 3.0);
        }
        coupling.state_time_s = one_in(2) ? last.time_s : odd(1.0, 4);
        coupling.dof_mask = static_cast<std::uint8_t>(one_in(3) ? 0 : dice_.below(128));
        ++command.coupling_sequence;
    }

    void ask_effects() {
        command.effect_count = static_cast<int>(dice_.below(kMaxEffects + 1));
        for (Effect &effect : command.effects) {
            effect.kind = static_cast<EffectKind>(dice_.below(one_in(64) ? 256 : 5));
            effect.dof_mask = static_cast<std::uint8_t>(dice_.below(128));
            effect.id = static_cast<std::int32_t>(dice_.below(4));
            for (std::size_t i = 0; i < kDofCount; ++i) {
                effect.gain[i] =
                    one_in(256) ? dice_.nasty() : dice_.between(0.0, i < 3 ? 3.0 : 0.1);
                effect.spacing[i] = dice_.between(0.002, 0.2);
            }
            effect.centre_m = odd_vector(0.1, 256);
            effect.frequency_hz = dice_.between(kMinVibration_hz, kMaxVibration_hz);
            effect.duration_s = dice_.between(0.0, 0.5 * kLongestRequest_s);
            ++effect.renewal;
        }
        command.effect_count = one_in(256) ? static_cast<int>(dice_.bits()) : command.effect_count;
        ++command.effects_sequence;
    }

    // A frame of the game.
    void play(const ServoSnapshot &last) {
        command.heartbeat += sends_heartbeat_ ? 1U : 0U;
        if (one_in(2)) {
            const double size = one_in(16) ? 100.0 : 1.0;
            command.wrench = {odd_vector(4.0 * size, 64), odd_vector(0.2 * size, 64),
                              odd(0.1 * size, 64)};
            command.wrench_duration_s =
                one_in(64) ? -dice_.between(0.0, 1.0) : dice_.between(0.0, 0.5 * kLongestRequest_s);
            ++command.wrench_sequence;
        }
        if (one_in(3)) {
            ask_contacts(last);
        }
        if (one_in(16)) {
            ask_coupling(last);
        }
        if (one_in(16)) {
            ask_effects();
        }
        const bool stopped = last.state == DeviceState::fault || last.state == DeviceState::closed;
        command.clear_fault_count += one_in(stopped ? 3 : 300) ? 1U : 0U;
        command.arm_count += one_in(4) ? 1U : 0U;
        command.disarm_count += one_in(400) ? 1U : 0U;
        command.zero_count += one_in(2000) ? 1U : 0U;
        if (one_in(2000)) {
            ++command.stop_count;
            command.stop_reason = Status::panic_stopped;
        }
        command.forces_enabled = command.forces_enabled ? !one_in(400) : one_in(4);
    }

    CaseRandom dice_;
    std::array<Oscillator, 7> parts_{};
    std::array<double, 7> reach_{};
    CountArray slip_{};
    long steps_ = 0;
    int steps_left_ = 0;
    int speed_ = 1;
    std::uint32_t flicker_ = 0;
    int stuck_ = -1;
    bool any_counts_ = false;
    bool silent_ = false;
    bool hammering_ = false;
    bool bad_link_ = false;
    bool odd_clock_ = false;
    bool sends_heartbeat_ = false;
    bool numbers_reports_ = false;
};

} // namespace spidar::test
