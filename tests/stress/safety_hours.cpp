// safety_hours [--minutes M] [--cycles N] [--commands N] [--stall_minutes S] [--seed S], in stepped time:
//   M minutes of ordinary motion with contacts and taps, with each hand: no monitor may raise an alarm;
//   N cycles of arm, disarm, unplug and replug; N random commands, half of them absurd; a game that stalls for S
//   minutes. Prints the worst case; exit code 1 when an invariant broke.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <memory>
#include <random>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "device/loop/servo_loop.h"
#include "device/simulation/simulated_transport.h"

using namespace spidar;

namespace {

constexpr double kTick_s = 1e-3;
constexpr int kFrame_ticks = 16;

struct Random {
    std::mt19937_64 engine;
    bool one_in(unsigned n) { return engine() % n == 0; }
    double within(double size) {
        return std::uniform_real_distribution<double>(-size, size)(engine);
    }
    Vec3 vector(double size) { return {within(size), within(size), within(size)}; }
};

struct Game {
    Game(HandFirmness hand, std::uint64_t seed) : random{std::mt19937_64(seed)} {
        PlantSettings plant;
        plant.firmness = hand;
        auto made = std::make_unique<SimulatedTransport>(plant);
        device = made.get();
        settings.safety.arming_time_s = 0.05;
        settings.strings = calibrate_at_home(
            string_lengths(settings.frame, settings.grip, rest_pose(settings.grip)),
            made->home_counts(), kPaperMetresPerCount);
        loop = std::make_unique<ServoLoop>(std::move(made));
        usable_ = usable(loop->start_stepped(settings));
        command.forces_enabled = true;
        command.heartbeat = 1;
    }
    void run(int ticks) {
        loop->advance(static_cast<std::uint32_t>(ticks), 1000);
        (void)loop->latest(now);
        worst_n =
            std::max(worst_n, *std::max_element(now.tensions_n.begin(), now.tensions_n.end()));
    }
    void publish() {
        ++command.heartbeat;
        loop->publish(command);
    }

