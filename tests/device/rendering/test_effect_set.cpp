#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include <glm/geometric.hpp>

#include "device/rendering/effect_set.h"

using namespace spidar;

namespace {

constexpr double kTick_s = 0.001;

struct Rig {
    EffectSet set;
    HapticCommand command;
    GripMotion motion;

    Rig() {
        set.configure(ServoSettings());
        motion.grip.pose = rest_pose(GripGeometry());
        motion.grip.frame = frame_of(motion.grip.pose, Mat3(1.0));
    }
    GainClamp give(std::initializer_list<Effect> effects) {
        command.effect_count = static_cast<int>(effects.size());
        std::copy(effects.begin(), effects.end(), command.effects.begin());
        return set.accept(command);
    }
    Wrench play(int ticks) {
        Wrench wrench;
        for (int i = 0; i < ticks; ++i) {
            set.age(kTick_s);
            wrench = set.render(motion);
        }
        return wrench;
    }
};

Effect effect_of(EffectKind kind, double gain) {
    Effect effect;
    effect.kind = kind;
    effect.dof_mask = kAllDof;
    effect.gain.values.fill(gain);
    effect.duration_s = 1.0;
    effect.frequency_hz = 50.0;
    effect.spacing.values.fill(0.01);
    return effect;
}

constexpr int kFaded = 20; // ticks: past one game period

} // namespace

TEST_CASE("effects: viscous field resists motion, in the DOF of its mask") {
    Rig rig;
    Effect field = effect_of(EffectKind::viscous, 0.002);
    field.gain[0] = 3.0;
    field.dof_mask = 0b1000001;
    rig.give({field});
    rig.motion.velocity.linear_m_s = Vec3(0.2, 0.3, 0.0);
    rig.motion.velocity.grasp_rate_rad_s = -2.0;
    const Wrench w = rig.play(kFaded);
    CHECK(w.force_n.x == doctest::Approx(-0.6));
    CHECK(w.force_n.y == 0.0);
    CHECK(w.grasp_torque_nm == doctest::Approx(0.004));
}

TEST_CASE("effects: constant force, spring to a point, and their sum") {
    Rig rig;
    Effect force = effect_of(EffectKind::constant, 0.0);
    force.gain[1] = -1.5;
    Effect spring = effect_of(EffectKind::spring, 0.0);
    spring.gain[1] = 100.0;
    spring.gain[5] = 0.3;
    spring.centre_m = Vec3(0.0, 0.01, 0.0);
    rig.give({force, spring});
    const Wrench w = rig.play(kFaded);
    CHECK(w.force_n.y == doctest::Approx(-1.5 + 1.0));
    CHECK(glm::length(w.moment_nm) < 1e-12);
    rig.motion.ahead.angular_rad.z = 0.1;
    CHECK(rig.play(1).moment_nm.z == doctest::Approx(-0.03));
}

TEST_CASE("effects: a vibration swings at its frequency and never beyond the bound") {
    Rig rig;
    Effect buzz = effect_of(EffectKind::vibration, 0.0);
    buzz.gain[0] = 50.0;      // far too much
    buzz.frequency_hz = 47.0; // never exactly zero in a cycle
    const GainClamp clamp = rig.give({buzz});
    CHECK(clamp.gain == GainClamp::Gain::force);
    CHECK(clamp.request == GainClamp::Request::effect);
    rig.play(kFaded);
    int crossings = 0;
    double most_n = 0.0;
    double last_n = 0.0;
    for (int i = 0; i < 400; ++i) {
        const double force_n = rig.play(1).force_n.x;
        crossings += force_n * last_n < 0.0 ? 1 : 0;
        most_n = std::max(most_n, std::abs(force_n));
        last_n = force_n;
    }
    CHECK(crossings == doctest::Approx(2 * 47 * 0.4).epsilon(0.06));
    CHECK(most_n <= kMaxVibration_n);
    CHECK(most_n > 0.95 * kMaxVibration_n);
}

TEST_CASE("effects: detents pull to the nearest valley and store no energy over a period") {
    Rig rig;
    Effect detents = effect_of(EffectKind::detents, 0.0);
    detents.gain[2] = 0.5;
    rig.give({detents});
    rig.play(kFaded);
    double work_j = 0.0;
    double passed_j = 0.0;
    double most_n = 0.0;
    constexpr int kSteps = 200;
    for (int i = 0; i < kSteps; ++i) {
        const double z = 0.01 * (i + 0.5) / kSteps;
        rig.motion.grip.pose.position_m.z = z;
        const double force_n = rig.set.render(rig.motion).force_n.z;
        CHECK((z < 0.005 ? force_n <= 0.0 : force_n >= 0.0)); // back down, or on to the next
        work_j += force_n * 0.01 / kSteps;
        passed_j += std::abs(force_n) * 0.01 / kSteps;
        most_n = std::max(most_n, std::abs(force_n));
    }
    CHECK(most_n == doctest::Approx(0.5).epsilon(1e-3));
    CHECK(std::abs(work_j) < 1e-9 * passed_j + 1e-15);
}

