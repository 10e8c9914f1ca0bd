// Every part with state takes its share in what "at rest" means: each is taken out of rest, the step is then not skipped,
// and all the while its bits are those of a step that skips nothing.
#include <doctest/doctest.h>

#include <functional>
#include <memory>

#include "core/presets/presets.h"
#include "support/step_twin.h"
#include "support/touch_scenes.h"

using namespace spidar;
using spidar::test::Bench;
using spidar::test::kTick_s;

namespace {

// Until all that evolves in time has settled (the usual parity error and the change term take longest).
constexpr int kSettle = 6000;

void put_at(Bench &bench, const Vec3 &position_m, double grasp_angle_rad = 0.0) {
    bench.put(test::moved_by(bench.settings, position_m, grasp_angle_rad));
}

void touch(Bench &bench, bool on) {
    bench.command.contact_count = on ? 1 : 0;
    bench.command.contacts[0].offset_m = 0.002;
    ++bench.command.contacts_sequence;
}

void touch_shapes(Bench &bench, bool on) {
    static const TouchScene nothing;
    static const test::FloorScene floor;
    bench.command.touch = on ? &floor.touch : &nothing;
    ++bench.command.touch_sequence;
}

void couple(Bench &bench, bool on) {
    bench.command.coupling.dof_mask = on ? kAllDof : 0;
    bench.command.coupling.position_m = Vec3(0.003, 0.0, 0.0);
    ++bench.command.coupling_sequence;
}

void buzz(Bench &bench) {
    Effect &effect = bench.command.effects[0];
    effect.kind = EffectKind::constant;
    effect.dof_mask = kAllDof;
    effect.gain = {0.2, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0};
    effect.duration_s = 0.05;
    ++effect.renewal;
    bench.command.effect_count = 1;
    ++bench.command.effects_sequence;
}

// What was seen awake, part by part, in all runs.
struct Seen {
    ServoStep::Awake parts;
    int cycles = 0;
    int skipped = 0;

    // One cycle. A step with a part awake is computed whole.
    void tick(test::StepTwin &twin, Bench &bench) {
        const ServoStep::Awake awake = bench.step.awake_parts();
        const bool any = (awake.step | awake.renderer | awake.monitor) != 0;
        const test::StepTwin::Skipped now = twin.tick(bench);
        CHECK_FALSE((any && now.steps != 0));
        parts.step |= awake.step;
        parts.renderer |= awake.renderer;
        parts.monitor |= awake.monitor;
        ++cycles;
        skipped += now.steps != 0 ? 1 : 0;
    }
    void ticks(test::StepTwin &twin, Bench &bench, int count) {
        for (int i = 0; i < count; ++i) {
            CAPTURE(i);
            tick(twin, bench);
        }
    }
};

constexpr std::uint32_t all_of(int parts) {
    return (1U << parts) - 1U;
}

} // namespace