    Random random;
    SimulatedTransport *device = nullptr;
    ServoSettings settings;
    std::unique_ptr<ServoLoop> loop;
    HapticCommand command;
    ServoSnapshot now;
    double worst_n = 0.0;
    bool usable_ = false;
};

// What a player does: goes places, turns, grasps, taps at surfaces, holds things of some weight.
void play(Game &game, long frame) {
    HapticCommand &command = game.command;
    const double t = static_cast<double>(frame * kFrame_ticks) * kTick_s;
    // Up to 0.5 m/s, each axis at a rate of its own, so that an hour repeats nothing.
    HandTarget target;
    target.position_m = {0.075 * std::sin(3.1 * t), 0.07 * std::sin(4.7 * t + 1.0),
                         0.06 * std::sin(2.3 * t + 2.0)};
    const Vec3 turn(0.35 * std::sin(1.9 * t), 0.35 * std::sin(2.9 * t), 0.4 * std::sin(1.3 * t));
    const double angle = glm::length(turn);
    if (angle > 0.0) {
        target.rotation = glm::mat3_cast(glm::angleAxis(angle, turn / angle));
    }
    target.grasp_angle_rad = 0.35 + 0.45 * std::sin(1.7 * t);
    game.device->set_hand_target(target);
    if (frame % 30 == 0) { // what it holds
        command.wrench.force_n = game.random.one_in(3) ? game.random.vector(1.0) : Vec3(0.0);
    }
    ++command.contacts_sequence;
    command.contact_count = 4;
    const Vec3 normals[] = {{0.0, 1.0, 0.0}, {1.0, 0.0, 0.0}, {0.0, 0.0, -1.0}};
    for (int i = 0; i < 3; ++i) {
        ContactPlane &plane = command.contacts[static_cast<std::size_t>(i)];
        plane.normal = normals[i];
        plane.offset_m = -0.05;
        plane.stiffness_n_m = 250.0; // what several DOF in contact together bear
        plane.friction = 0.3;
        plane.id = i + 1;
    }
    ContactPlane &stop = command.contacts[3];
    stop.target = ContactTarget::grasp_stop;
    stop.normal = Vec3(-1.0, 0.0, 0.0);
    stop.offset_m = -0.5;
    stop.stiffness_n_m = 0.25;
    stop.damping_n_s_m = 0.003;
    stop.id = 4;
    ++command.wrench_sequence;
    command.wrench_duration_s = 0.05;
}

// Alarms in ordinary play: anything above info that is not the game's own doing.
long false_alarms(HandFirmness hand, double minutes, std::uint64_t seed) {
    Game game(hand, seed);
    const auto frames = static_cast<long>(minutes * 60.0 / (kFrame_ticks * kTick_s));
    long alarms = 0;
    for (long frame = 0; frame < frames && game.usable_; ++frame) {
        play(game, frame);
        game.publish();
        game.run(kFrame_ticks);
        DeviceEvent event;
        while (game.loop->next_event(event)) {
            const EventDescription &what = describe(event.kind);
            if (what.level == EventLevel::info) {
                continue;
            }
            ++alarms;
            if (alarms <= 10) {
                std::printf("ALARM: %s at %.3f s, string %d, value %g (hand %d, seed %llu)\n",
                            what.name, event.time_s, event.string, event.value,
                            static_cast<int>(hand), static_cast<unsigned long long>(seed));
            }
        }
        if (game.now.state == DeviceState::fault || game.now.state == DeviceState::connected) {
            ++game.command.clear_fault_count; // go on, so that one alarm does not hide the next
            ++game.command.arm_count;
        }
    }
    std::printf("hand %d: %.1f min of play, %ld alarms; warmest motor %.2f, worst tension %.2f N\n",
                static_cast<int>(hand), minutes, alarms, game.now.thermal_share, game.worst_n);
    return alarms + (game.usable_ ? 0 : 1);
}

long broken_cycles(long cycles, std::uint64_t seed) {
    Game game(HandFirmness::normal, seed);
    long broken = 0;
    long active = 0;
    for (long i = 0; i < cycles && game.usable_; ++i) {
        ++game.command.clear_fault_count;
        game.publish();
        game.run(2);
        ++game.command.arm_count;
        game.publish();
        game.run(60 + static_cast<int>(game.random.engine() % 20));
        active += game.now.state == DeviceState::active ? 1 : 0;
        const bool unplug = i % 2 == 0;
        if (unplug) {
            game.device->inject({SimulatedFault::unplugged, 0, 0.0, 0.005});
        } else {
            ++game.command.disarm_count;
        }
        game.publish();
        game.run(unplug ? 2 : 25);
        const bool off = game.now.tensions_n == StringArray{};
        const DeviceState expected = unplug ? DeviceState::closed : DeviceState::connected;
        if (!off || game.now.state != expected) {
            ++broken;
            std::printf("BROKEN: cycle %ld: state %d, motors %s (seed %llu)\n", i,
                        static_cast<int>(game.now.state), off ? "off" : "on",
                        static_cast<unsigned long long>(seed));
        }
        game.run(8); // plugged in again
    }
    std::printf("%ld arm/disarm/unplug/replug cycles, %ld of them active, %ld broken\n", cycles,
                active, broken);
    return broken + (active * 10 >= cycles * 9 ? 0 : 1);
}

double absurd(Random &random, double size) {
    const double odd[] = {std::numeric_limits<double>::quiet_NaN(),
                          std::numeric_limits<double>::infinity(),
                          -std::numeric_limits<double>::infinity(),
                          1e308,
                          -1e308,
                          5e-324,
                          1e30};
    return random.one_in(10) ? odd[random.engine() % 7] : random.within(size);
}

long broken_commands(long commands, std::uint64_t seed) {
    Game game(HandFirmness::light, seed);
    Random &random = game.random;
    long broken = 0;
    for (long i = 0; i < commands && game.usable_; ++i) {
        HapticCommand &command = game.command;
        const bool wild = i % 2 == 0;
        const auto value = [&](double size) {
            return wild ? absurd(random, size) : random.within(size);
        };
        command.wrench = {Vec3(value(10.0), value(10.0), value(10.0)),
                          Vec3(value(1.0), value(1.0), value(1.0)), value(1.0)};
        command.wrench_duration_s = std::abs(value(0.1));
        command.wrench_sequence += random.engine() % 2;
        command.contact_count = static_cast<int>(random.engine() % 11) - 1;
        for (ContactPlane &plane : command.contacts) {
            plane.normal = random.one_in(4)
                               ? Vec3(value(1.0), value(1.0), value(1.0))
                               : glm::normalize(random.vector(1.0) + Vec3(0.0, 1e-6, 0.0));
            plane.offset_m = value(0.1);
            plane.velocity_m_s = Vec3(value(0.3), value(0.3), value(0.3));
            plane.stiffness_n_m = std::abs(value(3000.0));
            plane.damping_n_s_m = std::abs(value(8.0));
            plane.friction = std::abs(value(2.0));
            plane.target = static_cast<ContactTarget>(random.engine() % (wild ? 8 : 6));
            plane.id = static_cast<std::int32_t>(random.engine() % 10);
        }
        ++command.contacts_sequence;
        command.forces_enabled = !random.one_in(200);
        command.arm_count += random.one_in(20) ? 1U : 0U;
        command.clear_fault_count += random.one_in(20) ? 1U : 0U;
        command.zero_count += random.one_in(5000) ? 1U : 0U;
        game.publish();
        game.run(1);
        bool good = game.now.counters.gate_clamps == 0;
        for (const double tension_n : game.now.tensions_n) {
            good = good && tension_n >= 0.0 && tension_n <= game.settings.tension.max_tension_n;
        }
        good = good &&
               glm::length(game.now.requested.force_n) <= game.settings.safety.max_force_n + 1e-9;
        if (!good) {
            ++broken;
            std::printf("BROKEN: command %ld (seed %llu)\n", i,
                        static_cast<unsigned long long>(seed));
        }
    }
    std::printf("%ld commands, %llu refused, %llu limited, %ld broken; worst tension %.2f N\n",
                commands, static_cast<unsigned long long>(game.now.counters.rejected_requests),
                static_cast<unsigned long long>(game.now.counters.clamped_requests), broken,
                game.worst_n);
    return broken + (commands == 0 || game.now.counters.rejected_requests > 0 ? 0 : 1);
}

long broken_stall(double minutes, std::uint64_t seed) {
    Game game(HandFirmness::normal, seed);
    game.command.wrench.force_n = Vec3(0.0, 3.0, 0.0);
    game.command.wrench_duration_s = 60.0; // far too long: the stall must end it
    ++game.command.wrench_sequence;
    game.publish();
    game.run(400);
    const bool was_active = game.now.state == DeviceState::active;
    game.run(140); // 0.54 s since the last sign of life
    bool good = was_active && game.now.tensions_n == StringArray{};
    const auto seconds = static_cast<long>(minutes * 60.0);
    for (long s = 0; s < seconds; ++s) {
        game.run(1000);
        good = good && game.now.tensions_n == StringArray{} &&
               game.now.state == DeviceState::connected;
    }
    game.publish();
    game.run(200);
    good = good && game.now.state == DeviceState::active;
    std::printf("game stalled for %.1f min: %s\n", minutes,
                good ? "motors off, and back after it" : "BROKEN");
    return good ? 0 : 1;
}

} // namespace