TEST_CASE("effects: begin, change and end over one game period; the same id carries on") {
    Rig rig;
    Effect force = effect_of(EffectKind::constant, 0.0);
    force.gain[0] = 1.6;
    double last_n = 0.0;
    const auto smooth = [&](double wanted_n) {
        for (int i = 0; i < kFaded; ++i) {
            const double now_n = rig.play(1).force_n.x;
            CHECK(std::abs(now_n - last_n) <= 3.2 / 16.0 + 1e-9);
            last_n = now_n;
        }
        CHECK(last_n == doctest::Approx(wanted_n));
    };
    rig.give({force});
    smooth(1.6);
    force.gain[0] = -1.6;
    force.renewal = 1;
    rig.give({force});
    smooth(-1.6);
    rig.give({});
    smooth(0.0);
    CHECK(rig.set.at_rest());
}

TEST_CASE("effects: last as long as asked, then fade; the end is counted once") {
    Rig rig;
    Effect force = effect_of(EffectKind::constant, 1.0);
    force.duration_s = 0.1;
    rig.give({force});
    int ended = 0;
    for (int ms = 1; ms <= 200; ++ms) {
        ended += rig.set.age(kTick_s);
        const double force_n = rig.set.render(rig.motion).force_n.x;
        if (ms > kFaded) {
            const double left = ms <= 100 ? 1.0 : ms >= 150 ? 0.0 : (150 - ms) / 50.0;
            CHECK(force_n == doctest::Approx(left));
        }
    }
    CHECK(ended == 1);
    CHECK(rig.set.at_rest());
    // Sent again with others it stays over; renewed it begins again.
    rig.give({force});
    CHECK(rig.play(kFaded).force_n.x == 0.0);
    force.renewal = 1;
    rig.give({force});
    CHECK(rig.play(kFaded).force_n.x == doctest::Approx(1.0));
}

TEST_CASE("effects: every valid set gives a finite wrench; what would drive the hand is refused") {
    std::mt19937_64 random(11);
    const double sizes[] = {0.0, 1e-310, 1e-3, 0.1, 1.0, 1e6, 1e300};
    const auto odd = [&] { return (random() % 2 == 0 ? 1.0 : -1.0) * sizes[random() % 7]; };
    Rig rig;
    int valid = 0;
    for (int round = 0; round < 20000; ++round) {
        rig.command.effect_count = static_cast<int>(random() % (kMaxEffects + 1));
        for (Effect &effect : rig.command.effects) {
            effect.kind = static_cast<EffectKind>(random() % kEffectKindCount);
            effect.dof_mask = static_cast<std::uint8_t>(random() % 128);
            effect.id = static_cast<std::int32_t>(random() % 3);
            effect.renewal = static_cast<std::uint32_t>(random() % 2);
            for (std::size_t i = 0; i < effect.gain.size(); ++i) {
                effect.gain[i] = odd();
                effect.spacing[i] = std::abs(odd());
            }
            effect.centre_m = Vec3(odd(), odd(), odd());
            effect.centre_grasp_rad = odd();
            effect.frequency_hz = std::abs(odd()) * 10.0;
            effect.duration_s = std::min(std::abs(odd()), 60.0);
        }
        if (usable(validate_effects(rig.command))) {
            ++valid;
            rig.set.accept(rig.command);
        }
        rig.motion.velocity.linear_m_s = Vec3(1.0, -1.0, 0.5);
        for (const double value : to_paper(rig.play(1))) {
            REQUIRE(std::isfinite(value));
        }
    }
    CHECK(valid > 2000);
    Effect pusher = effect_of(EffectKind::viscous, -1.0);
    CHECK(validate_effect(pusher) == Status::invalid_request);
    pusher.kind = EffectKind::spring;
    CHECK(validate_effect(pusher) == Status::invalid_request);
    pusher.kind = EffectKind::constant;
    CHECK(validate_effect(pusher) == Status::ok);
    pusher.gain[2] = std::nan("");
    CHECK(validate_effect(pusher) == Status::not_finite);
}