TEST_CASE("rest: each part that evolves is seen awake, and then nothing is skipped") {
    Seen seen;
    test::StepTwin twin;
    Bench resting;
    resting.settings.safety.arming_time_s = 0.05;
    resting.start();
    resting.activate();
    resting.ask({Vec3(0.0, 1.0, 0.0), Vec3(0.0), 0.0}, kMaxWrenchDuration_s);
    resting.tick(kSettle);
    const ServoStep::Awake at_rest = resting.step.awake_parts();
    REQUIRE((at_rest.step | at_rest.renderer | at_rest.monitor) == 0);

    // Each from rest; what it does may go on over several cycles.
    using Disturb = std::function<void(Bench &, int)>;
    const Disturb disturbances[] = {
        [](Bench &bench, int i) {
            put_at(bench, {0.0, i < 200 ? 2e-5 * i : 0.004, 0.0});
        },
        [](Bench &bench, int i) {
            put_at(bench, {0.0, i < 15 ? 0.0017 * i : 0.0255, 0.0});
        }, // fast
        [](Bench &bench, int i) { put_at(bench, Vec3(0.0), std::min(0.5, 0.002 * i)); },
        [](Bench &bench, int i) { bench.reading.counts[2] += i == 0   ? 4000
                                                             : i == 1 ? -4000
                                                                      : 0; },
        [](Bench &bench, int i) { bench.read_status = i < 12 ? Status::read_timeout : Status::ok; },
        [](Bench &bench, int i) {
            if (i == 0 || i == 100) {
                touch(bench, i == 0);
            }
        },
        [](Bench &bench, int i) {
            if (i == 0 || i == 100) {
                touch_shapes(bench, i == 0);
            }
        },
        [](Bench &bench, int i) {
            if (i < 200 && i % 20 == 0) {
                couple(bench, true);
                put_at(bench, {1e-4 * i, 0.0, 0.0});
            } else if (i == 200) {
                couple(bench, false);
            }
        },
        [](Bench &bench, int i) {
            if (i == 0) {
                buzz(bench);
            }
        },
        [](Bench &bench, int i) {
            if (i == 0) {
                bench.ask({Vec3(0.5, 0.0, 0.0), Vec3(0.0), 0.0}, 0.02);
            }
        },
        [](Bench &bench, int i) { bench.command.disarm_count += i == 0 ? 1 : 0; },
    };
    for (const Disturb &disturb : disturbances) {
        const auto bench = std::make_unique<Bench>(resting);
        for (int i = 0; i < 1500; ++i) {
            CAPTURE(&disturb - disturbances);
            CAPTURE(i);
            disturb(*bench, i);
            seen.tick(twin, *bench);
        }
    }

    Bench warm;
    warm.settings.safety.arming_time_s = 0.05;
    warm.settings.safety.continuous_tension_n = 0.55;
    warm.settings.safety.thermal_time_s = 1.0;
    warm.start();
    warm.activate();
    seen.ticks(twin, warm, 3000);

    // The fingers of a rigid grip.
    Bench rigid;
    const DevicePreset preset = device_preset(Preset::spidar_g6_x5r);
    rigid.settings.frame = preset.frame;
    rigid.settings.grip = preset.grip;
    rigid.settings.strings =
        calibrate_at_home(string_lengths(preset.frame, preset.grip, rest_pose(preset.grip)),
                          CountArray{}, preset.metres_per_count);
    rigid.start();
    seen.ticks(twin, rigid, 50);
    rigid.reading.buttons = 1;
    seen.ticks(twin, rigid, 2000);
    CHECK(rigid.now().grip.frame.grasp_angle_rad == rigid.settings.fingers.closed_rad);

    // A real device takes its zero, and checks it as it is moved.
    Bench real;
    real.simulated = false;
    real.reading.zeroed = false;
    real.start();
    real.command.forces_enabled = true;
    real.tick(5);
    ++real.command.zero_count;
    seen.ticks(twin, real, 800);
    CHECK(real.now().state == DeviceState::taut);

    CHECK(seen.skipped > 100);
    CHECK(seen.parts.step == all_of(11));
    CHECK(seen.parts.renderer == all_of(8));
    CHECK(seen.parts.monitor == all_of(6));
}

TEST_CASE("rest: a hand's last move grows older while steps are skipped") {
    // A real device arms only when the grip moved lately; it lies still here for much longer than that.
    Bench bench;
    bench.simulated = false;
    bench.settings.safety.hand_presence_s = 2.0;
    bench.start();
    const auto arms = [](Bench lying) {
        lying.command.forces_enabled = true;
        ++lying.command.arm_count;
        lying.tick(2);
        return lying.now().state == DeviceState::arming;
    };
    put_at(bench, {0.0, 0.01, 0.0});
    bench.tick(2);
    put_at(bench, Vec3(0.0));
    bench.tick(100);
    CHECK(arms(bench));
    bench.tick(kSettle);
    const std::uint64_t skipped = bench.now().counters.steps_skipped;
    CHECK(skipped > static_cast<std::uint64_t>(kSettle) / 2);
    CHECK_FALSE(arms(bench));
}