int main(int argc, char **argv) {
    double minutes = 1.0;
    double stall_minutes = 10.0;
    long cycles = 1000;
    long commands = 100000;
    std::uint64_t seed = 1;
    for (int i = 1; i + 1 < argc; i += 2) {
        const double value = std::strtod(argv[i + 1], nullptr);
        if (std::strcmp(argv[i], "--minutes") == 0) {
            minutes = value;
        } else if (std::strcmp(argv[i], "--cycles") == 0) {
            cycles = static_cast<long>(value);
        } else if (std::strcmp(argv[i], "--commands") == 0) {
            commands = static_cast<long>(value);
        } else if (std::strcmp(argv[i], "--stall_minutes") == 0) {
            stall_minutes = value;
        } else if (std::strcmp(argv[i], "--seed") == 0) {
            seed = static_cast<std::uint64_t>(value);
        } else {
            std::fprintf(stderr, "usage: safety_hours [--minutes M] [--cycles N] [--commands N] "
                                 "[--stall_minutes S] [--seed S]\n");
            return 2;
        }
    }
    long failures = 0;
    for (const HandFirmness hand :
         {HandFirmness::light, HandFirmness::normal, HandFirmness::firm}) {
        failures += false_alarms(hand, minutes, seed) > 0 ? 1 : 0;
    }
    failures += broken_cycles(cycles, seed) > 0 ? 1 : 0;
    failures += broken_commands(commands, seed) > 0 ? 1 : 0;
    failures += broken_stall(stall_minutes, seed);
    std::printf("%ld passed, %ld failed\n", 6 - failures, failures);
    return failures == 0 ? 0 : 1;
}
